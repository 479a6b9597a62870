#include "farm/content_writer.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <array>
#include <cerrno>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/base/io_reason.h"
#include "core/base/posix_file.h"
#include "farm/content_store.h"

namespace hyades::farm {

using core::Error;
using core::Status;

namespace {

constexpr size_t kReadPiece = size_t{1} << 20;
constexpr int kOpenFlags = O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW;

Error write_failure(const std::string& path, int error) {
  return {"cannot write " + path + ": " + core::io_reason(error)};
}

/// Whether `fd` is still what `path` names.
bool still_named(int fd, const std::string& path) {
  struct stat open {};
  struct stat named {};
  return ::fstat(fd, &open) == 0 && ::lstat(path.c_str(), &named) == 0 &&
         open.st_ino == named.st_ino && open.st_dev == named.st_dev;
}

}  // namespace

ContentWriter::ContentWriter(ContentWriter&& other) noexcept
    : store_(std::exchange(other.store_, nullptr)),
      name_(std::move(other.name_)),
      size_(other.size_),
      offset_(other.offset_),
      path_(std::move(other.path_)),
      resumable_(other.resumable_),
      counted_(std::exchange(other.counted_, false)),
      file_(std::move(other.file_)),
      hash_(std::move(other.hash_)),
      expected_(std::move(other.expected_)) {}

ContentWriter::~ContentWriter() {
  if (store_ == nullptr) return;
  *expected_ -= size_ - offset_;
  store_->expected_ -= size_ - offset_;
  // Nobody would find a copy with a name of its own again, nor look for what is whole by now.
  const bool useless = file_.valid() && (!resumable_ || !store_->missing(name_));
  const bool named = file_.valid() && still_named(file_.get(), path_);
  if (useless && named) ::unlink(path_.c_str());
  if (!useless && named) store_->keep(*this);
  stop_counting();
}

void ContentWriter::go_on(uint64_t bytes) {
  offset_ += bytes;
  *expected_ -= bytes;
  store_->expected_ -= bytes;
}

void ContentWriter::stop_counting() {
  if (!std::exchange(counted_, false)) return;
  const core::MutexLock lock(store_->partials_mutex_);
  store_->writing_.erase(path_);
}

Status ContentWriter::take_partial(const std::string& begun) {
  for (int attempt = 0; attempt < 100; ++attempt) {
    path_ = begun;
    file_ = core::Descriptor(::open(path_.c_str(), kOpenFlags, 0600));
    if (!file_.valid()) return write_failure(path_, errno);
    if (::flock(file_.get(), LOCK_EX | LOCK_NB) == 0) {
      // Between opening and locking it the last writer may have finished or thrown it away.
      if (!still_named(file_.get(), path_)) continue;
      return {};
    }
    if (errno != EWOULDBLOCK) return write_failure(path_, errno);
    path_ = fmt::format("{}.{}.{}", begun, ::getpid(), attempt);
    file_ = core::Descriptor(::open(path_.c_str(), kOpenFlags | O_EXCL, 0600));
    if (file_.valid()) {
      resumable_ = false;
      if (::flock(file_.get(), LOCK_EX | LOCK_NB) != 0) return write_failure(path_, errno);
      return {};
    }
    if (errno != EEXIST) return write_failure(path_, errno);
  }
  return Error{"cannot write " + begun + ": too many write it at once"};
}

Status ContentWriter::read_partial(bool* busy) {
  struct stat info {};
  if (::fstat(file_.get(), &info) != 0) return write_failure(path_, errno);
  if (static_cast<uint64_t>(info.st_size) > size_) {
    if (::ftruncate(file_.get(), 0) != 0) return write_failure(path_, errno);
    return {};
  }
  const auto unread = static_cast<uint64_t>(info.st_size) - offset_;
  if (unread == 0) return {};
  const ContentStore::Hashing turn(*store_, path_, unread, busy);
  if (!turn.begun()) return Error{path_ + ": what there is of it is still being checked"};
  std::vector<std::byte> piece(kReadPiece);
  while (true) {
    const auto got = core::read_all_at(file_.get(), piece, offset_);
    if (!got) return Error{"cannot read " + path_ + ": " + core::io_reason(errno)};
    if (*got == 0) return {};
    hash_.add(std::span(piece).first(*got));
    go_on(*got);
  }
}

Status ContentWriter::append(std::span<const std::byte> bytes) {
  if (bytes.size() > size_ - offset_) {
    return Error{fmt::format("{}: more than the {} bytes that were announced", name_, size_)};
  }
  if (!core::write_all_at(file_.get(), bytes, offset_)) return write_failure(path_, errno);
  hash_.add(bytes);
  go_on(bytes.size());
  return {};
}

Status ContentWriter::commit() {
  if (offset_ != size_) {
    return Error{fmt::format("{}: {} of {} bytes are there", name_, offset_, size_)};
  }
  stop_counting();  // from here on somebody else may begin with its path
  const std::string digest = core::to_hex(hash_.digest());
  if (digest != name_) {
    ::unlink(path_.c_str());
    file_.close();
    return Error{fmt::format("{}: the bytes that came have the SHA-256 {}", name_, digest)};
  }
  return store_->commit(*this);
}

}  // namespace hyades::farm
