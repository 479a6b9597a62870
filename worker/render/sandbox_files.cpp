#include "worker/render/sandbox_files.h"

#include <vector>

#include "core/base/landlock.h"

namespace hyades::worker {

core::Status restrict_files(const std::string& cache) {
  std::vector<core::FileRule> rules = core::system_files();
  // Not to remove either: there are other jobs' files, and the worker's id.
  rules.push_back({cache, core::FileAccess::read, true});
  return core::restrict_files(rules);
}

}  // namespace hyades::worker
