// Documents of open jobs, of which few are in memory.
#include "coordinator/controller/job_documents.h"

#include <gtest/gtest.h>
#include <malloc.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "core/film/film_exr.h"
#include "core/job/render_key.h"
#include "farm/manifest_resolver.h"
#include "tests/coordinator/services/farm_world.h"
#include "tests/farm/content_testing.h"

namespace hyades::coordinator {
namespace {

/// A document of so many objects, unlike those of other names.
std::string document_of(const std::string& name, int objects) {
  std::string text = FarmWorld::document(1) + "keep_films: true\n";
  std::string balls = "objects:\n  " + name + ": {shape: sphere, material: clay}\n";
  for (int i = 0; i < objects; ++i) {
    balls += "  o" + std::to_string(i) + ": {shape: sphere, radius: 1, material: clay}\n";
  }
  const std::string one = "objects: {ball: {shape: sphere, radius: 1, material: clay}}\n";
  return text.replace(text.find(one), one.size(), balls);
}

std::string key_of(const farm::ReadJob& read) { return core::render_key(read.job, 1, read.assets); }

class JobDocumentsTest : public testing::Test {
 protected:
  v1::JobSpec spec_of(const std::string& text) {
    farm::put(*store, text);
    return FarmWorld::request(text).spec();
  }
  /// Reads, or is told why not.
  std::string read(JobDocuments& documents, const v1::JobSpec& spec,
                   std::chrono::milliseconds patience = 20s) {
    const auto found = documents.read(spec, patience);
    if (!found) return "others are read";
    return *found ? key_of(***found) : (*found).error().message;
  }
  /// What a document of these takes.
  uint64_t bytes_of(const v1::JobSpec& spec) {
    JobDocuments all(*store, UINT64_MAX);
    read(all, spec);
    return all.kept_bytes();
  }

  test::TempFolder folder;
  std::unique_ptr<farm::ContentStore> store = farm::open_store(folder.file("assets"));
};

TEST_F(JobDocumentsTest, OfThoseThatWereUsedLastStayAsManyAsFit) {
  const v1::JobSpec a = spec_of(document_of("a", 100));
  const v1::JobSpec b = spec_of(document_of("b", 100));
  const v1::JobSpec c = spec_of(document_of("c", 100));
  const v1::JobSpec d = spec_of(document_of("d", 100));
  const uint64_t most = bytes_of(a) * 7 / 2;
  JobDocuments documents(*store, most);
  const std::string key = read(documents, a);
  read(documents, b);
  read(documents, c);
  EXPECT_EQ(documents.times_read(), 3U);
  EXPECT_EQ(read(documents, a), key);
  EXPECT_EQ(documents.times_read(), 3U) << "it was in memory";
  read(documents, d);
  EXPECT_LE(documents.kept_bytes(), most);
  EXPECT_GT(documents.kept_bytes(), most / 2);
  for (const v1::JobSpec& kept : {c, d, a}) read(documents, kept);
  EXPECT_EQ(documents.times_read(), 4U) << "those that were used last have stayed";
  read(documents, b);
  EXPECT_EQ(documents.times_read(), 5U);
  read(documents, c);
  EXPECT_EQ(documents.times_read(), 6U);
  read(documents, d);
  EXPECT_EQ(read(documents, a), key) << "read again";
  EXPECT_EQ(documents.times_read(), 8U);
  EXPECT_LE(documents.kept_bytes(), most);
}

TEST_F(JobDocumentsTest, JobsOfOneDocumentShareIt) {
  v1::JobSpec spec = spec_of(document_of("a", 10));
  JobDocuments documents(*store, 10'000'000);
  read(documents, spec);
  spec.set_name("of another name");
  spec.add_frames()->set_first(1);
  read(documents, spec);
  EXPECT_EQ(documents.times_read(), 1U);
  spec.set_samples(7);
  const auto other = documents.read(spec, 20s);
  ASSERT_TRUE(other && *other);
  EXPECT_EQ((**other)->job.sampling.samples, 7U);
  const auto stored = documents.read_stored(spec.SerializeAsString(), 20s);
  ASSERT_TRUE(stored && *stored);
  EXPECT_EQ(&***stored, &***other);
  EXPECT_EQ(documents.times_read(), 2U);
}

TEST_F(JobDocumentsTest, OneThatIsTooLongIsHeldByWhoeverUsesItAlone) {
  const v1::JobSpec large = spec_of(document_of("a", 200));
  const v1::JobSpec small = spec_of(document_of("b", 1));
  JobDocuments documents(*store, bytes_of(large) / 2);
  const std::string small_key = read(documents, small);
  {
    const auto held = documents.read(large, 20s);
    ASSERT_TRUE(held && *held);
    EXPECT_EQ(read(documents, large, 50ms), "others are read") << "twice in memory";
    EXPECT_EQ(read(documents, spec_of(document_of("c", 1)), 50ms), "others are read");
    EXPECT_EQ(read(documents, small, 0ms), small_key) << "it is in memory, and waits for nobody";
    EXPECT_LE(documents.kept_bytes(), bytes_of(small));
  }
  EXPECT_EQ(documents.times_read(), 2U);
  EXPECT_EQ(read(documents, large).size(), 64U) << "its turn, and after it another's";
  EXPECT_EQ(read(documents, large).size(), 64U);
  EXPECT_EQ(documents.times_read(), 4U);
}

TEST_F(JobDocumentsTest, WhoCameFirstReadsFirst) {
  const v1::JobSpec large = spec_of(document_of("a", 200));
  JobDocuments documents(*store, 1);
  std::vector<int> order;
  std::vector<std::thread> readers;
  {
    const auto held = documents.read(large, 20s);
    ASSERT_TRUE(held && *held);
    for (int i = 0; i < 4; ++i) {
      readers.emplace_back([&, i] {
        const auto found = documents.read(large, i == 1 ? 100ms : 20s);
        if (found) order.push_back(i);  // alone, as long as it is held
      });
      std::this_thread::sleep_for(50ms);
    }
    std::this_thread::sleep_for(100ms);
  }
  for (std::thread& reader : readers) reader.join();
  EXPECT_EQ(order, (std::vector<int>{0, 2, 3})) << "one had no more patience";
}

TEST_F(JobDocumentsTest, OfEachOwnerOneWaits) {
  const v1::JobSpec large = spec_of(document_of("a", 200));
  JobDocuments documents(*store, 1);
  std::thread eve;
  std::thread ann;
  bool eve_read = false;
  bool ann_read = false;
  {
    const auto held = documents.read(large, 20s, "dan");
    ASSERT_TRUE(held && *held);
    EXPECT_FALSE(documents.read(large, 20s, "dan")) << "his is read";
    eve = std::thread([&] { eve_read = documents.read(large, 20s, "eve").has_value(); });
    std::this_thread::sleep_for(100ms);
    const auto before = std::chrono::steady_clock::now();
    EXPECT_FALSE(documents.read(large, 20s, "eve")) << "another of hers waits";
    EXPECT_LT(std::chrono::steady_clock::now() - before, 10s) << "told at once";
    ann = std::thread([&] { ann_read = documents.read(large, 20s, "ann").has_value(); });
    std::this_thread::sleep_for(100ms);
  }
  eve.join();
  ann.join();
  EXPECT_TRUE(eve_read);
  EXPECT_TRUE(ann_read);
}

/// So that any number of others who always have one waiting keep nobody from it.
TEST_F(JobDocumentsTest, ForWhomLeastWasReadIsNext) {
  const v1::JobSpec large = spec_of(document_of("a", 200));
  JobDocuments documents(*store, 1);
  for (const char* often : {"dan", "eve"}) {
    const auto held = documents.read(large, 20s, often);
    ASSERT_TRUE(held && *held);
    std::this_thread::sleep_for(200ms);
  }
  std::vector<std::string> order;
  std::vector<std::thread> readers;
  {
    const auto held = documents.read(large, 20s, "bob");
    ASSERT_TRUE(held && *held);
    for (const char* owner : {"dan", "eve", "ann"}) {
      readers.emplace_back([&, owner] {
        const auto found = documents.read(large, 20s, owner);
        if (found) order.emplace_back(owner);  // alone, as long as it is held
      });
      std::this_thread::sleep_for(100ms);
    }
  }
  for (std::thread& reader : readers) reader.join();
  ASSERT_EQ(order.size(), 3U);
  EXPECT_EQ(order.front(), "ann") << "she came last, and has read nothing yet";
}

TEST_F(JobDocumentsTest, WhatCannotBeReadIsAnErrorAndCanBeReadLater) {
  const std::string text = document_of("a", 1);
  const v1::JobSpec spec = spec_of(text);
  const std::string path = folder.file("assets") + "/" + farm::name_of(text);
  JobDocuments documents(*store, 1);
  const std::string key = read(documents, spec);
  ASSERT_EQ(key.size(), 64U);
  ASSERT_TRUE(std::filesystem::remove(path));
  EXPECT_NE(read(documents, spec).find("job.yaml"), std::string::npos) << read(documents, spec);
  farm::put(*store, text);
  EXPECT_EQ(read(documents, spec), key);
  std::filesystem::permissions(path, std::filesystem::perms::owner_all);
  std::ofstream(path, std::ios::trunc) << "hyades: 1\n";
  EXPECT_NE(read(documents, spec).find("job.yaml"), std::string::npos) << read(documents, spec);
  farm::put(*store, text);
  EXPECT_EQ(read(documents, spec), key);
  const auto damaged = documents.read_stored("not a spec", 20s);
  ASSERT_TRUE(damaged);
  EXPECT_NE((*damaged).error().message.find("damaged"), std::string::npos);
}

/// So a farm of a thousand such jobs never reads again.
TEST_F(JobDocumentsTest, AThousandOfTenThousandCharactersStay) {
  const std::string text = document_of("a", 195);
  ASSERT_GT(text.size(), 10'000U);
  EXPECT_LE(1000 * bytes_of(spec_of(text)), ControllerOptions{}.document_memory);
}

/// Jobs whose documents take 11 MB each.
class LongDocuments : public testing::Test {
 protected:
  static constexpr int kJobs = 6;
  static constexpr int kObjects = 5000;

  void start(uint64_t document_memory) {
    world.options.document_memory = document_memory;
    world.start();
  }
  static std::string text_of(int job) {
    return document_of("ball-" + std::to_string(job), kObjects);
  }
  static uint64_t given() {
    const struct mallinfo2 now = mallinfo2();
    return now.uordblks + now.hblkhd;
  }
  std::string expected_key(const std::string& text) const {
    const v1::JobFile file = FarmWorld::request(text).spec().files(0);
    farm::ManifestResolver files({{file.path(), farm::hex_from_wire(file.sha256()), file.size()}},
                                 world.controller->assets());
    const auto read = farm::read_job("job.yaml", "job.yaml", files);
    EXPECT_TRUE(read.ok()) << (read ? "" : read.error().message);
    return read ? key_of(*read) : "";
  }
  grpc::Status film_header(uint64_t job, v1::FilmHeader& header) const {
    v1::FilmRequest request;
    request.set_job(job);
    request.set_frame(1);
    const auto context = world.context();
    const auto reader = world.jobs->Film(context.get(), request);
    v1::FilmPart part;
    while (reader->Read(&part)) {
      if (part.has_header()) header = part.header();
    }
    return reader->Finish();
  }

  FarmWorld world;
};

TEST_F(LongDocuments, OfOpenJobsTakeBoundedMemoryAndTheirFramesKeepTheirKeys) {
  constexpr uint64_t kMost = 25'000'000;  // two of them
  start(kMost);
  (void)world.submit_text(document_of("first", 1));  // what is made once
  const uint64_t before = given();
  std::vector<uint64_t> jobs;
  for (int i = 0; i < kJobs; ++i) jobs.push_back(world.submit_text(text_of(i)));
  const uint64_t taken = std::max(given(), before) - before;
  EXPECT_LT(taken, kMost + kMost / 2) << "those of all jobs take 69 MB";

  ScriptedWorker::Script script = world.script();
  script.unit_time = 2ms;
  const ScriptedWorker worker(world.address, script);
  for (int i = 0; i < kJobs; ++i) {
    ASSERT_TRUE(world.wait_for(jobs[i], v1::JOB_STATE_DONE)) << world.get(jobs[i]).job().reason();
    const std::string path = world.folder.file("film.exr");
    std::ofstream(path, std::ios::binary) << world.fetch(jobs[i], "balls.film.exr");
    const auto film = core::read_film_exr(path);
    ASSERT_TRUE(film.ok()) << film.error().message;
    EXPECT_EQ(film->info.render_key, expected_key(text_of(i)));
  }
}

TEST_F(LongDocuments, AreReadForAFilmThatGrows) {
  start(1'000'000);  // none of them
  const std::string text = text_of(0);
  const uint64_t job = world.submit_text(text);
  ScriptedWorker::Script script = world.script();
  script.meddle = [sent = std::make_shared<std::atomic<int>>(0)](
                      ScriptedWorker&, const v1::LeasedUnit&) { return ++*sent <= 1; };
  const ScriptedWorker worker(world.address, script);
  v1::FilmHeader header;
  ASSERT_TRUE(eventually([&] { return film_header(job, header).ok(); }));
  EXPECT_EQ(header.render_key(), expected_key(text));
  EXPECT_EQ(header.worker_class(), script.worker_class);
  // What cannot be read any more is told.
  ASSERT_TRUE(std::filesystem::remove(world.options.folder + "/assets/" + farm::name_of(text)));
  const grpc::Status gone = film_header(job, header);
  EXPECT_EQ(gone.error_code(), grpc::StatusCode::DATA_LOSS) << gone.error_message();
  EXPECT_NE(gone.error_message().find("job.yaml"), std::string::npos) << gone.error_message();
}

TEST_F(LongDocuments, ThatAreGoneFailTheirFramesInWords) {
  start(1'000'000);
  const std::string text = text_of(0);
  const uint64_t job = world.submit_text(text);
  ASSERT_TRUE(std::filesystem::remove(world.options.folder + "/assets/" + farm::name_of(text)));
  const ScriptedWorker worker(world.address, world.script());
  ASSERT_TRUE(world.wait_for(job, v1::JOB_STATE_FAILED));
  const std::string reason = world.get(job).frames(0).reason();
  EXPECT_NE(reason.find("job.yaml"), std::string::npos) << reason;
  EXPECT_NE(world.submit(1), 0U) << "others are served";
}

}  // namespace
}  // namespace hyades::coordinator
