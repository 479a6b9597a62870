#include "cli/client/fetch.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/base/descriptor.h"
#include "core/base/folder_links.h"
#include "core/base/hash.h"
#include "core/base/io_reason.h"
#include "core/base/posix_file.h"
#include "core/base/printable.h"
#include "core/base/text.h"
#include "core/job/output_names.h"
#include "core/job/output_path.h"
#include "farm/wire.h"

namespace hyades::cli {

namespace fs = std::filesystem;

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
    const auto got = core::read_all_at(fd, piece, size);
    if (!got) return std::nullopt;
    if (*got == 0) return size;
    hash.add(std::span(piece).first(*got));
    size += *got;
  }
}

bool is_complete(const std::string& path, uint64_t size, const std::string& sha256) {
  std::error_code none;
  return fs::file_size(path, none) == size && !none && sha256_of_file(path) == sha256;
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
    file_ = core::open_file(path_, O_RDWR | O_CREAT | O_NOFOLLOW);
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
    const auto piece = std::as_bytes(std::span(bytes));
    if (!core::write_all_at(file_.get(), piece, offset_)) return write_failure(path_);
    offset_ += piece.size();
    hash_.add(piece);
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
  core::Descriptor file_;
  core::Sha256Stream hash_;
  uint64_t offset_ = 0;
};

}  // namespace

bool is_safe_output(const std::string& path) {
  if (core::output_name(path) == core::OutputName::outside || core::printable(path) != path) {
    return false;
  }
  // Some systems take a backslash for what a slash is here.
  std::string slashed = path;
  std::replace(slashed.begin(), slashed.end(), '\\', '/');
  if (core::output_name(slashed) == core::OutputName::outside) return false;
  const fs::path normal = fs::path(path).lexically_normal();
  return normal.string() == path && normal.has_filename() && normal != ".";
}

Outcome FetchTarget::check_name(const std::string& path) const {
  if (!is_safe_output(path)) {
    return Failure{kFailed, "the coordinator names an output that is no file of a job: '" +
                                path.substr(0, 200) + "'"};
  }
  const core::OutputName name = core::output_name(path);
  if (name == core::OutputName::reserved) {
    return Failure{kFailed, path + ": what hyades keeps for itself no job writes"};
  }
  if (!hidden && name == core::OutputName::special) {
    return Failure{kFailed, path +
                                ": hidden files, and names that begin with '-', are not written "
                                "(--hidden writes them)"};
  }
  // What builds, scripts and shells take for theirs (a Makefile, say) is no picture either.
  const auto endings = core::output_endings();
  if (std::find(endings.begin(), endings.end(), core::file_extension(path)) == endings.end()) {
    return Failure{kFailed, path + ": no job has such an output; expected the ending " +
                                core::join_names(endings)};
  }
  // The folder may have come with somebody's scene. A link that has the file's own name is
  // replaced, not followed.
  const fs::path parent = (fs::path(folder) / path).parent_path();
  if (auto stays = core::stays_in_folder(folder, (parent / ".part").string()); !stays) {
    return Failure{kFailed, stays.error().message};
  }
  return std::nullopt;
}

bool FetchTarget::may_write(const std::string& path) const {
  const fs::path there = fs::path(folder) / path;
  std::error_code none;
  const fs::file_status status = fs::symlink_status(there, none);
  if (overwrite || !fs::exists(status)) return true;
  return fs::is_regular_file(status) && record.has(job, path, sha256_of_file(there.string()));
}

Failure not_replaced(const std::vector<std::string>& paths, const std::string& folder) {
  constexpr size_t kMostNamed = 10;
  const size_t named = std::min(paths.size(), kMostNamed);
  const bool one = paths.size() == 1;
  return {kFailed,
          fmt::format(
              "{} there in {}, not written by a fetch of this job or changed since, and {}: {}{} "
              "(--overwrite replaces {}, --output takes another folder)",
              core::counted(paths.size(), "file") + (one ? " is" : " are"), folder,
              one ? "stays" : "stay",
              fmt::join(paths.begin(), paths.begin() + static_cast<ptrdiff_t>(named), ", "),
              named < paths.size() ? ", ..." : "", one ? "it" : "them")};
}

std::string sha256_of_file(const std::string& path) {
  const core::Descriptor file = core::open_file(path, O_RDONLY | O_NONBLOCK);
  struct stat info {};
  core::Sha256Stream hash;
  if (!file.valid() || ::fstat(file.get(), &info) != 0 || !S_ISREG(info.st_mode) ||
      !hash_file(file.get(), hash)) {
    return {};
  }
  return core::to_hex(hash.digest());
}

Outcome fetch_file(FarmClient& client, uint64_t id, const v1::OutputFile& file, FetchTarget& into,
                   const std::function<void(uint64_t)>& on_progress, Fetched& totals) {
  const auto digest = farm::digest_from_wire(file.sha256());
  if (!digest) return Failure{kFailed, file.path() + ": the coordinator names no SHA-256"};
  // First: that a file is there already would tell the coordinator what is in it.
  if (auto refused = into.check_name(file.path())) return refused;
  const std::string sha256 = core::to_hex(*digest);
  const fs::path target = fs::path(into.folder) / file.path();
  if (is_complete(target.string(), file.size(), sha256)) {
    ++totals.files;
    ++totals.present;
    return std::nullopt;
  }
  if (!into.may_write(file.path())) {
    totals.refused.push_back(file.path());
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
      if (auto failure = into.note(file.path(), sha256)) return failure;
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
