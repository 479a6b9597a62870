#include "coordinator/film_store/remove_folder.h"

#include <dirent.h>
#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <filesystem>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

namespace hyades::coordinator {
namespace {

constexpr int kFolder = O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC;
/// Deeper folders, which no job makes, go at once: each level takes stack and a descriptor.
constexpr int kDeepest = 100;

/// Empties an open folder, of which nothing but its number is trusted; see remove_some().
bool empty_folder(int folder, uint64_t& most, int depth) {
  DIR* open = ::fdopendir(folder);
  if (open == nullptr) {
    ::close(folder);
    return true;
  }
  bool through = true;
  while (const dirent* entry = ::readdir(open)) {  // NOLINT(concurrency-mt-unsafe): own stream
    const char* name = entry->d_name;
    if (std::string_view(name) == "." || std::string_view(name) == "..") continue;
    through = most > 0;
    if (!through) break;
    if (::unlinkat(folder, name, 0) == 0) {
      --most;
      continue;
    }
    if (errno != EISDIR) continue;  // it stays, and is not counted: what counts comes again
    if (depth == kDeepest) {
      std::error_code ignored;
      std::filesystem::remove_all(fmt::format("/proc/self/fd/{}/{}", folder, name), ignored);
      continue;
    }
    const int below = ::openat(folder, name, kFolder);
    through = below < 0 || empty_folder(below, most, depth + 1);
    if (!through) break;
    (void)::unlinkat(folder, name, AT_REMOVEDIR);
  }
  ::closedir(open);
  return through;
}

}  // namespace

bool remove_some(const std::string& folder, uint64_t most) {
  const int open = ::open(folder.c_str(), kFolder);
  if (open < 0) return true;
  if (!empty_folder(open, most, 0)) return false;
  (void)::rmdir(folder.c_str());
  return true;
}

std::vector<uint64_t> numbered_folders(const std::string& folder) {
  namespace fs = std::filesystem;
  std::vector<uint64_t> ids;
  std::error_code failed;
  for (fs::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed)) {
    const std::string name = at->path().filename().string();
    uint64_t id = 0;
    const auto read = std::from_chars(name.data(), name.data() + name.size(), id);
    if (read.ec == std::errc() && read.ptr == name.data() + name.size()) ids.push_back(id);
  }
  return ids;
}

}  // namespace hyades::coordinator
