#include "farm/grpc_log.h"

#include <cstdlib>
#include <string_view>

#include <absl/synchronization/mutex.h>
#include <fmt/format.h>
#include <grpc/support/log.h>

#include "farm/log.h"

namespace hyades::farm {
namespace {

/// A failed assertion ends the process: that has to be seen.
void say_last_words(gpr_log_func_args* line) {
  if (std::string_view(line->message).find("ASSERTION FAILED") == std::string_view::npos) return;
  log(LogLevel::error, fmt::format("{}:{}: {}", line->file, line->line, line->message));
}

}  // namespace

void quiet_grpc() {
  // Debian's library looks for cycles in the order of locks, at each of gRPC's: that costs more
  // than the calls themselves where there are many.
  absl::SetMutexDeadlockDetectionMode(absl::OnDeadlockCycle::kIgnore);
  if (std::getenv("GRPC_VERBOSITY") != nullptr || std::getenv("GRPC_TRACE") != nullptr) return;
  gpr_set_log_function(say_last_words);
}

}  // namespace hyades::farm
