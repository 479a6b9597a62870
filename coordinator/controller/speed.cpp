#include "coordinator/controller/speed.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace hyades::coordinator {
namespace {

constexpr double kSmoothing = 10.0;  // seconds
constexpr double kEnough = 4.0;      // seconds, smoothed: five
constexpr int kEnoughLumps = 4;

}  // namespace

void Speed::note(uint64_t done, TimePoint now, bool busy) {
  if (last_ != TimePoint{} && busy) {
    const double passed = std::chrono::duration<double>(now - last_).count();
    if (passed <= 0) return;
    // Of the time before it is counted how long it was, so that the first films of a job, or the
    // first after a start, are not taken for what comes in a moment.
    const double keep = std::exp(-passed / kSmoothing);
    const double fresh = done > done_ ? static_cast<double>(done - done_) : 0.0;
    samples_ = keep * samples_ + fresh;
    if (fresh > 0) lumps_ = std::min(lumps_ + 1, kEnoughLumps);
    seconds_ = keep * seconds_ + passed;
  }
  last_ = now;
  done_ = done;
}

bool Speed::tells_rest() const { return seconds_ >= kEnough && lumps_ >= kEnoughLumps; }

}  // namespace hyades::coordinator
