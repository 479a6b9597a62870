#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "coordinator/film_store/log_files.h"
#include "core/base/descriptor.h"
#include "core/base/io_reason.h"
#include "core/base/posix_file.h"

namespace hyades::coordinator {
namespace {

namespace fs = std::filesystem;
using core::Error;
using core::Result;
using core::Status;

Error failed(const std::string& doing, const std::string& path, int error) {
  // io_reason() speaks of writing, where it is the folder that is missing.
  const std::string reason =
      error == ENOENT ? std::generic_category().message(error) : core::io_reason(error);
  return {"cannot " + doing + " " + path + ": " + reason};
}

/// None is ever a link: one may have come with somebody's scene, into whose folder is rendered.
core::Descriptor open_file(const std::string& path, int flags) {
  return core::open_file(path, flags | O_NOFOLLOW, 0644);
}

class DiskWriter final : public LogWriter {
 public:
  DiskWriter(std::string path, core::Descriptor file)
      : path_(std::move(path)), handle_(std::move(file)) {}

  Status write(std::span<const std::byte> bytes) override {
    if (!core::write_all(handle_.get(), bytes)) return failed("write", path_, errno);
    return {};
  }

  Status sync() override {
    // Not repeated after EINTR or anything else: the kernel may have dropped the pages by then.
    if (::fdatasync(handle_.get()) != 0) return failed("sync", path_, errno);
    return {};
  }

 private:
  std::string path_;
  core::Descriptor handle_;
};

class DiskReader final : public LogReader {
 public:
  DiskReader(std::string path, core::Descriptor file, uint64_t size)
      : path_(std::move(path)), handle_(std::move(file)), size_(size) {}

  uint64_t size() const override { return size_; }

  Status read(uint64_t offset, std::span<std::byte> into) override {
    const std::optional<size_t> got = core::read_all_at(handle_.get(), into, offset);
    if (!got) return failed("read", path_, errno);
    if (*got < into.size()) return Error{"cannot read " + path_ + ": it ends too early"};
    return {};
  }

 private:
  std::string path_;
  core::Descriptor handle_;
  uint64_t size_;
};

class DiskLock final : public LogLock {
 public:
  explicit DiskLock(core::Descriptor file) : handle_(std::move(file)) {}
  int fd() const { return handle_.get(); }

 private:
  core::Descriptor handle_;  // closing it gives the flock back
};

class DiskFiles final : public LogFiles {
 public:
  Status make_folder(const std::string& folder) override {
    std::vector<fs::path> parents;  // of what is missing: the new names have to last, too
    std::error_code error;
    for (fs::path at = fs::absolute(folder + "/.").lexically_normal().parent_path();
         !fs::exists(at, error) && at.has_relative_path(); at = at.parent_path()) {
      parents.push_back(at.parent_path());
    }
    fs::create_directories(folder, error);
    if (error) return Error{"cannot create folder " + folder + ": " + error.message()};
    for (const fs::path& parent : parents) {
      if (Status s = sync_folder(parent.string()); !s) return s;
    }
    return {};
  }

  Status sync_folder(const std::string& folder) override {
    if (!core::sync_folder(folder)) return failed("sync", folder, errno);
    return {};
  }

  Result<std::vector<std::string>> list(const std::string& folder) override {
    std::vector<std::string> names;
    std::error_code error;
    for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
      names.push_back(at->path().filename().string());
    }
    if (error) return Error{"cannot list folder " + folder + ": " + error.message()};
    return names;
  }

  Result<std::unique_ptr<LogWriter>> create(const std::string& path) override {
    core::Descriptor file = open_file(path, O_WRONLY | O_CREAT | O_EXCL);
    if (!file.valid()) return failed("create", path, errno);
    return std::unique_ptr<LogWriter>(std::make_unique<DiskWriter>(path, std::move(file)));
  }

  Result<std::unique_ptr<LogReader>> open(const std::string& path) override {
    core::Descriptor file = open_file(path, O_RDONLY);
    if (!file.valid()) return failed("open", path, errno);
    struct stat info {};
    if (::fstat(file.get(), &info) != 0) return failed("read", path, errno);
    return std::unique_ptr<LogReader>(
        std::make_unique<DiskReader>(path, std::move(file), static_cast<uint64_t>(info.st_size)));
  }

  Status sync_file(const std::string& path) override {
    const core::Descriptor handle = open_file(path, O_RDONLY);
    if (!handle.valid()) return failed("open", path, errno);
    if (::fsync(handle.get()) != 0) return failed("sync", path, errno);
    return {};
  }

  Status rename(const std::string& from, const std::string& to) override {
    if (::rename(from.c_str(), to.c_str()) != 0) return failed("rename to", to, errno);
    return {};
  }

  Status remove(const std::string& path) override {
    if (::unlink(path.c_str()) != 0) return failed("remove", path, errno);
    return {};
  }

  Status truncate(const std::string& path, uint64_t size) override {
    const core::Descriptor handle = open_file(path, O_WRONLY);
    if (!handle.valid()) return failed("open", path, errno);
    if (::ftruncate(handle.get(), static_cast<off_t>(size)) != 0 || ::fsync(handle.get()) != 0) {
      return failed("shorten", path, errno);
    }
    return {};
  }

  Result<std::unique_ptr<LogLock>> lock(const std::string& path) override {
    auto held = std::make_unique<DiskLock>(open_file(path, O_RDWR | O_CREAT));
    if (held->fd() < 0) return failed("open", path, errno);
    if (::flock(held->fd(), LOCK_EX | LOCK_NB) != 0) {
      if (errno != EWOULDBLOCK) return failed("lock", path, errno);
      char holder[32] = {};
      const ssize_t got = ::pread(held->fd(), holder, sizeof holder - 1, 0);
      std::string text(holder, static_cast<size_t>(std::max<ssize_t>(got, 0)));
      text.erase(std::find(text.begin(), text.end(), '\n'), text.end());
      return Error{path + " is held by another process" +
                   (text.empty() ? std::string() : " (number " + text + ")") +
                   ", which renders or serves from this folder"};
    }
    // Who holds it, for the message above; the lock works without.
    const std::string self = std::to_string(::getpid()) + "\n";
    if (::ftruncate(held->fd(), 0) == 0) {
      [[maybe_unused]] const ssize_t put = ::pwrite(held->fd(), self.data(), self.size(), 0);
    }
    return std::unique_ptr<LogLock>(std::move(held));
  }
};

}  // namespace

LogFiles& disk_log_files() {
  static DiskFiles files;
  return files;
}

}  // namespace hyades::coordinator
