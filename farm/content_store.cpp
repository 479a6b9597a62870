#include "farm/content_store.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <ctime>
#include <utility>

#include "core/base/assets.h"
#include "core/base/failpoint.h"
#include "core/base/hash.h"
#include "core/base/io_reason.h"
#include "core/base/posix_file.h"

namespace hyades::farm {

using core::Bytes;
using core::Error;
using core::Result;
using core::Status;

namespace {

/// From here on who may come again does not wait while a file is hashed: it takes more than a
/// moment.
constexpr uint64_t kLarge = uint64_t{16} << 20U;
/// Such files that are hashed at a time: of the threads that serve files others go on with the
/// rest.
constexpr size_t kMostLarge = 3;
/// Of unfinished files of so many bytes it is kept how far their hash has come, and of how many.
constexpr uint64_t kKept = uint64_t{1} << 20U;
constexpr size_t kMostKept = 4096;

Error not_a_name(const std::string& name) {
  return {"'" + name.substr(0, 80) + "' is not the SHA-256 of a file (64 digits of 0-9 and a-f)"};
}

Status make_folder(const std::string& path) {
  // For this user alone: assets may be secret.
  if (::mkdir(path.c_str(), 0700) == 0) return {};
  const int error = errno;
  struct stat info {};
  // Who may make none (the process that renders) may still use one that is there.
  if (::stat(path.c_str(), &info) == 0 && S_ISDIR(info.st_mode)) return {};
  return Error{"cannot make the folder " + path + ": " + core::io_reason(error)};
}

Status sync_folder(const std::string& path) {
  if (core::sync_folder(path)) return {};
  return Error{"cannot write " + path + ": " + core::io_reason(errno)};
}

}  // namespace

bool is_content_name(std::string_view name) {
  return name.size() == 64 && std::all_of(name.begin(), name.end(), [](char c) {
           return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
         });
}

Result<std::unique_ptr<ContentStore>> ContentStore::open(const Options& options) {
  for (const std::string& folder : {options.folder, options.folder + "/partial"}) {
    if (auto made = make_folder(folder); !made) return made.error();
  }
  auto store = std::unique_ptr<ContentStore>(new ContentStore(options));
  store->sweep_partials();
  if (auto fits = store->make_room({}, 0); !fits) return fits.error();
  return store;
}

Result<ContentStore::Identity> ContentStore::identify(const std::string& path) {
  struct stat info {};
  if (::lstat(path.c_str(), &info) != 0) {
    if (errno == ENOENT) return Error{"it is not here"};
    return Error{"cannot read " + path + ": " + core::io_reason(errno)};
  }
  if (!S_ISREG(info.st_mode)) return Error{path + " is not a regular file"};
  return Identity{info.st_ino, static_cast<uint64_t>(info.st_size),
                  int64_t{info.st_mtim.tv_sec} * 1'000'000'000 + info.st_mtim.tv_nsec};
}

void ContentStore::remember(const std::string& name, const Identity& identity) {
  const core::MutexLock lock(mutex_);
  verified_[name] = identity;
}

void ContentStore::forget(const std::string& name) {
  const core::MutexLock lock(mutex_);
  verified_.erase(name);
}

size_t ContentStore::known() const {
  const core::MutexLock lock(mutex_);
  return verified_.size();
}

bool ContentStore::contains(const std::string& name, uint64_t size, bool* busy) {
  if (!is_content_name(name)) return false;
  const auto identity = identify(path_of(name));
  if (!identity) return false;
  // A wrong size is the file's or the caller's fault: the bytes know.
  return identity->size == size || read(name, busy).ok();
}

bool ContentStore::missing(const std::string& name) const {
  struct stat info {};
  return !is_content_name(name) || (::stat(path_of(name).c_str(), &info) != 0 && errno == ENOENT);
}

ContentStore::Hashing::Hashing(ContentStore& store, std::string path, uint64_t bytes, bool* busy)
    : store_(store), path_(std::move(path)), large_(bytes >= kLarge) {
  const core::MutexLock lock(store_.mutex_);
  const bool waits = busy == nullptr || !large_;
  while (!begin()) {
    if (!waits) {
      *busy = true;
      return;
    }
    store_.hashed_.wait(store_.mutex_);
  }
  begun_ = true;
}

ContentStore::Hashing::~Hashing() {
  if (!begun_) return;
  const core::MutexLock lock(store_.mutex_);
  store_.hashing_.erase(path_);
  store_.large_hashing_ -= large_ ? 1 : 0;
  store_.hashed_.notify_all();
}

bool ContentStore::Hashing::begin() {
  if (large_ && store_.large_hashing_ >= kMostLarge) return false;
  if (!store_.hashing_.insert(path_).second) return false;
  store_.large_hashing_ += large_ ? 1 : 0;
  return true;
}

Result<Bytes> ContentStore::read(const std::string& name, bool* busy) {
  if (!is_content_name(name)) return not_a_name(name);
  const std::string path = path_of(name);
  const auto identity = identify(path);
  if (!identity) return identity.error().in("asset " + name);
  auto bytes = core::map_file(path);
  if (!bytes) return bytes.error().in("asset " + name);
  touch(name);
  const auto is_known = [&] {
    const core::MutexLock lock(mutex_);
    const auto known = verified_.find(name);
    return known != verified_.end() && known->second == *identity &&
           bytes->size() == identity->size;
  };
  if (is_known()) return bytes;
  const Hashing turn(*this, path, bytes->size(), busy);
  if (!turn.begun()) return Error{"asset " + name + ": it is still being checked"};
  if (is_known()) return bytes;
  if (core::to_hex(core::sha256(bytes->span())) != name) {
    // Another process may have put a good one there meanwhile.
    const auto now = identify(path);
    const bool removed = now && *now == *identity && ::unlink(path.c_str()) == 0;
    const core::MutexLock lock(mutex_);
    verified_.erase(name);
    damaged_.insert(name);
    return Error{"asset " + name + ": the stored file " +
                 (removed ? "was damaged and has been removed" : "is damaged")};
  }
  remember(name, *identity);
  return bytes;
}

std::set<std::string> ContentStore::take_damaged() {
  const core::MutexLock lock(mutex_);
  return std::exchange(damaged_, {});
}

void ContentStore::check_again(const std::string& name) {
  forget(name);
  (void)read(name);
}

void ContentStore::touch(const std::string& name) const {
  if (!is_content_name(name)) return;
  // The time of reading decides who is evicted; that of writing tells whether the file is the same.
  const struct timespec times[2] = {{0, UTIME_NOW}, {0, UTIME_OMIT}};
  ::utimensat(AT_FDCWD, path_of(name).c_str(), times, AT_SYMLINK_NOFOLLOW);
}

Result<ContentPin> ContentStore::pin(const std::string& name) {
  if (!is_content_name(name)) return not_a_name(name);
  const std::string path = path_of(name);
  touch(name);
  while (true) {
    core::Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW));
    struct stat info {};
    if (!file.valid()) {
      const std::string why = errno == ENOENT ? "it is not here" : core::io_reason(errno);
      return Error{"asset " + name + ": " + why};
    }
    if (!core::lock_file(file.get(), LOCK_SH, options_.lock_patience) ||
        ::fstat(file.get(), &info) != 0) {
      return Error{"asset " + name + ": cannot be locked: " + core::lock_reason(errno)};
    }
    // Evicted or replaced between opening and locking: look again.
    if (info.st_nlink > 0) return ContentPin(std::move(file));
  }
}

Result<ContentWriter> ContentStore::write(const std::string& name, uint64_t size,
                                          const Uploader& whose, bool* crowded) {
  if (!is_content_name(name)) return not_a_name(name);
  sweep_partials();
  const std::string begun = partial_path(name, whose.owner);
  if (auto fits = make_room(begun, size, crowded); !fits) return fits.error();
  ContentWriter writer(*this, name, size);
  expect(writer, whose.owner);
  {
    // One after the other, so that of two that begin at once the second counts the first.
    const core::MutexLock lock(partials_mutex_);
    if (auto may = admit(whose, begun); !may) return may.error();
    if (auto taken = writer.take_partial(begun); !taken) return taken.error();
    writing_[writer.path_] = size;
    writer.counted_ = true;
  }
  take_kept(writer);
  if (auto read = writer.read_partial(whose.busy); !read) return read.error();
  return writer;
}

void ContentStore::expect(ContentWriter& writer, const std::string& owner) {
  const core::MutexLock lock(owners_mutex_);
  std::erase_if(expected_of_, [](const auto& one) { return one.second.use_count() == 1; });
  auto& his = expected_of_[owner];
  if (!his) his = std::make_shared<std::atomic<uint64_t>>(0);
  *his += writer.size_;
  expected_ += writer.size_;
  writer.expected_ = his;
}

std::map<std::string, uint64_t> ContentStore::expected_of_owners() const {
  std::map<std::string, uint64_t> all;
  const core::MutexLock lock(owners_mutex_);
  for (const auto& [owner, bytes] : expected_of_) {
    if (*bytes > 0) all[owner] = *bytes;
  }
  return all;
}

void ContentStore::take_kept(ContentWriter& writer) {
  const auto now = identify(writer.path_);
  const core::MutexLock lock(partials_mutex_);
  const auto kept = kept_.extract(writer.path_);
  if (!kept || !now || *now != kept.mapped().identity || now->size > writer.size_) return;
  writer.hash_ = std::move(kept.mapped().hash);
  writer.go_on(now->size);
}

void ContentStore::keep(ContentWriter& writer) {
  const auto now = identify(writer.path_);
  if (!now || now->size != writer.offset_ || now->size < kKept) return;
  const core::MutexLock lock(partials_mutex_);
  if (kept_.size() >= kMostKept) {
    // The shortest is the quickest to be read again.
    kept_.erase(std::min_element(kept_.begin(), kept_.end(), [](const auto& a, const auto& b) {
      return a.second.identity.size < b.second.identity.size;
    }));
  }
  kept_.insert_or_assign(writer.path_, Kept{*now, std::move(writer.hash_)});
}

Status ContentStore::commit(ContentWriter& writer) {
  const std::string path = path_of(writer.name_);
  core::failpoint("asset-written");
  if (::fsync(writer.file_.get()) != 0 || ::rename(writer.path_.c_str(), path.c_str()) != 0) {
    const Error error{"cannot write " + path + ": " + core::io_reason(errno)};
    // What a failed sync has kept cannot be known.
    ::unlink(writer.path_.c_str());
    writer.file_.close();
    return error;
  }
  if (auto synced = sync_folder(options_.folder); !synced) return synced;
  writer.file_.close();
  ++commits_;
  drop_partials(writer.name_);
  if (const auto identity = identify(path)) remember(writer.name_, *identity);
  // Other processes may have written too: never above the budget for long. That all others are in
  // use is no reason to refuse a file that is here.
  (void)make_room({}, 0);
  return {};
}

uint64_t ContentStore::begun(const std::string& name, const std::string& owner) const {
  if (!is_content_name(name)) return 0;
  const auto identity = identify(partial_path(name, owner));
  return identity ? identity->size : 0;
}

Status ContentStore::remove(const std::string& name) {
  if (!is_content_name(name)) return not_a_name(name);
  forget(name);
  if (::unlink(path_of(name).c_str()) == 0 || errno == ENOENT) return {};
  return Error{"cannot remove " + path_of(name) + ": " + core::io_reason(errno)};
}

}  // namespace hyades::farm
