#include "coordinator/finisher/confine.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>
#include <vector>

#include "core/base/landlock.h"
#include "core/base/machine.h"
#include "core/base/process_limits.h"

namespace hyades::coordinator {
namespace {

/// Libraries that are opened only when they are wanted may lie elsewhere than the system's.
void add_libraries(std::vector<core::FileRule>& rules) {
  const char* const paths = std::getenv("LD_LIBRARY_PATH");
  std::istringstream folders(paths != nullptr ? paths : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (!folder.empty()) rules.push_back({folder});
  }
  if (const char* const denoiser = std::getenv("HYADES_OIDN"); denoiser != nullptr) {
    std::error_code none;
    rules.push_back({std::filesystem::weakly_canonical(denoiser, none).parent_path().string()});
  }
  std::error_code none;
  for (std::filesystem::directory_iterator it("/etc/ld.so.conf.d", none), end; !none && it != end;
       it.increment(none)) {
    std::ifstream lines(it->path());
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with('/')) rules.push_back({line});
    }
  }
}

}  // namespace

core::Status confine_finisher(const std::string& scratch, const std::string& outputs) {
  // Without it the kernel chooses by size, as ever.
  (void)core::go_first();
  if (auto limited = core::limit_memory(core::usable_memory() / 4 * 3); !limited) return limited;
  std::error_code failed;
  std::filesystem::create_directories(outputs, failed);
  if (failed) return core::Error{outputs + ": cannot be made: " + failed.message()};
  std::vector<core::FileRule> rules = core::system_files();
  add_libraries(rules);
  rules.push_back({scratch, core::FileAccess::write, true});
  rules.push_back({outputs, core::FileAccess::write, true});
  return core::restrict_files(rules);
}

}  // namespace hyades::coordinator
