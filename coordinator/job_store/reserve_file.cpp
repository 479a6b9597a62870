#include "coordinator/job_store/reserve_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <filesystem>
#include <system_error>

#include "core/base/descriptor.h"
#include "core/base/posix_file.h"

namespace hyades::coordinator {

void ReserveFile::keep() {
  const core::MutexLock lock(mutex_);
  if (kept_) return;
  std::error_code failed;
  const auto folder = std::filesystem::path(path_).parent_path();
  const bool there = std::filesystem::file_size(path_, failed) == bytes_ && !failed;
  const auto space = std::filesystem::space(folder, failed);
  if (!there && (failed || space.available < kAmple * bytes_)) return;
  const core::Descriptor file = core::open_file(path_, O_RDWR | O_CREAT, 0600);
  kept_ = file.valid() && ::posix_fallocate(file.get(), 0, static_cast<off_t>(bytes_)) == 0;
  // Half a reserve takes room that others need.
  if (file.valid() && !kept_) ::unlink(path_.c_str());
}

bool ReserveFile::release() {
  const core::MutexLock lock(mutex_);
  kept_ = false;
  return ::unlink(path_.c_str()) == 0;
}

}  // namespace hyades::coordinator
