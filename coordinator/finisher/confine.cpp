#include "coordinator/finisher/confine.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>
#include <utility>
#include <vector>

#include "core/base/machine.h"
#include "core/base/process_limits.h"
#include "core/sandbox/call_filter.h"
#include "core/sandbox/landlock.h"
#include "core/sandbox/private_root.h"

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

/// Holds this process in: it reaches the system's files and those of `rules`.
core::Status confine(const std::vector<core::FileRule>& own, core::AllowedCalls calls) {
  // Without it the kernel chooses by size, as ever.
  (void)core::go_first();
  if (auto limited = core::limit_memory(core::usable_memory() / 4 * 3); !limited) return limited;
  std::vector<core::FileRule> rules = core::system_files();
  add_libraries(rules);
  rules.insert(rules.end(), own.begin(), own.end());
  // Where there are no namespaces names and sizes of other files can be asked for, no more.
  (void)core::hide_other_files(rules);
  // A machine without Landlock finishes all the same; the coordinator has said so at its start.
  const core::Status files = core::restrict_files(rules);
  if (!files && core::landlock_lacks().empty()) return files;
  return core::allow_calls(calls);
}

}  // namespace

core::Status confine_finisher(const std::string& scratch, const std::string& outputs) {
  std::error_code failed;
  std::filesystem::create_directories(outputs, failed);
  if (failed) return core::Error{outputs + ": cannot be made: " + failed.message()};
  return confine(
      {{scratch, core::FileAccess::write, true}, {outputs, core::FileAccess::write, true}},
      core::AllowedCalls::finish);
}

core::Status confine_encoder(const std::string& program, const std::string& outputs) {
  // It may be a script, or have its libraries beside it.
  std::vector<core::FileRule> rules = {
      {std::filesystem::path(program).parent_path().string(), core::FileAccess::run, true},
      {outputs, core::FileAccess::write, true}};
  for (const char* system : {"/bin", "/usr", "/lib", "/lib64"}) {
    rules.push_back({system, core::FileAccess::run});
  }
  return confine(rules, core::AllowedCalls::encode);
}

}  // namespace hyades::coordinator
