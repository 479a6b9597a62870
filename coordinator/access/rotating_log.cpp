#include "coordinator/access/rotating_log.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <span>
#include <utility>

#include "core/base/io_reason.h"
#include "core/base/posix_file.h"
#include "farm/log.h"

namespace hyades::coordinator {
namespace {

/// Whether what was written is on the disk; what is no file (a pipe) has none.
bool sync(int file) { return ::fdatasync(file) == 0 || errno == EINVAL; }

}  // namespace

std::string RotatingLog::path(int number) const {
  return options_.folder + "/" + options_.name + "." +
         (number == 0 ? "" : std::to_string(number) + ".") + "jsonl";
}

core::Status RotatingLog::open() {
  constexpr mode_t kOwnerOnly = 0600;
  file_ = core::open_file(path(0), O_RDWR | O_APPEND | O_CREAT, kOwnerOnly);
  struct stat facts {};
  if (!file_.valid() || ::fstat(file_.get(), &facts) != 0) {
    return core::Error{path(0) + ": cannot be opened: " + core::io_reason(errno)};
  }
  size_ = static_cast<uint64_t>(facts.st_size);
  // A crash may have cut the last line.
  constexpr auto kEnd = static_cast<std::byte>('\n');
  std::byte last = kEnd;
  if (size_ > 0 && core::read_all_at(file_.get(), {&last, 1}, size_ - 1) && last != kEnd) {
    if (core::write_all(file_.get(), {&kEnd, 1})) ++size_;
  }
  return {};
}

bool RotatingLog::write(const std::string& lines) {
  // A file that could not be opened is not full: each turn of the names loses the oldest.
  if (file_.valid() && size_ > 0 && size_ + lines.size() > options_.most_bytes) rotate();
  if (!file_.valid() && !open()) return false;
  if (!core::write_all(file_.get(), std::as_bytes(std::span(lines))) || !sync(file_.get())) {
    // Should that fail, too, open() sees what is there.
    (void)::ftruncate(file_.get(), static_cast<off_t>(size_));
    file_.close();
    return false;
  }
  size_ += lines.size();
  return true;
}

void RotatingLog::rotate() {
  {
    const core::MutexLock lock(naming_);
    (void)::unlink(path(options_.most_files - 1).c_str());
    for (int number = options_.most_files - 2; number >= 0; --number) {
      (void)std::rename(path(number).c_str(), path(number + 1).c_str());
    }
  }
  file_.close();
  if (auto opened = open(); !opened) {
    farm::log(farm::LogLevel::error, opened.error().message);
  }
}

std::vector<core::Descriptor> RotatingLog::for_reading() const {
  std::vector<core::Descriptor> files;
  const core::MutexLock lock(naming_);
  for (int number = 0; number < options_.most_files; ++number) {
    core::Descriptor file = core::open_file(path(number), O_RDONLY);
    if (file.valid()) files.push_back(std::move(file));
  }
  return files;
}

std::string RotatingLog::last_line() const {
  constexpr uint64_t kLongest = uint64_t{64} << 10U;
  for (const core::Descriptor& file : for_reading()) {
    struct stat facts {};
    if (::fstat(file.get(), &facts) != 0) continue;
    const auto size = static_cast<uint64_t>(facts.st_size);
    std::string end(std::min(size, kLongest), '\0');
    const auto bytes = std::as_writable_bytes(std::span(end));
    if (core::read_all_at(file.get(), bytes, size - end.size()) != end.size()) continue;
    while (end.ends_with('\n')) end.pop_back();
    if (!end.empty()) return end.substr(end.rfind('\n') + 1);
  }
  return {};
}

}  // namespace hyades::coordinator
