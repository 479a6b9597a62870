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
  const double wait = next_ * std::uniform_real_distribution(0.5, 1.0)(random_);
  next_ = std::min(2 * next_, kLongest);
  return std::min(std::max(wait, asked_for), left);
}

}  // namespace hyades::cli
