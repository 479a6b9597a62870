// What leaves a content store: files beyond its budget, and unfinished ones that nobody goes on
// with.

#include <dirent.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <ctime>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/base/hash.h"
#include "core/base/io_reason.h"
#include "core/base/posix_file.h"
#include "core/base/text.h"
#include "farm/content_store.h"

namespace hyades::farm {

using core::Error;
using core::Status;

namespace {

constexpr int64_t kPartialLife = 3 * 24 * 3600;  // s without a byte: an upload may rest a weekend
constexpr int64_t kSweepEvery = 3600;            // s
constexpr int64_t kPartialRest = 60;             // s without a byte, where room is wanted
constexpr uint64_t kSpare = 16;                  // part of the budget that is free after eviction

struct StoredFile {
  std::string path;
  uint64_t size = 0;
  int64_t used = 0;      ///< nanoseconds of the wall clock
  int64_t modified = 0;  ///< seconds of the wall clock
};

/// Behind a file's name, in the name of an owner's unfinished one: whatever an owner is called, it
/// is a name of a file, and no two owners have the same.
std::string owner_suffix(const std::string& owner) {
  return owner.empty() ? owner : "-" + core::to_hex(core::sha256(owner));
}

/// Adds the store's own files of `folder`, all or those of a `wanted` name: what else lies there is
/// not ours to count or remove.
void list_files(const std::string& folder, std::vector<StoredFile>& files,
                const std::function<bool(std::string_view)>& wanted = {}) {
  DIR* open = ::opendir(folder.c_str());
  if (open == nullptr) return;
  while (const dirent* entry = ::readdir(open)) {  // NOLINT(concurrency-mt-unsafe): own stream
    struct stat info {};
    if (!is_content_name(std::string_view(entry->d_name).substr(0, 64))) continue;
    if (wanted && !wanted(entry->d_name)) continue;
    if (::fstatat(::dirfd(open), entry->d_name, &info, AT_SYMLINK_NOFOLLOW) != 0) continue;
    if (!S_ISREG(info.st_mode)) continue;
    files.push_back({folder + "/" + entry->d_name, static_cast<uint64_t>(info.st_size),
                     int64_t{info.st_atim.tv_sec} * 1'000'000'000 + info.st_atim.tv_nsec,
                     info.st_mtim.tv_sec});
  }
  ::closedir(open);
}

/// The number in the file; 0 where there is none. Wrong ones do no harm: see ContentStore::Total.
uint64_t read_count(int file) {
  uint64_t count = 0;
  const auto bytes = std::as_writable_bytes(std::span(&count, 1));
  const auto got = core::read_all_at(file, bytes, 0);
  return got && *got == bytes.size() ? count : 0;
}

bool write_count(int file, uint64_t count) {
  return core::write_all_at(file, std::as_bytes(std::span(&count, 1)), 0);
}

std::string name_in(const std::string& path) { return path.substr(path.rfind('/') + 1); }

/// Removes `path` unless somebody holds a lock on it.
bool remove_if_free(const std::string& path) {
  const core::Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW));
  return file.valid() && ::flock(file.get(), LOCK_EX | LOCK_NB) == 0 && ::unlink(path.c_str()) == 0;
}

}  // namespace

std::string ContentStore::partial_path(const std::string& name, const std::string& owner) const {
  return options_.folder + "/partial/" + name + owner_suffix(owner);
}

Status ContentStore::admit(const Uploader& whose, const std::string& path) {
  if (!whose.may_begin) return {};
  std::vector<StoredFile> files;
  list_files(options_.folder + "/partial", files,
             [suffix = owner_suffix(whose.owner)](std::string_view file) {
               std::string_view rest = file.substr(64);
               if (!rest.starts_with(suffix)) return false;
               rest.remove_prefix(suffix.size());
               return rest.empty() || rest.front() == '.';  // a copy
             });
  const int64_t rested = std::time(nullptr) - kPartialRest;
  std::vector<StoredFile> resting;
  UnfinishedFiles others;
  UnfinishedFiles busy;
  for (StoredFile& file : files) {
    const auto written = writing_.find(file.path);
    // What there is of the file itself is among its bytes; one that is written stays beside it.
    if (file.path == path && written == writing_.end()) continue;
    if (written != writing_.end()) file.size = std::max(file.size, written->second);
    others = {others.files + 1, others.bytes + file.size};
    if (written == writing_.end() && file.modified <= rested) {
      resting.push_back(file);
    } else {
      busy = {busy.files + 1, busy.bytes + file.size};
    }
  }
  const bool would_do = whose.may_begin(busy).ok();  // if all that rest went
  Status may = whose.may_begin(others);
  if (may || !would_do) return may;
  std::sort(resting.begin(), resting.end(),
            [](const StoredFile& a, const StoredFile& b) { return a.modified < b.modified; });
  for (const StoredFile& file : resting) {
    if (may) break;
    if (!remove_if_free(file.path)) continue;
    others = {others.files - 1, others.bytes - file.size};
    may = whose.may_begin(others);
  }
  return may;
}

void ContentStore::drop_partials(const std::string& name) {
  std::vector<StoredFile> files;
  // Copies are left to those who write them: nobody else would go on with one.
  list_files(options_.folder + "/partial", files, [&](std::string_view file) {
    return file.starts_with(name) && file.find('.') == std::string_view::npos;
  });
  for (const StoredFile& file : files) remove_if_free(file.path);
}

void ContentStore::sweep_partials() {
  const int64_t now = std::chrono::duration_cast<std::chrono::seconds>(
                          std::chrono::steady_clock::now().time_since_epoch())
                          .count();
  int64_t due = next_sweep_;
  if (now < due || !next_sweep_.compare_exchange_strong(due, now + kSweepEvery)) return;
  std::vector<StoredFile> files;
  list_files(options_.folder + "/partial", files);
  for (const StoredFile& file : files) {
    if (file.modified + kPartialLife < std::time(nullptr)) remove_if_free(file.path);
  }
}

uint64_t ContentStore::free_partials(uint64_t bytes) {
  std::vector<StoredFile> files;
  list_files(options_.folder + "/partial", files);
  std::sort(files.begin(), files.end(),
            [](const StoredFile& a, const StoredFile& b) { return a.modified < b.modified; });
  uint64_t freed = 0;
  for (const StoredFile& file : files) {
    if (freed >= bytes || file.modified + kPartialRest > std::time(nullptr)) break;
    if (remove_if_free(file.path)) freed += file.size;
  }
  return freed;
}

Status ContentStore::make_room(const std::string& begun, uint64_t bytes, bool* crowded) {
  if (options_.budget == 0) return {};
  if (bytes > options_.budget) {
    if (crowded != nullptr) *crowded = true;
    return Error{fmt::format("a file of {} is larger than the whole budget of {}, {}",
                             core::format_bytes(bytes), options_.folder,
                             core::format_bytes(options_.budget))};
  }
  const core::MutexLock mine(room_mutex_);
  // One process at a time, so that two do not both evict for the same shortage.
  const std::string lock_path = options_.folder + "/lock";
  const core::Descriptor lock(::open(lock_path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600));
  if (!lock.valid() || !core::lock_file(lock.get(), LOCK_EX, options_.lock_patience)) {
    return Error{"cannot lock " + lock_path + ": " + core::lock_reason(errno)};
  }
  const uint64_t begun_by_all = read_count(lock.get());
  const auto now = std::chrono::steady_clock::now();
  bool known = total_ && now - total_->listed < options_.list_every;
  if (known && begun_by_all >= total_->begun) {
    total_->bytes += begun_by_all - std::exchange(total_->begun, begun_by_all);
    known = total_->bytes + bytes <= options_.budget;
  } else {
    known = false;  // the count was lost
  }
  if (!known) {
    const uint64_t used = evict(begun, expected_ + bytes);
    total_ = Total{used - bytes, begun_by_all, now};
    if (used > options_.budget) {
      if (crowded != nullptr) *crowded = true;
      return Error{fmt::format("the budget of {}, {}, is taken by files in use: {} more are needed",
                               options_.folder, core::format_bytes(options_.budget),
                               core::format_bytes(used - options_.budget))};
    }
  }
  total_->bytes += bytes;
  total_->begun += bytes;
  // What others are not told of they find when they list.
  if (bytes > 0) (void)write_count(lock.get(), total_->begun);
  return {};
}

/// Lists all files, and evicts where they are too many. What they take with `used` bytes more, but
/// for what there is of the unfinished file `begun`, which is among these.
uint64_t ContentStore::evict(const std::string& begun, uint64_t used) {
  std::vector<StoredFile> files;
  list_files(options_.folder, files);
  list_files(options_.folder + "/partial", files);
  std::erase_if(files, [&](const StoredFile& file) { return file.path == begun; });
  for (const StoredFile& file : files) used += file.size;
  if (used <= options_.budget) return used;
  std::sort(files.begin(), files.end(),
            [](const StoredFile& a, const StoredFile& b) { return a.used < b.used; });
  // Some more than must go, so that a full store is not listed for each file that is written.
  const uint64_t enough = options_.budget - options_.budget / kSpare;
  for (const StoredFile& file : files) {
    if (used <= enough) break;
    if (!remove_if_free(file.path)) continue;
    used -= file.size;
    forget(name_in(file.path));
  }
  return used;
}

std::vector<std::string> ContentStore::names() const {
  std::vector<StoredFile> files;
  list_files(options_.folder, files);
  std::vector<std::string> names;
  names.reserve(files.size());
  for (const StoredFile& file : files) names.push_back(name_in(file.path));
  return names;
}

uint64_t ContentStore::used() const {
  std::vector<StoredFile> files;
  list_files(options_.folder, files);
  uint64_t bytes = 0;
  for (const StoredFile& file : files) bytes += file.size;
  return bytes;
}

bool ContentStore::remove_unused(const std::string& name, std::chrono::nanoseconds age) {
  if (!is_content_name(name)) return false;
  struct stat info {};
  const std::string path = path_of(name);
  if (::lstat(path.c_str(), &info) != 0) return errno == ENOENT;
  const auto of = [](const timespec& t) { return int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec; };
  const int64_t used = std::max(of(info.st_atim), of(info.st_mtim));
  const int64_t now = std::chrono::duration_cast<std::chrono::nanoseconds>(
                          std::chrono::system_clock::now().time_since_epoch())
                          .count();
  if (now - used < age.count() || !remove_if_free(path)) return false;
  forget(name);
  return true;
}

}  // namespace hyades::farm
