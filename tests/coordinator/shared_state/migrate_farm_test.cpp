#include "coordinator/shared_state/migrate_farm.h"

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "coordinator/film_store/disk_film_logs.h"
#include "coordinator/film_store/film_log.h"
#include "coordinator/job_store/job_store.h"
#include "coordinator/shared_state/database_film_logs.h"
#include "coordinator/shared_state/leader_lease.h"
#include "coordinator/sql/postgres.h"
#include "tests/coordinator/sql/postgres_server.h"
#include "tests/support/temp_folder.h"

namespace hyades::coordinator {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

constexpr const char* kKey = "the job's key";

void write_text(const std::string& path, const std::string& text) {
  fs::create_directories(fs::path(path).parent_path());
  std::ofstream(path) << text;
}

std::string read_text(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

/// Records that a film log holds, in order.
std::vector<std::string> records_of(FilmLogs& logs, uint64_t job) {
  FilmLogOptions options;
  options.files = &logs.files();
  auto log = FilmLog::open(logs.folder(job), kKey, options);
  EXPECT_TRUE(log.ok()) << (log ? "" : log.error().message);
  std::vector<std::string> records;
  if (!log) return records;
  const auto replayed = (*log)->replay([&](std::span<const std::byte> bytes) {
    records.emplace_back(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    return core::Status();
  });
  EXPECT_TRUE(replayed.ok()) << (replayed ? "" : replayed.error().message);
  return records;
}

void add_record(FilmLogs& logs, uint64_t job, const std::string& text) {
  FilmLogOptions options;
  options.files = &logs.files();
  auto log = FilmLog::open(logs.folder(job), kKey, options);
  ASSERT_TRUE(log.ok()) << log.error().message;
  ASSERT_TRUE((*log)->replay([](auto) { return core::Status(); }).ok());
  const auto bytes = std::as_bytes(std::span(text));
  ASSERT_TRUE((*log)->append({bytes.begin(), bytes.end()}).ok());
  ASSERT_TRUE((*log)->sync().ok());
}

class MigrateFarm : public testing::Test {
 protected:
  void SetUp() override {
    if (!test::postgres_is_there()) return;
    homes_ = {folder_.file("data"), test::PostgresServer::shared().make_database(),
              folder_.file("shared")};
    fs::create_directories(homes_.folder);
    auto store = open_sqlite_job_store(homes_.folder + "/state.db");
    ASSERT_TRUE(store.ok());
    for (int i = 0; i < 5; ++i) starts_ = *(*store)->next_incarnation();
    StoredJob job;
    job.name = "balls";
    job.spec = "spec";
    job.frames = 2;
    job_ = (*store)->add_job(job)->id;
    const auto logs = disk_film_logs(homes_.folder + "/films");
    add_record(*logs, job_, "a film");
    add_record(*logs, job_, std::string(3'000'000, 'x'));
    write_text(homes_.folder + "/outputs/1/balls.0001.png", "a picture");
    write_text(homes_.folder + "/assets/ab", "an asset");
    write_text(homes_.folder + "/audit.jsonl", "{}\n");
    write_text(homes_.folder + "/tmp/1-1/scratch", "of no use");
  }

  std::unique_ptr<LeaderLease> lead() {
    LeaderOptions options;
    options.database = homes_.database;
    options.holder = "host:1";
    options.time = 1000ms;
    options.pause = [](auto time) {
      std::this_thread::sleep_for(time);
      return true;
    };
    auto lease = LeaderLease::wait(options);
    EXPECT_TRUE(lease.ok());
    return std::move(lease).value();
  }

  test::TempFolder folder_;
  FarmHomes homes_;
  uint64_t starts_ = 0;
  uint64_t job_ = 0;
};

TEST_F(MigrateFarm, ThereAndBackNothingIsLost) {
  const auto moved = migrate_to_database(homes_);
  ASSERT_TRUE(moved.ok()) << (moved ? "" : moved.error().message);
  EXPECT_EQ(moved->logs, 1U);
  EXPECT_GT(moved->log_bytes, 3'000'000U);
  EXPECT_EQ(moved->files, 3U);
  EXPECT_FALSE(fs::exists(homes_.folder + "/state.db"));
  EXPECT_EQ(read_text(homes_.files + "/outputs/1/balls.0001.png"), "a picture");
  EXPECT_FALSE(fs::exists(homes_.files + "/tmp"));
  uint64_t incarnation = 0;
  {
    const auto lease = lead();
    ASSERT_TRUE(lease);
    incarnation = lease->incarnation();
    EXPECT_GT(incarnation, starts_);
    const auto connection = leader_connection(homes_.database, incarnation, {});
    const auto store = open_postgres_job_store(connection);
    ASSERT_TRUE(store.ok());
    EXPECT_EQ((**(*store)->job(job_)).name, "balls");
    const auto logs = database_film_logs(std::make_unique<DatabaseLogFiles>(connection), {});
    EXPECT_TRUE(*logs->contains(job_));
    add_record(*logs, job_, "one more");
    EXPECT_EQ(records_of(*logs, job_),
              (std::vector<std::string>{"a film", std::string(3'000'000, 'x'), "one more"}));
  }
  FarmHomes back = homes_;
  back.folder = folder_.file("back");
  const auto returned = migrate_to_folder(back);
  ASSERT_TRUE(returned.ok()) << (returned ? "" : returned.error().message);
  const auto store = open_sqlite_job_store(back.folder + "/state.db");
  ASSERT_TRUE(store.ok());
  EXPECT_EQ((**(*store)->job(job_)).name, "balls");
  EXPECT_GT(*(*store)->next_incarnation(), incarnation);
  const auto logs = disk_film_logs(back.folder + "/films");
  EXPECT_EQ(records_of(*logs, job_).size(), 3U);
  EXPECT_EQ(read_text(back.folder + "/outputs/1/balls.0001.png"), "a picture");
  EXPECT_EQ(read_text(back.folder + "/audit.jsonl"), "{}\n");
}

TEST_F(MigrateFarm, IsRefusedWhileSomebodyLeads) {
  const auto lease = lead();
  ASSERT_TRUE(lease);
  const auto refused = migrate_to_database(homes_);
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find("host:1 leads"), std::string::npos)
      << refused.error().message;
  EXPECT_TRUE(fs::exists(homes_.folder + "/state.db"));
}

TEST_F(MigrateFarm, IsRefusedWhileACoordinatorHasTheFolder) {
  const auto busy = open_sqlite_job_store(homes_.folder + "/state.db");
  ASSERT_TRUE(busy.ok());
  const auto refused = migrate_to_database(homes_);
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find("another coordinator works in"), std::string::npos)
      << refused.error().message;
}

TEST_F(MigrateFarm, TwoFarmsDoNotBecomeOne) {
  ASSERT_TRUE(migrate_to_database(homes_).ok());
  FarmHomes other = homes_;
  other.folder = folder_.file("other");
  fs::create_directories(other.folder);
  ASSERT_TRUE(open_sqlite_job_store(other.folder + "/state.db").ok());
  const auto refused = migrate_to_database(other);
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find("jobs already"), std::string::npos)
      << refused.error().message;
  EXPECT_FALSE(migrate_to_folder(other).ok()) << "there is a farm";
}

TEST_F(MigrateFarm, TheFolderMayStayWhatItWas) {
  homes_.files = homes_.folder;
  const auto moved = migrate_to_database(homes_);
  ASSERT_TRUE(moved.ok()) << (moved ? "" : moved.error().message);
  EXPECT_EQ(moved->files, 0U);
  EXPECT_EQ(read_text(homes_.files + "/outputs/1/balls.0001.png"), "a picture");
}

}  // namespace
}  // namespace hyades::coordinator
