#include "core/base/process_limits.h"

#include <sys/resource.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <ostream>
#include <string>

namespace hyades::core {
namespace {

constexpr const char* kScore = "/proc/self/oom_score_adj";
/// Of 1000, with which a process goes whatever its size.
constexpr int kGoesFirst = 800;
/// More than any thread's; a stack without a limit would be memory without one.
constexpr rlim_t kMostStack = rlim_t{64} << 20U;

/// To `most`, for good, where it is not lower already.
bool lower(int resource, rlim_t most) {
  rlimit limit{};
  if (::getrlimit(resource, &limit) != 0) return false;
  most = std::min(most, limit.rlim_cur);
  limit = {most, most};
  return ::setrlimit(resource, &limit) == 0;
}

}  // namespace

Status go_first() {
  int score = 0;
  // Who started this may have said more, and less needs privileges.
  if (std::ifstream(kScore) >> score && score >= kGoesFirst) return {};
  errno = 0;
  std::ofstream file(kScore);
  file << kGoesFirst << std::flush;
  if (file) return {};
  return Error{std::string(kScore) + ": " + std::strerror(errno)};
}

Status limit_memory(uint64_t bytes) {
  if (bytes == 0) return {};
  if (lower(RLIMIT_DATA, bytes) && lower(RLIMIT_STACK, kMostStack)) return {};
  return Error{std::string("memory cannot be limited: ") + std::strerror(errno)};
}

Status limit_file_size(uint64_t bytes) {
  if (lower(RLIMIT_FSIZE, bytes)) return {};
  return Error{std::string("the length of files cannot be limited: ") + std::strerror(errno)};
}

}  // namespace hyades::core
