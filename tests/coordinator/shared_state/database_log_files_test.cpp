// Film logs in a database whose connections end at any moment, and whose leader changes.
#include "coordinator/shared_state/database_log_files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <set>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "coordinator/film_store/film_log.h"
#include "tests/coordinator/shared_state/film_database.h"
#include "tests/coordinator/sql/postgres_server.h"

namespace hyades::coordinator {
namespace {

using namespace std::chrono_literals;
using Texts = std::vector<std::string>;

constexpr const char* kFolder = "films/7";
constexpr const char* kEndSessions =
    "SELECT pg_terminate_backend(pid) FROM pg_stat_activity "
    "WHERE application_name = 'hyades leader' AND datname = current_database()";

std::vector<std::byte> record_with(const std::string& text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

/// A log in the database, and what it holds.
struct OpenedLog {
  std::unique_ptr<FilmLog> log;
  Texts records;
  ReplayReport report;
};

OpenedLog open_database_log(LogFiles& files, uint64_t segment_bytes = uint64_t{1} << 20U) {
  FilmLogOptions options;
  options.files = &files;
  options.segment_bytes = segment_bytes;
  OpenedLog opened;
  auto log = FilmLog::open(kFolder, "key", options);
  if (!log) {
    ADD_FAILURE() << log.error().message;
    return opened;
  }
  const auto report = (*log)->replay([&](std::span<const std::byte> record) {
    opened.records.emplace_back(reinterpret_cast<const char*>(record.data()), record.size());
    return core::Status();
  });
  if (!report) {
    ADD_FAILURE() << report.error().message;
    return opened;
  }
  opened.log = std::move(*log);
  opened.report = *report;
  return opened;
}

class DatabaseLog : public testing::Test {
 protected:
  void SetUp() override {
    if (!test::postgres_is_there()) return;
    url_ = test::PostgresServer::shared().make_database();
    hands_.emplace(make_film_database(url_));
  }
  /// As the leader with this incarnation sees them.
  std::unique_ptr<DatabaseLogFiles> files(uint64_t incarnation = 1) {
    PostgresOptions options = film_leader(url_, incarnation);
    options.on_lost = [this](const std::string&) { ++lost_; };
    return std::make_unique<DatabaseLogFiles>(options);
  }
  int64_t chunks() { return hands_->number_of("SELECT COUNT(*) FROM log_chunks"); }

  std::string url_;
  std::optional<DatabaseHands> hands_;
  std::atomic<int> lost_{0};
};

TEST_F(DatabaseLog, LivesOnWithTheNextLeader) {
  Texts expected;
  for (uint64_t incarnation = 1; incarnation <= 3; ++incarnation) {
    hands_->run("UPDATE leader SET incarnation = " + std::to_string(incarnation));
    const auto own = files(incarnation);
    const OpenedLog opened = open_database_log(*own, 100'000);
    ASSERT_TRUE(opened.log);
    EXPECT_EQ(opened.records, expected);
    EXPECT_TRUE(opened.report.problems.empty());
    for (const size_t size : {size_t{10}, size_t{60'000}, size_t{60'000}, size_t{3'000'000}}) {
      expected.emplace_back(size, static_cast<char>('a' + expected.size()));
      ASSERT_TRUE(opened.log->append(record_with(expected.back())).ok());
      ASSERT_TRUE(opened.log->sync().ok());
    }
    const auto names = own->list(kFolder);
    ASSERT_TRUE(names.ok());
    EXPECT_GE(names->size(), 3U) << "it has begun new segments";
    EXPECT_EQ(*own->folders(), Texts{kFolder});
  }
  hands_->run("UPDATE leader SET incarnation = 4");
  const auto own = files(4);
  {
    const OpenedLog opened = open_database_log(*own);
    ASSERT_TRUE(opened.log);
    const core::Status compacted = opened.log->compact(
        opened.log->durable(),
        [](const FilmLog::Sink& sink) { return sink(record_with(std::string(2'000'000, 'z'))); });
    ASSERT_TRUE(compacted.ok()) << compacted.error().message;
    EXPECT_EQ(own->list(kFolder)->size(), 2U) << "the guard and the snapshot";
    EXPECT_EQ(hands_->number_of("SELECT COUNT(*) FROM log_chunks WHERE NOT EXISTS (SELECT 1 FROM "
                                "log_files WHERE id = file)"),
              0);
    ASSERT_TRUE(opened.log->append(record_with("last")).ok());
  }
  EXPECT_EQ(open_database_log(*own).records, (Texts{std::string(2'000'000, 'z'), "last"}));
  EXPECT_EQ(lost_, 0);
  ASSERT_TRUE(erase_film_log(kFolder, own.get()).ok());
  EXPECT_EQ(chunks(), 0);
}

TEST_F(DatabaseLog, OfALeaderThatIsNoneNothingComesIn) {
  const auto old = files(1);
  OpenedLog opened = open_database_log(*old);
  ASSERT_TRUE(opened.log);
  ASSERT_TRUE(opened.log->append(record_with("first")).ok());
  ASSERT_TRUE(opened.log->sync().ok());

  hands_->run("UPDATE leader SET incarnation = 2");
  const auto own = files(2);
  const OpenedLog taken = open_database_log(*own);
  EXPECT_EQ(taken.records, Texts{"first"});
  ASSERT_TRUE(opened.log->append(record_with("late")).ok());
  EXPECT_FALSE(opened.log->sync().ok());
  EXPECT_FALSE(old->create("films/7/x").ok());
  EXPECT_FALSE(old->remove("films/7/log.key").ok());
  EXPECT_FALSE(old->rename("films/7/log.key", "films/7/x").ok());
  EXPECT_FALSE(old->truncate("films/7/log.key", 0).ok());
  EXPECT_EQ(lost_, 1) << "it was told once";
  opened.log.reset();
  ASSERT_TRUE(taken.log->append(record_with("second")).ok());
  ASSERT_TRUE(taken.log->sync().ok());
  EXPECT_EQ(open_database_log(*files(2)).records, (Texts{"first", "second"}));
}

// As a farm may see it: the log is rewritten while results come, and the database ends sessions.
TEST_F(DatabaseLog, ForgetsNothingWhileConnectionsEnd) {
  std::mt19937 random(5);
  std::set<int> durable;
  std::map<int, std::string> sent;
  int next = 0;
  const auto number_in = [](const std::string& record) { return std::stoi(record); };
  for (int life = 0; life < 3; ++life) {
    const auto own = files();
    OpenedLog opened = open_database_log(*own, 50'000);
    ASSERT_TRUE(opened.log);
    // Half a group may be reported, of a file that could not be cut: it is in the next one, whole.
    std::set<int> found;
    for (const std::string& record : opened.records) {
      const int number = number_in(record);
      EXPECT_EQ(record, sent.at(number));
      EXPECT_TRUE(found.insert(number).second) << number << " is there twice";
    }
    EXPECT_TRUE(
        std::is_sorted(opened.records.begin(), opened.records.end(),
                       [&](const auto& a, const auto& b) { return number_in(a) < number_in(b); }));
    for (const int number : durable) EXPECT_TRUE(found.contains(number)) << number;
    durable.insert(found.begin(), found.end());

    std::atomic<bool> ends{false};
    std::thread killer([&, seed = random()] {
      std::mt19937 chance(static_cast<unsigned>(seed));
      while (!ends) {
        std::this_thread::sleep_for(std::chrono::milliseconds(chance() % 60));
        hands_->run(kEndSessions);
      }
    });
    int failures = 0;
    const auto end = std::chrono::steady_clock::now() + 2s;
    std::set<int> pending;
    while (std::chrono::steady_clock::now() < end) {
      const int number = next++;
      std::string& text = sent[number];
      text = std::to_string(number) + " " +
             std::string(random() % (random() % 20 == 0 ? 2'000'000 : 5'000), '.');
      ASSERT_TRUE(opened.log->append(record_with(text)).ok());
      pending.insert(number);
      if (random() % 5 != 0) continue;
      if (!opened.log->sync()) {
        ++failures;
        continue;
      }
      durable.merge(pending);
      pending.clear();
      if (random() % 10 != 0) continue;
      // The same records once more, in one file.
      (void)opened.log->compact(opened.log->durable(), [&](const FilmLog::Sink& sink) {
        core::Status done;
        for (const int kept : durable) {
          if (done) done = sink(record_with(sent.at(kept)));
        }
        return done;
      });
    }
    ends = true;
    killer.join();
    EXPECT_GT(failures, 0) << "nothing has failed";
    EXPECT_EQ(lost_, 0) << "nobody else leads";
  }
  EXPECT_GT(durable.size(), 20U);
}

TEST_F(DatabaseLog, IsReadOverConnectionsThatEnd) {
  const std::string text(5'000'000, 'x');
  const auto own = files();
  {
    const OpenedLog opened = open_database_log(*own, 1'000'000);
    for (int i = 0; i < 4; ++i) ASSERT_TRUE(opened.log->append(record_with(text)).ok());
    ASSERT_TRUE(opened.log->sync().ok());
  }
  std::atomic<bool> ends{false};
  std::thread killer([&] {
    while (!ends) {
      hands_->run(kEndSessions);
      std::this_thread::sleep_for(20ms);
    }
  });
  // Replay would take what it cannot read for damaged.
  const auto names = own->list(kFolder);
  ASSERT_TRUE(names.ok());
  for (int i = 0; i < 3; ++i) {
    for (const std::string& name : *names) {
      const auto file = own->open(std::string(kFolder) + "/" + name);
      ASSERT_TRUE(file.ok()) << file.error().message;
      std::vector<std::byte> bytes((*file)->size());
      const core::Status read = (*file)->read(0, bytes);
      EXPECT_TRUE(read.ok()) << read.error().message;
    }
  }
  ends = true;
  killer.join();
}

TEST_F(DatabaseLog, AFileThatFailedOnceTakesNoMore) {
  const auto own = files();
  auto file = own->create("films/7/a");
  ASSERT_TRUE(file.ok());
  ASSERT_TRUE((*file)->write(record_with("kept")).ok());
  ASSERT_TRUE((*file)->sync().ok());
  ASSERT_TRUE((*file)->write(record_with("lost")).ok());
  hands_->run(kEndSessions);
  EXPECT_FALSE((*file)->sync().ok());
  EXPECT_FALSE((*file)->sync().ok()) << "it would say that what was lost is there";
  EXPECT_FALSE((*file)->write(record_with("more")).ok());
  EXPECT_EQ((*own->open("films/7/a"))->size(), 4U);
}

TEST_F(DatabaseLog, AFileThatWasRemovedTakesNoMore) {
  const auto own = files();
  auto file = own->create("films/7/a");
  ASSERT_TRUE(file.ok());
  ASSERT_TRUE(own->remove("films/7/a").ok());
  ASSERT_TRUE((*file)->write(record_with("x")).ok());
  EXPECT_FALSE((*file)->sync().ok());
  EXPECT_EQ(chunks(), 0);
}

TEST_F(DatabaseLog, ChunksWithoutAFileAreRemoved) {
  const auto own = files();
  const OpenedLog opened = open_database_log(*own);
  ASSERT_TRUE(opened.log->append(record_with("kept")).ok());
  ASSERT_TRUE(opened.log->sync().ok());
  const int64_t before = chunks();
  hands_->run("INSERT INTO log_chunks (file, position, size, bytes) VALUES (999, 0, 1, 'x')");
  ASSERT_TRUE(own->remove_garbage().ok());
  EXPECT_EQ(chunks(), before);
}

TEST(DatabaseLogServer, ALogOutlivesTheDatabasesEnd) {
  if (!test::postgres_is_there()) return;
  test::PostgresServer server(true);
  const std::string url = server.make_database();
  (void)make_film_database(url);
  DatabaseLogFiles own(film_leader(url));
  Texts expected;
  for (int i = 0; i < 2; ++i) {
    const OpenedLog opened = open_database_log(own);
    ASSERT_TRUE(opened.log);
    EXPECT_EQ(opened.records, expected);
    for (int j = 0; j < 5; ++j) {
      expected.push_back(std::to_string(i) + std::to_string(j) + std::string(100'000, '.'));
      ASSERT_TRUE(opened.log->append(record_with(expected.back())).ok());
    }
    ASSERT_TRUE(opened.log->sync().ok());
    server.kill();
    expected.push_back("while it is gone");
    ASSERT_TRUE(opened.log->append(record_with(expected.back())).ok());
    EXPECT_FALSE(opened.log->sync().ok());
    std::thread reads([&] {
      const auto names = own.list(kFolder);
      EXPECT_TRUE(names.ok()) << "what only reads waits for the database";
    });
    std::this_thread::sleep_for(300ms);
    server.start();
    reads.join();
    core::Status synced = opened.log->sync();
    for (int tries = 0; !synced && tries < 100; ++tries) {
      std::this_thread::sleep_for(100ms);
      synced = opened.log->sync();
    }
    EXPECT_TRUE(synced.ok()) << synced.error().message;
  }
  EXPECT_EQ(open_database_log(own).records, expected);
}

}  // namespace
}  // namespace hyades::coordinator
