#include "coordinator/state/reserve_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <filesystem>

#include "core/base/descriptor.h"

namespace hyades::coordinator {

void ReserveFile::keep() {
  const std::lock_guard lock(mutex_);
  if (kept_) return;
  std::error_code failed;
  const auto folder = std::filesystem::path(path_).parent_path();
  const bool there = std::filesystem::file_size(path_, failed) == bytes_ && !failed;
  const auto space = std::filesystem::space(folder, failed);
  if (!there && (failed || space.available < kAmple * bytes_)) return;
  const core::Descriptor file(::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600));
  kept_ = file.valid() && ::posix_fallocate(file.get(), 0, static_cast<off_t>(bytes_)) == 0;
  // Half a reserve takes room that others need.
  if (file.valid() && !kept_) ::unlink(path_.c_str());
}

bool ReserveFile::release() {
  const std::lock_guard lock(mutex_);
  kept_ = false;
  return ::unlink(path_.c_str()) == 0;
}

}  // namespace hyades::coordinator
