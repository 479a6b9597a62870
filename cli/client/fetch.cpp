#include "cli/client/fetch.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "core/base/descriptor.h"
#include "core/base/hash.h"
#include "core/base/io_reason.h"
#include "farm/wire.h"

namespace hyades::cli {

namespace fs = std::filesystem;
using core::Descriptor;

namespace {

constexpr size_t kPiece = size_t{1} << 20;

Failure write_failure(const std::string& path) {
  return {kFailed, "cannot write " + path + ": " + core::io_reason(errno)};
}

/// The SHA-256 of what is in `fd`, and how much that is.
std::optional<uint64_t> hash_file(int fd, core::Sha256Stream& hash) {
  std::vector<std::byte> piece(kPiece);
  uint64_t size = 0;
  while (true) {
    const ssize_t got = ::pread(fd, piece.data(), piece.size(), static_cast<off_t>(size));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return std::nullopt;
    if (got == 0) return size;
    hash.add(std::span(piece).first(static_cast<size_t>(got)));
    size += static_cast<uint64_t>(got);
  }
}

bool is_complete(const std::string& path, uint64_t size, const std::string& sha256) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  struct stat info {};
  if (!file.valid() || ::fstat(file.get(), &info) != 0 || !S_ISREG(info.st_mode) ||
      static_cast<uint64_t>(info.st_size) != size) {
    return false;
  }
  core::Sha256Stream hash;
  return hash_file(file.get(), hash) == size && core::to_hex(hash.digest()) == sha256;
}

/// The unfinished file: its name holds its digest, so that parts of two renderings never mix.
class Part {
 public:
  Part(const fs::path& target, std::string sha256)
      : target_(target.string()),
        sha256_(std::move(sha256)),
        path_((target.parent_path() / fmt::format(".{}.{}.part",
                                                  target.filename().string().substr(0, 200),
                                                  sha256_.substr(0, 16)))
                  .string()) {}

  /// Opens it; what an earlier run left beyond `size` is none of it.
  Outcome open(uint64_t size) {
    file_ = Descriptor(::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666));
    if (!file_.valid()) return write_failure(path_);
    const auto there = hash_file(file_.get(), hash_);
    if (!there || *there > size) return restart();
    offset_ = *there;
    return std::nullopt;
  }

  Outcome restart() {
    hash_ = core::Sha256Stream();
    offset_ = 0;
    if (::ftruncate(file_.get(), 0) != 0) return write_failure(path_);
    return std::nullopt;
  }

  Outcome append(const std::string& bytes) {
    size_t done = 0;
    while (done < bytes.size()) {
      const ssize_t written = ::pwrite(file_.get(), bytes.data() + done, bytes.size() - done,
                                       static_cast<off_t>(offset_));
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) return write_failure(path_);
      done += static_cast<size_t>(written);
      offset_ += static_cast<uint64_t>(written);
    }
    hash_.add(std::as_bytes(std::span(bytes)));
    return std::nullopt;
  }

  uint64_t offset() const { return offset_; }
  bool is_right() const { return core::to_hex(hash_.digest()) == sha256_; }

  Outcome give_name() {
    if (::fsync(file_.get()) != 0 || ::rename(path_.c_str(), target_.c_str()) != 0) {
      return write_failure(target_);
    }
    return std::nullopt;
  }

 private:
  std::string target_;
  std::string sha256_;
  std::string path_;
  Descriptor file_;
  core::Sha256Stream hash_;
  uint64_t offset_ = 0;
};

}  // namespace

bool is_safe_output(const std::string& path) {
  if (path.empty() || path.front() == '/' || path.find('\0') != std::string::npos) return false;
  const fs::path normal = fs::path(path).lexically_normal();
  return normal.string() == path && normal.has_filename() && *normal.begin() != ".." &&
         *normal.begin() != ".";
}

Outcome fetch_file(FarmClient& client, uint64_t id, const v1::OutputFile& file,
                   const std::string& folder, const std::function<void(uint64_t)>& on_progress,
                   Fetched& totals) {
  const auto digest = farm::digest_from_wire(file.sha256());
  if (!digest || !is_safe_output(file.path())) {
    return Failure{kFailed, "the coordinator names an output that is no file of a job: '" +
                                file.path().substr(0, 200) + "'"};
  }
  const std::string sha256 = core::to_hex(*digest);
  const fs::path target = fs::path(folder) / file.path();
  if (is_complete(target.string(), file.size(), sha256)) {
    ++totals.files;
    ++totals.present;
    return std::nullopt;
  }
  std::error_code failed;
  fs::create_directories(target.parent_path(), failed);
  if (failed) {
    return Failure{kFailed,
                   "cannot make " + target.parent_path().string() + ": " + failed.message()};
  }
  Part part(target, sha256);
  if (auto failure = part.open(file.size())) return failure;
  v1::FetchRequest request;
  request.set_job(id);
  request.set_path(file.path());
  request.set_sha256(file.sha256());
  // The second round is for a part that an earlier run left damaged.
  for (int round = 0; round < 2; ++round) {
    if (part.offset() < file.size()) {
      request.set_offset(part.offset());
      const auto failure = client.fetch(request, file.size(), [&](const std::string& bytes) {
        on_progress(bytes.size());
        totals.bytes += bytes.size();
        return part.append(bytes);
      });
      if (failure) return failure;
    }
    if (part.offset() == file.size() && part.is_right()) {
      if (auto failure = part.give_name()) return failure;
      ++totals.files;
      return std::nullopt;
    }
    if (auto failure = part.restart()) return failure;
  }
  return Failure{kFailed,
                 file.path() + ": what the coordinator sends has not the SHA-256 that it promised"};
}

}  // namespace hyades::cli
