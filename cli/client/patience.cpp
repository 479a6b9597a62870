#include "cli/client/patience.h"

#include <algorithm>

namespace hyades::cli {

double Patience::next_wait(Clock::time_point now, double asked_for) {
  if (!waiting_) {
    waiting_ = true;
    since_ = now;
  }
  const double left =
      (reached_ ? later_ : first_) - std::chrono::duration<double>(now - since_).count();
  if (left <= 0) return -1;
  const auto asked = std::chrono::duration_cast<Clock::duration>(
      std::chrono::duration<double>(std::max(asked_for, 0.0)));
  const double wait = std::chrono::duration<double>(backoff_.next(asked)).count();
  return std::min(wait, left);
}

}  // namespace hyades::cli
