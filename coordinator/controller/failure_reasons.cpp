#include "coordinator/controller/failure_reasons.h"

#include <utility>

namespace hyades::coordinator {
namespace {

/// What one takes besides its text, about.
constexpr size_t kOverhead = 128;

}  // namespace

FailureReasons::Reason FailureReasons::share(std::string text) {
  static const Reason kElsewhere = std::make_shared<const std::string>(
      "told when the job has ended, as too many frames have failed for different reasons");
  auto reason = std::make_shared<const std::string>(std::move(text));
  if (const auto known = reasons_.find(reason); known != reasons_.end()) return *known;
  const size_t bytes = reason->size() + kOverhead;
  if (bytes_ + bytes > kMostBytes) forget_unused();
  if (bytes_ + bytes > kMostBytes) return kElsewhere;
  bytes_ += bytes;
  reasons_.insert(reason);
  return reason;
}

/// Their frames have begun again.
void FailureReasons::forget_unused() {
  for (auto it = reasons_.begin(); it != reasons_.end();) {
    if (it->use_count() > 1) {
      ++it;
      continue;
    }
    bytes_ -= (*it)->size() + kOverhead;
    it = reasons_.erase(it);
  }
}

}  // namespace hyades::coordinator
