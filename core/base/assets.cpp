#include "core/base/assets.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <filesystem>
#include <set>
#include <system_error>
#include <utility>

#include "core/base/hash.h"
#include "core/base/mutex.h"

namespace hyades::core {
namespace {

std::string what_it_is(mode_t mode) {
  if (S_ISDIR(mode)) return "a folder";
  if (S_ISFIFO(mode)) return "a pipe";
  if (S_ISSOCK(mode)) return "a socket";
  return "a device";
}

class FileResolver : public AssetResolver {
 public:
  explicit FileResolver(std::string folder) : folder_(std::move(folder)) {}

  Result<Bytes> open(const std::string& reference, const std::string& from) override {
    if (reference.empty()) return Error{"empty file name"};
    const std::string resolved = resolve_reference(reference, from);
    const std::string path = (std::filesystem::path(folder_) / resolved).string();
    Result<Bytes> bytes = map_file(path);
    if (!bytes) {
      const bool same = path == reference || path == "./" + reference;
      const std::string where = same ? "" : " (looked for " + path + ")";
      return Error{reference + ": " + bytes.error().message + where};
    }
    return bytes;
  }

  bool exists(const std::string& reference) override {
    std::error_code ignored;
    return !reference.empty() &&
           std::filesystem::exists(std::filesystem::path(folder_) / reference, ignored);
  }

 private:
  std::string folder_;
};

}  // namespace

std::string resolve_reference(const std::string& reference, const std::string& from) {
  const std::filesystem::path parent = std::filesystem::path(from).parent_path();
  return (parent / reference).lexically_normal().string();
}

Result<Bytes> map_file(const std::string& path) {
  if (path.find('\0') != std::string::npos) return Error{"the file name holds a zero byte"};
  // O_NONBLOCK: opening a pipe without a writer must not hang.
  const int fd = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
  if (fd < 0) {
    const int error = errno;
    if (error == ENOENT) return Error{"no such file"};
    if (error == ENXIO) return Error{"cannot be opened: it is a socket or device, not a file"};
    return Error{"cannot be opened: " + std::generic_category().message(error)};
  }
  struct stat info {};
  if (::fstat(fd, &info) != 0) {
    const int error = errno;
    ::close(fd);
    return Error{"cannot be read: " + std::generic_category().message(error)};
  }
  if (!S_ISREG(info.st_mode)) {
    ::close(fd);
    return Error{"is " + what_it_is(info.st_mode) + ", a regular file was expected"};
  }
  const auto size = static_cast<size_t>(info.st_size);
  if (size == 0) {
    ::close(fd);
    return Bytes{};
  }
  void* address = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, fd, 0);
  const int error = errno;
  ::close(fd);
  if (address == MAP_FAILED) {
    return Error{"cannot be mapped: " + std::generic_category().message(error)};
  }
  std::shared_ptr<const void> owner(
      address, [size](const void* mapped) { ::munmap(const_cast<void*>(mapped), size); });
  return Bytes{std::move(owner), {static_cast<const std::byte*>(address), size}};
}

std::unique_ptr<AssetResolver> make_file_resolver(const std::string& folder) {
  return std::make_unique<FileResolver>(folder);
}

Status AssetResolver::may_name(const std::string& /*scene*/, const std::string& /*file*/) {
  return {};
}

struct RecordingResolver::State {
  AssetResolver& inner;
  mutable Mutex mutex;
  std::vector<AssetRecord> records HYADES_GUARDED_BY(mutex);
  std::set<std::string> seen HYADES_GUARDED_BY(mutex);
};

RecordingResolver::RecordingResolver(AssetResolver& inner)
    : state_(new State{.inner = inner, .mutex = {}, .records = {}, .seen = {}}) {}

RecordingResolver::~RecordingResolver() = default;

Result<Bytes> RecordingResolver::open(const std::string& reference, const std::string& from) {
  return record(resolve_reference(reference, from), state_->inner.open(reference, from));
}

Result<Bytes> RecordingResolver::open_document(const std::string& reference,
                                               const std::string& from) {
  return record(resolve_reference(reference, from), state_->inner.open_document(reference, from));
}

Result<Bytes> RecordingResolver::record(const std::string& resolved, Result<Bytes> bytes) {
  if (!bytes) return bytes;
  {
    const MutexLock lock(state_->mutex);
    if (!state_->seen.insert(resolved).second) return bytes;
    // The place is taken now, so that the order is that of first opening; hashing large files
    // happens outside the lock.
    state_->records.push_back({resolved, {}, bytes->size()});
  }
  const std::string digest = to_hex(sha256(bytes->span()));
  const MutexLock lock(state_->mutex);
  for (AssetRecord& record : state_->records) {
    if (record.reference == resolved) record.sha256 = digest;
  }
  return bytes;
}

bool RecordingResolver::exists(const std::string& reference) {
  return state_->inner.exists(reference);
}

Status RecordingResolver::may_name(const std::string& scene, const std::string& file) {
  return state_->inner.may_name(scene, file);
}

std::vector<AssetRecord> RecordingResolver::records() const {
  const MutexLock lock(state_->mutex);
  return state_->records;
}

}  // namespace hyades::core
