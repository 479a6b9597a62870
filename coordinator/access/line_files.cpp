#include "coordinator/access/line_files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <utility>

#include "core/base/io_reason.h"
#include "farm/log.h"

namespace hyades::coordinator {

std::string LineFiles::path(int number) const {
  return options_.folder + "/" + options_.name + "." +
         (number == 0 ? "" : std::to_string(number) + ".") + "jsonl";
}

core::Status LineFiles::open() {
  constexpr mode_t kOwnerOnly = 0600;
  file_ = core::Descriptor(
      ::open(path(0).c_str(), O_RDWR | O_APPEND | O_CREAT | O_CLOEXEC, kOwnerOnly));
  struct stat facts {};
  if (!file_.valid() || ::fstat(file_.get(), &facts) != 0) {
    return core::Error{path(0) + ": cannot be opened: " + core::io_reason(errno)};
  }
  size_ = static_cast<uint64_t>(facts.st_size);
  // A crash may have cut the last line.
  char last = '\n';
  if (size_ > 0 && ::pread(file_.get(), &last, 1, facts.st_size - 1) == 1 && last != '\n') {
    if (::write(file_.get(), "\n", 1) == 1) ++size_;
  }
  return {};
}

bool LineFiles::write(const std::string& lines) {
  // A file that could not be opened is not full: each turn of the names loses the oldest.
  if (file_.valid() && size_ > 0 && size_ + lines.size() > options_.most_bytes) rotate();
  if (!file_.valid() && !open()) return false;
  size_t written = 0;
  while (written < lines.size()) {
    const ssize_t got = ::write(file_.get(), lines.data() + written, lines.size() - written);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) {
      (void)::ftruncate(file_.get(), static_cast<off_t>(size_));
      return false;
    }
    written += static_cast<size_t>(got);
  }
  size_ += lines.size();
  (void)::fdatasync(file_.get());
  return true;
}

void LineFiles::rotate() {
  {
    const std::lock_guard lock(naming_);
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

std::vector<core::Descriptor> LineFiles::for_reading() const {
  std::vector<core::Descriptor> files;
  const std::lock_guard lock(naming_);
  for (int number = 0; number < options_.most_files; ++number) {
    core::Descriptor file(::open(path(number).c_str(), O_RDONLY | O_CLOEXEC));
    if (file.valid()) files.push_back(std::move(file));
  }
  return files;
}

}  // namespace hyades::coordinator
