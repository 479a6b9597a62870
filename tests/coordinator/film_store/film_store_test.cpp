// Films of finished frames leave the log when the disk is short.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <mutex>
#include <random>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "coordinator/film_store/film_store.h"
#include "tests/coordinator/film_store/fake_film.h"
#include "tests/coordinator/film_store/faulty_files.h"
#include "tests/support/temp_folder.h"

namespace hyades::coordinator {
namespace {

constexpr uint32_t kFilmSamples = 16;

/// A film store on files in memory, and somebody who merges what is durable.
class Kept final : public FilmStore::Listener {
 public:
  explicit Kept(FaultyFiles& files, Duration patience = std::chrono::seconds(30),
                KeptFilms before = KeptFilms::erase, const std::string& aside = {})
      : film_store_(films(), log(files, patience, before, aside), *this) {
    EXPECT_TRUE(film_store_.open().ok());
    EXPECT_TRUE(film_store_.start(16).ok());
  }

  /// Whether the film of `tile` is durable within some seconds.
  bool keep(int32_t frame, const core::PixelRect& tile) {
    const RecordId record{++records_};
    const core::Unit unit{frame, tile, {0, 1}};
    film_store_.append_rendered(record, {{}, {unit, {}, {}}}, fake_film(unit, kFilmSamples));
    return is_durable(record);
  }
  /// Whether what the scheduler says of films is durable within some seconds.
  bool say(const Record& what) {
    const RecordId record{++records_};
    {
      const std::lock_guard lock(mutex_);
      said_.insert(record);
    }
    film_store_.append(record, what);
    return is_durable(record);
  }
  /// Hands a film over to a disk that is full; whether the owner is told of that within some
  /// seconds.
  bool is_told_of_trouble(int32_t frame, const core::PixelRect& tile) {
    const core::Unit unit{frame, tile, {0, 1}};
    film_store_.append_rendered(RecordId{++records_}, {{}, {unit, {}, {}}},
                                fake_film(unit, kFilmSamples));
    std::unique_lock lock(mutex_);
    const bool told = changed_.wait_for(lock, std::chrono::seconds(20), [&] { return told_ > 0; });
    told_ = 0;
    return told;
  }
  void finish(int32_t frame) {
    on_its_thread([&] { film_store_.forget(frame, FrameEnd::finished); });
  }
  void make_room() {
    film_store_.make_room();
    on_its_thread([] {});  // it has been seen
    on_its_thread([] {});  // and dealt with
  }

  bool set_aside(int32_t frame) {
    bool done = false;
    on_its_thread([&] { done = film_store_.set_aside(frame).ok(); });
    return done;
  }
  bool is_aside(int32_t frame) {
    bool aside = false;
    on_its_thread([&] { aside = film_store_.is_aside(frame); });
    return aside;
  }
  /// Of what is in memory of the frame; empty: nothing is.
  std::string digest(int32_t frame) {
    std::string digest;
    on_its_thread([&] {
      if (const auto film = film_store_.film(frame)) digest = film->digest();
    });
    return digest;
  }
  std::string digest_aside(int32_t frame) {
    std::string digest;
    on_its_thread([&] {
      if (const auto film = film_store_.read_aside(frame); film && *film) {
        digest = (*film)->digest();
      }
    });
    return digest;
  }
  bool fetch(int32_t frame) {
    bool done = false;
    on_its_thread([&] { done = film_store_.fetch(frame); });
    return done;
  }
  int outgrown() const { return outgrown_; }

  void outgrown(int32_t, const std::string&) override { ++outgrown_; }
  void persisted(RecordId record) override {
    const std::lock_guard lock(mutex_);
    EXPECT_TRUE(said_.contains(record) || film_store_.merge(record).ok());
    durable_.insert(record);
    changed_.notify_all();
  }
  void not_persisted(RecordId, const std::string& reason) override { ADD_FAILURE() << reason; }
  void try_again() override {}
  void storage_failed(const std::string&) override {
    const std::lock_guard lock(mutex_);
    ++told_;
    changed_.notify_all();
  }
  void drained() override {}

 private:
  bool is_durable(RecordId record) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, std::chrono::seconds(20),
                             [&] { return durable_.contains(record); });
  }
  static FilmSet films() { return {{1, 2, 3, 4}, {0, 0, 64, 16}, kFilmSamples}; }
  static FilmStoreOptions log(FaultyFiles& files, Duration patience, KeptFilms before,
                              const std::string& aside) {
    FilmStoreOptions log;
    log.aside_folder = aside;
    log.kept = before;
    log.kept_aside = before != KeptFilms::erase;
    log.patience = patience;
    log.folder = "films";
    log.files = &files;
    log.compact_bytes = uint64_t{1} << 30U;
    return log;
  }
  void on_its_thread(const std::function<void()>& what) {
    bool done = false;
    film_store_.call([&] {
      what();
      const std::lock_guard lock(mutex_);
      done = true;
      changed_.notify_all();
    });
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return done; });
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::set<RecordId> durable_;
  std::set<RecordId> said_;  ///< records without a film
  uint64_t records_ = 0;
  int told_ = 0;  ///< of trouble
  std::atomic<int> outgrown_{0};
  FilmStore film_store_;
};

uint64_t size_of(FaultyFiles& files) {
  uint64_t bytes = 0;
  for (const std::string& path : files.paths()) bytes += files.bytes(path).size();
  return bytes;
}

core::PixelRect tile(int number) { return {16 * number, 0, 16 * number + 16, 16}; }

TEST(FilmStore, FinishedFramesLeaveTheLogWhenRoomIsAskedFor) {
  FaultyFiles files;
  Kept kept(files);
  for (int i = 0; i < 4; ++i) ASSERT_TRUE(kept.keep(1, tile(i)));
  ASSERT_TRUE(kept.keep(2, tile(0)));
  const uint64_t before = size_of(files);
  kept.finish(1);
  kept.make_room();
  EXPECT_LT(size_of(files), before / 2);
  const uint64_t writes = files.operations();
  kept.make_room();
  EXPECT_EQ(files.operations(), writes) << "there is nothing to gain any more";
}

TEST(FilmStore, AFullDiskIsRelievedByThem) {
  FaultyFiles files;
  Kept kept(files);
  for (int i = 0; i < 4; ++i) ASSERT_TRUE(kept.keep(1, tile(i)));
  ASSERT_TRUE(kept.keep(2, tile(0)));
  kept.finish(1);
  const uint64_t used = size_of(files);
  // Not enough for two tiles, but for what is still of use.
  files.set_capacity(used + used / 3);
  EXPECT_TRUE(kept.keep(2, {16, 0, 64, 16}));
}

TEST(FilmStore, EachOutageOfTheDiskIsTold) {
  FaultyFiles files;
  Kept kept(files, std::chrono::milliseconds(50));
  for (int outage = 0; outage < 2; ++outage) {
    ASSERT_TRUE(kept.keep(1, tile(2 * outage)));
    files.set_capacity(size_of(files));
    EXPECT_TRUE(kept.is_told_of_trouble(1, tile(2 * outage + 1))) << outage;
    files.set_capacity(UINT64_MAX);
  }
}

/// Of a store that nobody gives anything.
class Idle final : public FilmStore::Listener {
 public:
  void persisted(RecordId) override {}
  void not_persisted(RecordId, const std::string&) override {}
  void outgrown(int32_t, const std::string&) override {}
  void try_again() override {}
  void storage_failed(const std::string&) override {}
  void drained() override {}
};

/// Lets the process have `more` bytes of address space than it has.
void limit_memory(uint64_t more) {
  std::ifstream statm("/proc/self/statm");
  uint64_t pages = 0;
  statm >> pages;
  rlimit limit{};
  getrlimit(RLIMIT_AS, &limit);
  limit.rlim_cur = pages * static_cast<uint64_t>(sysconf(_SC_PAGESIZE)) + more;
  setrlimit(RLIMIT_AS, &limit);
}

/// Each open job has threads, and a thread a stack: it must not end the process where there is
/// none.
TEST(FilmStoreDeathTest, WithoutMoreThreadsItIsNotOpenedAndMayBeLater) {
  const auto try_it = [] {
    FaultyFiles files;
    Idle idle;
    FilmStoreOptions options;
    options.folder = "films";
    options.files = &files;
    FilmStore films({{1}, {0, 0, 16, 16}, kFilmSamples}, options, idle);
    limit_memory(uint64_t{1} << 20U);
    const auto refused = films.open();
    limit_memory(uint64_t{1} << 36U);
    if (refused || refused.error().message.find("no more threads") == std::string::npos) return 1;
    return films.open().ok() && films.start(16).ok() ? 0 : 2;
  };
  EXPECT_EXIT(std::_Exit(try_it()), testing::ExitedWithCode(0), "");
}

TEST(FilmStore, AFilmThatIsSetAsideTakesNoMemoryAndComesBack) {
  FaultyFiles files;
  Kept kept(files);
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(kept.keep(1, tile(i)));
  const std::string before = kept.digest(1);
  ASSERT_NE(before, "");
  EXPECT_TRUE(kept.set_aside(1));
  EXPECT_TRUE(kept.is_aside(1));
  EXPECT_EQ(kept.digest(1), "");
  EXPECT_EQ(kept.digest_aside(1), before);
  EXPECT_TRUE(kept.is_aside(1)) << "looking at it changes nothing";
  EXPECT_TRUE(kept.fetch(1));
  EXPECT_EQ(kept.digest(1), before);
  EXPECT_FALSE(kept.is_aside(1));
  // What is merged with it fetches it, too.
  EXPECT_TRUE(kept.set_aside(1));
  ASSERT_TRUE(kept.keep(1, tile(3)));
  FaultyFiles other_files;
  Kept other(other_files);
  for (int i = 0; i < 4; ++i) ASSERT_TRUE(other.keep(1, tile(i)));
  EXPECT_EQ(kept.digest(1), other.digest(1));
  EXPECT_TRUE(kept.set_aside(2)) << "there is none";
  EXPECT_EQ(kept.outgrown(), 0);
}

/// The file of a film that is set aside; empty where there is none.
std::string path_aside(const FaultyFiles& files) {
  for (const std::string& path : files.paths()) {
    if (path.ends_with(".aside")) return path;
  }
  return {};
}

TEST(FilmStore, FilmsThatAreSetAsideStayInTheLog) {
  FaultyFiles files;
  std::string before;
  std::string aside;
  {
    Kept kept(files);
    for (int i = 0; i < 3; ++i) ASSERT_TRUE(kept.keep(1, tile(i)));
    for (int i = 0; i < 3; ++i) ASSERT_TRUE(kept.keep(2, tile(i)));
    before = kept.digest(1);
    EXPECT_TRUE(kept.set_aside(1));
    kept.finish(2);
    kept.make_room();  // the log is rewritten
    EXPECT_TRUE(kept.is_aside(1));
    aside = path_aside(files);
    EXPECT_NE(aside, "");
  }
  EXPECT_EQ(path_aside(files), "") << "it goes with the store";
  EXPECT_TRUE(files.create(aside).ok());  // what a kill would have left
  Kept again(files, std::chrono::seconds(30), KeptFilms::require);
  EXPECT_EQ(again.digest_aside(1), before);
  EXPECT_EQ(path_aside(files), "");
}

TEST(FilmStore, FilmsThatAreSetAsideLieOnThisMachinesDiskWhereTheLogDoesNot) {
  FaultyFiles files;
  const test::TempFolder disk;
  const std::string aside = disk.file("new/7");
  const auto on_disk = [&] {
    std::vector<std::string> names = disk_log_files().list(aside).value();
    std::sort(names.begin(), names.end());
    return names;
  };
  std::string before;
  {
    Kept kept(files, std::chrono::seconds(30), KeptFilms::erase, aside);
    ASSERT_TRUE(kept.keep(1, tile(0)) && kept.keep(1, tile(1)) && kept.keep(2, tile(0)));
    before = kept.digest(1);
    ASSERT_TRUE(kept.set_aside(1) && kept.set_aside(2));
    EXPECT_EQ(on_disk(), (std::vector<std::string>{"1.aside", "2.aside"}));
    EXPECT_EQ(path_aside(files), "");
    EXPECT_EQ(kept.digest_aside(1), before);
    kept.make_room();
    ASSERT_TRUE(kept.fetch(1));
    EXPECT_EQ(kept.digest(1), before);
    EXPECT_EQ(on_disk(), std::vector<std::string>{"2.aside"});
  }
  EXPECT_TRUE(on_disk().empty()) << "it goes with the store";
  EXPECT_TRUE(disk_log_files().create(aside + "/3.aside").ok());  // what a kill would have left
  Kept again(files, std::chrono::seconds(30), KeptFilms::require, aside);
  EXPECT_TRUE(on_disk().empty());
  EXPECT_EQ(again.digest_aside(1), before);
}

TEST(FilmStore, AFilmForWhichTheDiskHasNoRoomStays) {
  FaultyFiles files;
  Kept kept(files);
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(kept.keep(1, tile(i)));
  const std::string before = kept.digest(1);
  const size_t paths = files.paths().size();
  files.set_capacity(size_of(files) + 100);
  EXPECT_FALSE(kept.set_aside(1));
  EXPECT_EQ(kept.digest(1), before);
  EXPECT_EQ(files.paths().size(), paths);
}

TEST(FilmStore, AFilmThatCannotBeFetchedFailsItsFrame) {
  FaultyFiles files;
  Kept kept(files);
  ASSERT_TRUE(kept.keep(1, tile(0)));
  EXPECT_TRUE(kept.set_aside(1));
  for (const std::string& path : files.paths()) {
    if (!path.ends_with(".aside")) continue;
    EXPECT_TRUE(files.truncate(path, 40).ok());
  }
  EXPECT_FALSE(kept.fetch(1));
  EXPECT_EQ(kept.outgrown(), 1);
}

/// Fetches the film of frame 1, which cannot be read for a moment.
bool fetch_after_a_while(FaultyFiles& files, Kept& kept) {
  files.refuse_to_open(true);
  std::thread other([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    files.refuse_to_open(false);
  });
  const bool done = kept.fetch(1);
  other.join();
  return done;
}

TEST(FilmStore, AFilmThatCannotBeReadForAMomentIsNotLost) {
  FaultyFiles files;
  std::string before;
  {
    Kept kept(files);
    for (int i = 0; i < 3; ++i) ASSERT_TRUE(kept.keep(1, tile(i)));
    before = kept.digest(1);
    ASSERT_TRUE(kept.set_aside(1));
    EXPECT_TRUE(fetch_after_a_while(files, kept));
    EXPECT_EQ(kept.digest(1), before);
  }
  // Out of the log, too.
  Kept again(files, std::chrono::seconds(30), KeptFilms::require);
  EXPECT_TRUE(fetch_after_a_while(files, again));
  EXPECT_EQ(again.digest(1), before);
  EXPECT_EQ(again.outgrown(), 0);
}

TEST(FilmStore, AFilmThatCannotBeReadForLongFailsItsFrame) {
  FaultyFiles files;
  Kept kept(files, std::chrono::milliseconds(200));
  ASSERT_TRUE(kept.keep(1, tile(0)));
  ASSERT_TRUE(kept.set_aside(1));
  files.refuse_to_open(true);
  EXPECT_FALSE(kept.fetch(1));
  EXPECT_EQ(kept.outgrown(), 1);
}

// All frames of all jobs that are open at a start may hold more than there is memory, and so may
// those that failed, of which the log tells nothing.
TEST(FilmStore, OfALogThatIsOpenedNoFilmComesIntoMemory) {
  FaultyFiles files;
  std::string before[5];
  {
    Kept kept(files);
    for (int frame = 1; frame <= 4; ++frame) {
      for (int i = 0; i < frame; ++i) ASSERT_TRUE(kept.keep(frame, tile(i)));
      before[frame] = kept.digest(frame);
    }
  }
  for (int life = 0; life < 2; ++life) {
    Kept again(files, std::chrono::seconds(30), KeptFilms::require);
    for (int frame = 1; frame <= 4; ++frame) {
      EXPECT_EQ(again.digest(frame), "");
      EXPECT_EQ(again.digest_aside(frame), before[frame]);
    }
    again.finish(4);
    EXPECT_FALSE(again.is_aside(4));
    EXPECT_EQ(path_aside(files), "") << "nothing is written";
    // Nor does any when the log is rewritten, and they are found in what it is then.
    const uint64_t long_log = size_of(files);
    again.make_room();
    EXPECT_TRUE(life > 0 || size_of(files) < long_log);
    for (int frame = 1; frame <= 3; ++frame) {
      EXPECT_EQ(again.digest(frame), "");
      EXPECT_EQ(again.digest_aside(frame), before[frame]);
    }
    before[4].clear();
    EXPECT_TRUE(again.fetch(2));
    EXPECT_EQ(again.digest(2), before[2]);
    EXPECT_EQ(again.digest(1) + again.digest(3), "");
  }
}

/// How long the first records in the file of a film that is set aside are, with their lengths.
uint64_t bytes_of_records(FaultyFiles& files, int records) {
  const std::vector<std::byte>& bytes = files.bytes(path_aside(files));
  uint64_t at = 0;
  for (int i = 0; i < records; ++i) {
    uint64_t size = 0;
    std::memcpy(&size, bytes.data() + at, sizeof size);
    at += sizeof size + size;
  }
  return at;
}

TEST(FilmStore, AFilmOfWhichATileIsGoneIsNotFetched) {
  FaultyFiles files;
  Kept kept(files);
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(kept.keep(1, tile(i)));
  ASSERT_TRUE(kept.set_aside(1));
  ASSERT_EQ(bytes_of_records(files, 3), files.bytes(path_aside(files)).size());
  EXPECT_TRUE(files.truncate(path_aside(files), bytes_of_records(files, 2)).ok());
  EXPECT_FALSE(kept.fetch(1));
  EXPECT_EQ(kept.outgrown(), 1);
}

// A worker that is found divergent has parts in films of any number of frames.
TEST(FilmStore, ATileOfAFilmThatIsSetAsideBecomesVoidWhereItLies) {
  FaultyFiles other_files;
  Kept other(other_files);
  for (const int i : {0, 2}) ASSERT_TRUE(other.keep(1, tile(i)));
  const std::string without = other.digest(1);
  ASSERT_TRUE(other.keep(1, tile(1)));
  const std::string whole = other.digest(1);
  FaultyFiles files;
  for (const KeptFilms before : {KeptFilms::erase, KeptFilms::require}) {
    // In a file of its own, and in the log of the run before.
    Kept kept(files, std::chrono::seconds(30), before);
    if (before == KeptFilms::erase) {
      for (int i = 0; i < 3; ++i) ASSERT_TRUE(kept.keep(1, tile(i)));
      ASSERT_TRUE(kept.set_aside(1));
    }
    ASSERT_TRUE(kept.say(TileVoidedRecord{{}, 1, tile(1)}));
    EXPECT_TRUE(kept.is_aside(1));
    EXPECT_EQ(kept.digest_aside(1), without);
    kept.make_room();
    EXPECT_TRUE(kept.is_aside(1));
    EXPECT_EQ(kept.digest_aside(1), without);
    // What comes afterwards is not void.
    ASSERT_TRUE(kept.keep(1, tile(1)));
    EXPECT_EQ(kept.digest(1), whole);
    ASSERT_TRUE(kept.set_aside(1));
  }
  Kept again(files, std::chrono::seconds(30), KeptFilms::require);
  EXPECT_EQ(again.digest_aside(1), whole);
  ASSERT_TRUE(again.say(TileVoidedRecord{{}, 1, tile(1)}));
  EXPECT_TRUE(again.fetch(1));
  EXPECT_EQ(again.digest(1), without);
}

TEST(FilmStore, OfAFilmThatIsSetAsideNothingIsLeftWhenItsFrameBeginsAgain) {
  FaultyFiles files;
  Kept kept(files);
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(kept.keep(1, tile(i)));
  ASSERT_TRUE(kept.set_aside(1));
  ASSERT_TRUE(kept.say(FrameRestartedRecord{{}, 1}));
  EXPECT_EQ(path_aside(files), "");
  ASSERT_TRUE(kept.keep(1, tile(3)));
  FaultyFiles other_files;
  Kept other(other_files);
  ASSERT_TRUE(other.keep(1, tile(3)));
  EXPECT_EQ(kept.digest(1), other.digest(1));
}

// The file of a film that is set aside is never synced, and what a loss of power leaves of it and
// of its name is anything.
TEST(FilmStore, FilmsThatAreSetAsideComeOutOfTheLogWhenThePowerGoes) {
  std::mt19937 random(7);
  int left = 0;  // files that were there after the power had gone
  for (uint64_t after = 0; after < 40; ++after) {
    FaultyFiles files;
    std::string before;
    {
      Kept kept(files);
      for (int i = 0; i < 3; ++i) ASSERT_TRUE(kept.keep(1, tile(i)));
      ASSERT_TRUE(kept.keep(2, tile(0)));
      before = kept.digest(1);
      kept.finish(2);
      // While it is set aside, while the log is rewritten with it, or afterwards.
      files.fail_from_operation(files.operations() + after % 20);
      kept.set_aside(1);
      kept.make_room();
      files.fail_from_operation(0);
    }
    files.crash(random);
    left += path_aside(files).empty() ? 0 : 1;
    Kept again(files, std::chrono::seconds(30), KeptFilms::require);
    ASSERT_EQ(again.digest_aside(1), before) << after;
    ASSERT_EQ(path_aside(files), "") << after;
    ASSERT_TRUE(again.keep(1, tile(3))) << after;
  }
  EXPECT_GT(left, 5);
}

}  // namespace
}  // namespace hyades::coordinator
