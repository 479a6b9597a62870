#include "coordinator/backup/backup.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "coordinator/backup/copy_database.h"
#include "coordinator/backup/manifest.h"
#include "coordinator/job_store/incarnation_file.h"
#include "coordinator/job_store/schema.h"
#include "tests/support/temp_folder.h"

namespace hyades::coordinator {
namespace {

namespace fs = std::filesystem;

std::string read(const fs::path& path) {
  std::stringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

void write(const fs::path& path, const std::string& text) {
  fs::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << text;
}

/// A job store as a running coordinator has it open, with a table of the test's own.
class LiveStore {
 public:
  explicit LiveStore(const std::string& path) : db_(open_job_database(path).value()) {
    run("CREATE TABLE marks (number INTEGER)");
  }
  void run(const std::string& sql) { ASSERT_TRUE(Query(*db_, sql).run().ok()) << sql; }
  /// In one change: number and -number.
  void mark(int number) {
    run("BEGIN");
    run("INSERT INTO marks VALUES (" + std::to_string(number) + ")");
    run("INSERT INTO marks VALUES (" + std::to_string(-number) + ")");
    run("COMMIT");
  }
  /// The log of changes goes into the database, and begins anew.
  void checkpoint() { run("PRAGMA wal_checkpoint(TRUNCATE)"); }

 private:
  std::unique_ptr<SqliteConnection> db_;
};

/// The largest mark of a copy; -1 where a change is there in half.
int marks_of(const std::string& path) {
  auto db = open_job_database(path);
  if (!db) {
    ADD_FAILURE() << db.error().message;
    return -2;
  }
  Query query(**db, "SELECT COUNT(*), COALESCE(MAX(number), 0), SUM(number) FROM marks");
  if (!query.next()) return -2;
  const auto largest = static_cast<int>(query.integer(1));
  return query.integer(0) == 2 * largest && query.integer(2) == 0 ? largest : -1;
}

TEST(CopyDatabase, TakesALiveStoreAtOneMoment) {
  const test::TempFolder folder;
  LiveStore live(folder.file("state.db"));
  for (int i = 1; i <= 40; ++i) live.mark(i);
  ASSERT_TRUE(copy_database(folder.file("state.db"), folder.file("copy.db")).ok());
  EXPECT_EQ(marks_of(folder.file("copy.db")), 40);
  live.mark(41);  // it goes on
}

TEST(CopyDatabase, ChangesBetweenTheTwoFilesAreTakenAsAWhole) {
  const test::TempFolder folder;
  LiveStore live(folder.file("state.db"));
  for (int i = 1; i <= 10; ++i) live.mark(i);
  int next = 11;
  const auto copied =
      copy_database(folder.file("state.db"), folder.file("copy.db"), [&] { live.mark(next++); });
  ASSERT_TRUE(copied.ok()) << copied.error().message;
  EXPECT_EQ(marks_of(folder.file("copy.db")), next - 1);
}

TEST(CopyDatabase, ALogThatBeginsAnewIsNeverPairedWithTheOldDatabase) {
  const test::TempFolder folder;
  LiveStore live(folder.file("state.db"));
  for (int i = 1; i <= 10; ++i) live.mark(i);
  int disturbances = 0;
  const auto copied = copy_database(folder.file("state.db"), folder.file("copy.db"), [&] {
    if (++disturbances > 3) return;
    live.mark(10 + disturbances);
    live.checkpoint();
  });
  ASSERT_TRUE(copied.ok()) << copied.error().message;
  EXPECT_EQ(disturbances, 4);
  EXPECT_EQ(marks_of(folder.file("copy.db")), 13);
}

class Backup : public ::testing::Test {
 protected:
  Backup() : live_(data("state.db")) {
    for (int i = 1; i <= 5; ++i) live_.mark(i);
    EXPECT_EQ(*count_start(data("state.db.starts"), 6), 7U);
    write(data("films/3/log.key"), "key");
    write(data("films/3/log.lock"), "4711");
    write(data("films/3/00000001.films"), std::string(300'000, 'f'));
    write(data("films/3/00000002.snapshot.tmp"), "half");
    write(data("outputs/3/a b/ball.0001.exr"), std::string("picture\0of a ball", 17));
    write(data("outputs/3/.ball.0001.exr.0123456789abcdef.tmp"), "half");
    write(data("assets/" + std::string(64, 'a')), "mesh");
    write(data("assets/partial/" + std::string(64, 'b')), "half");
    write(data("audit.jsonl"), "{\"deed\":\"job.cancel\"}\n");
    write(data("audit.1.jsonl"), "{\"deed\":\"job.submit\"}\n");
    write(data("refusals.jsonl"), "{\"deed\":\"job.list\"}\n");
    write(data("uploads.3.jsonl"), "{\"deed\":\"file.upload\"}\n");
    write(data("audit.jsonl.tmp"), "half");
    write(data("tmp/1/film.bin"), "scratch");
    write(data("address"), "127.0.0.1:7700\n");
  }
  std::string data(const std::string& path) {
    fs::create_directories(folder_.file("data"));
    return folder_.file("data/" + path);
  }
  std::string tar() const { return folder_.file("backup.tar"); }
  std::string fresh(const std::string& path = "") const { return folder_.file("fresh" + path); }
  /// Nothing of a refused restore stays.
  void expect_refused(const std::string& why) {
    const auto restored = restore_backup(tar(), fresh());
    ASSERT_FALSE(restored);
    EXPECT_NE(restored.error().message.find(why), std::string::npos) << restored.error().message;
    for (const auto& entry : fs::directory_iterator(folder_.path())) {
      EXPECT_FALSE(entry.path().filename().string().starts_with("fresh")) << entry.path();
    }
  }

  test::TempFolder folder_;
  LiveStore live_;
};

TEST_F(Backup, ComesBackAsItWas) {
  const auto written = write_backup(folder_.file("data"), tar());
  ASSERT_TRUE(written) << written.error().message;
  EXPECT_EQ(written->files, 10U);
  const auto restored = restore_backup(tar(), fresh());
  ASSERT_TRUE(restored) << restored.error().message;
  EXPECT_EQ(restored->files, written->files);
  EXPECT_EQ(restored->bytes, written->bytes);
  EXPECT_EQ(marks_of(fresh("/state.db")), 5);
  for (const std::string& same :
       {std::string("films/3/log.key"), std::string("films/3/00000001.films"),
        std::string("outputs/3/a b/ball.0001.exr"), "assets/" + std::string(64, 'a'),
        std::string("audit.jsonl"), std::string("audit.1.jsonl"), std::string("refusals.jsonl"),
        std::string("uploads.3.jsonl")}) {
    EXPECT_EQ(read(fresh("/" + same)), read(data(same))) << same;
  }
  for (const char* none : {"films/3/log.lock", "films/3/00000002.snapshot.tmp",
                           "outputs/3/.ball.0001.exr.0123456789abcdef.tmp", "assets/partial", "tmp",
                           "address", "audit.jsonl.tmp"}) {
    EXPECT_FALSE(fs::exists(fresh(std::string("/") + none))) << none;
  }
  for (const auto& entry : fs::directory_iterator(folder_.path())) {
    const std::string name = entry.path().filename().string();
    EXPECT_TRUE(name == "data" || name == "fresh" || name == "backup.tar") << name;
  }
}

TEST_F(Backup, NamesMayBeAnyThatAJobMayGive) {
  write(data("outputs/4/bild_\xc3\xbc.png"), "umlaut");
  write(data("outputs/4/not-utf8-\xff.png"), "bytes");
  write(data("outputs/4/.dotted.png"), "dotted");
  write(data("outputs/4/two\nlines.png"), "of a finisher that somebody has taken over");
  const auto written = write_backup(folder_.file("data"), tar());
  ASSERT_TRUE(written) << written.error().message;
  EXPECT_EQ(written->left_out, std::vector<std::string>{"outputs/4/two\nlines.png"});
  const auto restored = restore_backup(tar(), fresh());
  ASSERT_TRUE(restored) << restored.error().message;
  for (const char* same :
       {"outputs/4/bild_\xc3\xbc.png", "outputs/4/not-utf8-\xff.png", "outputs/4/.dotted.png"}) {
    EXPECT_EQ(read(fresh(std::string("/") + same)), read(data(same))) << same;
  }
}

TEST_F(Backup, IsForItsOwnersEyesAlone) {
  const mode_t before = ::umask(0);
  const auto written = write_backup(folder_.file("data"), tar());
  const auto restored = restore_backup(tar(), fresh());
  ::umask(before);
  ASSERT_TRUE(written && restored);
  EXPECT_EQ(fs::status(tar()).permissions(), fs::perms(0600));
  EXPECT_EQ(fs::status(fresh()).permissions(), fs::perms(0700));
  EXPECT_EQ(fs::status(fresh("/state.db")).permissions(), fs::perms(0600));
}

TEST_F(Backup, StartsAreCountedFarBeyondThoseOfTheLostCoordinator) {
  ASSERT_TRUE(write_backup(folder_.file("data"), tar()));
  ASSERT_TRUE(restore_backup(tar(), fresh()));
  EXPECT_GT(*count_start(fresh("/state.db.starts"), 0), 1000U);
}

TEST_F(Backup, ATornOneIsRefusedWhereverItIsCut) {
  ASSERT_TRUE(write_backup(folder_.file("data"), tar()));
  const std::string whole = read(tar());
  // The tar ends with blocks of zeros: what lies before them matters.
  const size_t end = whole.find_last_not_of('\0') + 1;
  for (const size_t size : {size_t{0}, size_t{100}, size_t{512}, size_t{1500}, end / 4, end / 2,
                            end - 700, end - 100, end - 1}) {
    write(tar(), whole.substr(0, size));
    expect_refused("");
  }
}

TEST_F(Backup, ADamagedFileIsRefusedAndNamed) {
  ASSERT_TRUE(write_backup(folder_.file("data"), tar()));
  std::string bytes = read(tar());
  const size_t at = bytes.find(std::string(1000, 'f'));
  ASSERT_NE(at, std::string::npos);
  bytes[at + 5] ^= 1;
  write(tar(), bytes);
  expect_refused("films/3/00000001.films is damaged");
}

TEST_F(Backup, WhatIsNoBackupIsRefused) {
  write(tar(), "This is a letter, and no tar file." + std::string(2000, 'x'));
  expect_refused("");
  fs::remove(tar());
  expect_refused("backup.tar");
}

TEST_F(Backup, OnlyAFreshFolderIsRestoredInto) {
  ASSERT_TRUE(write_backup(folder_.file("data"), tar()));
  const auto onto = restore_backup(tar(), folder_.file("data"));
  ASSERT_FALSE(onto);
  EXPECT_NE(onto.error().message.find("expected a folder that is not there yet"),
            std::string::npos);
  fs::create_directories(fresh());
  EXPECT_TRUE(restore_backup(tar(), fresh() + "/"));
  const auto nothing = write_backup(folder_.file("elsewhere"), tar());
  ASSERT_FALSE(nothing);
  EXPECT_NE(nothing.error().message.find("expected the folder of a coordinator"),
            std::string::npos);
}

TEST_F(Backup, AFolderThatIsThereIsFilledAsADiskIsMountedThere) {
  ASSERT_TRUE(write_backup(folder_.file("data"), tar()));
  fs::create_directories(fresh("/lost+found"));
  write(fresh("/.restoring-1/state.db"), "of a restoration that was killed");
  struct stat before {};
  ASSERT_EQ(::stat(fresh().c_str(), &before), 0);
  const auto restored = restore_backup(tar(), fresh());
  ASSERT_TRUE(restored) << restored.error().message;
  struct stat after {};
  ASSERT_EQ(::stat(fresh().c_str(), &after), 0);
  EXPECT_EQ(after.st_ino, before.st_ino) << "a place of mounting cannot be replaced";
  EXPECT_EQ(marks_of(fresh("/state.db")), 5);
  EXPECT_EQ(read(fresh("/films/3/log.key")), "key");
  for (const auto& entry : fs::directory_iterator(fresh())) {
    EXPECT_FALSE(entry.path().filename().string().starts_with(".")) << entry.path();
  }
}

TEST_F(Backup, ATornOneLeavesAFolderThatIsThereEmpty) {
  ASSERT_TRUE(write_backup(folder_.file("data"), tar()));
  fs::resize_file(tar(), fs::file_size(tar()) / 2);
  fs::create_directories(fresh());
  EXPECT_FALSE(restore_backup(tar(), fresh()));
  EXPECT_TRUE(fs::is_empty(fresh()));
}

TEST(Manifest, HoldsOnlyACoordinatorsOwnFiles) {
  for (const char* path :
       {"state.db", "films/1/00000001.films", "outputs/7/a/b.png", "assets/aa"}) {
    EXPECT_TRUE(is_backup_path(path)) << path;
  }
  for (const char* path : {"", "/etc/passwd", "state.db-wal", "films", "films/", "films/../../x",
                           "outputs/./a", "outputs//a", "assets/a\nb", "tmp/a", "films/.."}) {
    EXPECT_FALSE(is_backup_path(path)) << path;
  }
}

TEST(Manifest, IsReadBackAndDamageIsNoticed) {
  Manifest manifest;
  manifest.files["state.db"] = {5, std::string(64, '0')};
  manifest.files["outputs/1/a b.png"] = {77, std::string(64, 'f')};
  const std::string text = write_manifest(manifest);
  EXPECT_EQ(parse_manifest(text)->files, manifest.files);
  for (size_t i = 0; i < text.size(); ++i) {
    std::string damaged = text;
    damaged[i] = static_cast<char>(damaged[i] ^ 4);
    EXPECT_FALSE(parse_manifest(damaged)) << i;
    EXPECT_FALSE(parse_manifest(text.substr(0, i))) << i;
  }
}

}  // namespace
}  // namespace hyades::coordinator
