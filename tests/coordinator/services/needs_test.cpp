// Jobs that ask something of their workers.
#include <gmock/gmock.h>
#include <sqlite3.h>

#include "tests/coordinator/services/farm_world.h"

namespace hyades::coordinator {
namespace {

using testing::HasSubstr;

TEST(Needs, AreMetOrNamedAlsoAfterARestart) {
  FarmWorld world;
  world.start();
  const uint64_t job = world.submit(2, [](v1::SubmitRequest& request) {
    request.add_tags("gpu");
    request.add_tags("quiet");
    request.set_memory_bytes(1000);
    request.set_max_attempts(7);
    request.set_frame_order(v1::FRAME_ORDER_PROGRESSIVE);
  });
  const auto script = [&](const char* id, std::vector<std::string> tags, uint64_t memory) {
    ScriptedWorker::Script s = world.script(1);
    s.id = std::string("needs-test-worker-") + id;
    s.name = id;
    s.tags = std::move(tags);
    s.memory = memory;
    return s;
  };
  const auto says = [&](const std::string& what) {
    return eventually([&] { return world.explain(job).find(what) != std::string::npos; });
  };
  ScriptedWorker plain(world.address, script("plain", {"gpu"}, 0));
  EXPECT_TRUE(says("tag 'quiet'")) << world.explain(job);
  EXPECT_TRUE(eventually([&] {
    return world.get(job).job().reason() ==
           "it asks for workers with the tag 'quiet', and none is there";
  })) << "its reason is that of 'explain': "
      << world.get(job).job().reason();
  world.stop();
  world.start();
  ScriptedWorker small(world.address, script("small", {"quiet", "gpu"}, 999));
  EXPECT_TRUE(says("both all its tags")) << world.explain(job);
  const v1::GetJobResponse now = world.get(job);
  EXPECT_EQ(now.job().tags_size(), 2);
  EXPECT_EQ(now.job().memory_bytes(), 1000U);
  EXPECT_EQ(now.job().max_attempts(), 7U);
  EXPECT_EQ(now.job().frame_order(), v1::FRAME_ORDER_PROGRESSIVE);
  EXPECT_EQ(plain.delivered() + small.delivered(), 0U);

  ScriptedWorker fit(world.address, script("fit", {"gpu", "other", "quiet"}, 1000));
  EXPECT_TRUE(world.wait_for(job, v1::JOB_STATE_DONE));
  EXPECT_EQ(plain.delivered() + small.delivered(), 0U);
}

TEST(Needs, OfThePortableClassAreMetByMachinesOfAllMakers) {
  FarmWorld world;
  world.start();
  const uint64_t job = world.submit_text(FarmWorld::document(4) + "render: {class: portable}\n");
  const auto script = [&](int number, const char* native, const char* portable) {
    ScriptedWorker::Script s = world.script(number);
    s.worker_class = native;
    s.portable_class = portable;
    s.unit_time = std::chrono::milliseconds(5);
    return s;
  };
  const ScriptedWorker old(world.address, script(1, "class-a", ""));
  EXPECT_TRUE(eventually([&] {
    return world.explain(job).find("in the portable class") != std::string::npos;
  })) << world.explain(job);
  const ScriptedWorker one(world.address, script(2, "class-a", "class-p"));
  const ScriptedWorker two(world.address, script(3, "class-b", "class-p"));
  ASSERT_TRUE(world.wait_for(job, v1::JOB_STATE_DONE));
  for (int frame = 1; frame <= 4; ++frame) world.expect_truth(job, frame);
  EXPECT_EQ(world.get(job).frames(0).worker_class(), "class-p");
  EXPECT_EQ(old.delivered(), 0U);
  EXPECT_GT(one.delivered(), 0U);
  EXPECT_GT(two.delivered(), 0U);
}

TEST(Needs, OfOlderJobStoresAreTakenOver) {
  FarmWorld world;
  world.start();
  const uint64_t asking = world.submit(1, [](v1::SubmitRequest& request) {
    for (const char* tag : {"gpu", "quiet"}) request.add_tags(tag);
    request.set_max_workers(300);
    request.set_memory_bytes(uint64_t{1} << 40U);
    request.set_max_attempts(7);
    request.set_frame_order(v1::FRAME_ORDER_PROGRESSIVE);
  });
  const uint64_t plain = world.submit(1);
  // Why they wait is found out anew.
  const auto job = [&](uint64_t id) {
    v1::Job now = world.get(id).job();
    now.clear_reason();
    return now;
  };
  const v1::Job before = job(asking);
  const v1::Job plain_before = job(plain);
  EXPECT_EQ(before.max_workers(), 300U);
  EXPECT_EQ(before.frame_rate(), 24);
  EXPECT_EQ(plain_before.max_attempts(), 3U);
  world.stop();
  sqlite3* db = nullptr;
  ASSERT_EQ(sqlite3_open((world.options.folder + "/state.db").c_str(), &db), SQLITE_OK);
  EXPECT_EQ(sqlite3_exec(db,
                         "ALTER TABLE jobs ADD COLUMN spec BLOB NOT NULL DEFAULT x'';"
                         "UPDATE jobs SET spec = (SELECT spec FROM specs WHERE job = id);"
                         "DROP TABLE specs; DROP INDEX jobs_of_owner;"
                         "DROP INDEX black_frames; ALTER TABLE frames DROP COLUMN black;"
                         "DROP TABLE removals;"
                         "ALTER TABLE jobs DROP COLUMN options; DROP TABLE secret;"
                         "ALTER TABLE tokens DROP COLUMN pool;"
                         "ALTER TABLE tokens DROP COLUMN machines;"
                         "DROP TRIGGER count_core_time; DROP TABLE core_time;"
                         "ALTER TABLE jobs DROP COLUMN samples_done;"
                         "ALTER TABLE jobs DROP COLUMN begun_ms;"
                         "ALTER TABLE jobs DROP COLUMN busy_ns;"
                         "PRAGMA user_version=7;"
                         "UPDATE jobs SET max_workers = 300, tags = 'gpu,quiet', max_attempts = 7,"
                         "memory = 1099511627776, frame_order = 2 WHERE id = 1",
                         nullptr, nullptr, nullptr),
            SQLITE_OK);
  sqlite3_close(db);
  std::filesystem::remove(world.options.folder + "/farm-id");  // which older ones do not have
  world.start();
  EXPECT_EQ(job(asking).SerializeAsString(), before.SerializeAsString());
  EXPECT_EQ(job(plain).SerializeAsString(), plain_before.SerializeAsString());
}

TEST(Needs, ThatMakeNoSenseAreRefused) {
  FarmWorld world;
  world.start();
  const auto refused = [&](const std::function<void(v1::SubmitRequest&)>& change) {
    v1::SubmitRequest request = FarmWorld::request(FarmWorld::document(1));
    change(request);
    v1::SubmitResponse response;
    const grpc::Status status = world.controller->jobs().submit(request, false, response);
    EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT) << status.error_message();
    return status.error_message();
  };
  EXPECT_THAT(refused([](v1::SubmitRequest& r) { r.add_tags("a,b"); }), HasSubstr("a,b"));
  EXPECT_THAT(refused([](v1::SubmitRequest& r) { r.set_max_attempts(101); }), HasSubstr("100"));
  EXPECT_THAT(refused([](v1::SubmitRequest& r) { r.set_frame_order(v1::FrameOrder(9)); }),
              HasSubstr("progressive"));
}

}  // namespace
}  // namespace hyades::coordinator
