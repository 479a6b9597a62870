#include "cli/client/scale_call.h"

#include <fmt/format.h>

#include "core/base/child_process.h"

namespace hyades::cli {

core::Status call_scaler(const std::string& command, uint32_t wanted, double limit,
                         const std::function<bool()>& stop) {
  // Of coreutils: it ends not the shell alone but the group of processes that it leads.
  const auto program = core::find_program("timeout");
  if (!program) return core::Error{"there is no program 'timeout' in PATH"};
  const std::string script =
      fmt::format("HYADES_WANTED={}; export HYADES_WANTED; {} \"$@\"", wanted, command);
  auto child = core::ChildProcess::start(
      *program, {"--kill-after=5", fmt::format("{:.3f}", limit), "/bin/sh", "-c", script,
                 "hyades-autoscale", std::to_string(wanted)});
  if (!child) return child.error();
  const core::Status done = child->finish([&]() -> core::Status {
    if (stop()) return core::Error{"interrupted"};
    return {};
  });
  if (done) return {};
  // What `timeout` exits with when it has ended the command.
  if (done.error().message.starts_with("timeout failed (124)")) {
    return core::Error{fmt::format("it took longer than {:g} s and was ended", limit)};
  }
  return done.error().message.starts_with("timeout failed ")
             ? core::Error{"exit status " + done.error().message.substr(15)}
             : done;
}

}  // namespace hyades::cli
