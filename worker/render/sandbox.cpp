#include "worker/render/sandbox.h"

#include <linux/close_range.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <climits>
#include <cstring>
#include <vector>

#include "core/sandbox/call_filter.h"
#include "core/sandbox/landlock.h"
#include "core/sandbox/private_root.h"

namespace hyades::worker {

core::Result<SandboxMode> read_sandbox_mode(const std::string& word) {
  if (word == "auto") return SandboxMode::automatic;
  if (word == "require") return SandboxMode::required;
  if (word == "off") return SandboxMode::off;
  return core::Error{"'" + word + "': expected auto, require or off"};
}

core::Result<std::string> enter_sandbox(SandboxMode mode, const std::string& cache,
                                        unsigned first_closed) {
  if (mode == SandboxMode::off) return std::string("switched off");
  std::string lacking;
  const auto try_to = [&](const core::Status& status) {
    if (!status) lacking += (lacking.empty() ? "" : "; ") + status.error().message;
  };
  if (::syscall(SYS_close_range, first_closed, UINT_MAX, 0) != 0) {
    try_to(core::Error{std::string("close_range: ") + std::strerror(errno)});
  }
  // The cache not to remove from either: there are other jobs' files.
  std::vector<core::FileRule> rules = core::system_files();
  rules.push_back({cache, core::FileAccess::read, true});
  // Where there are no namespaces names and sizes of other files can be asked for, no more.
  (void)core::hide_other_files(rules);
  try_to(core::restrict_files(rules));
  try_to(core::allow_calls(core::AllowedCalls::render));
  if (!lacking.empty() && mode == SandboxMode::required) {
    return core::Error{"this machine has no whole sandbox (" + lacking +
                       "); with 'auto' instead of 'require' as the worker's --sandbox it renders "
                       "with what there is of one"};
  }
  return lacking;
}

}  // namespace hyades::worker
