#pragma once

#include <cstddef>
#include <memory>
#include <set>
#include <string>

namespace hyades::coordinator {

/// Why frames of a job have failed, as far as that is kept in memory: a text that many have in
/// common once, and all of a job's together bounded, as there may be a million. The job store has
/// them all.
class FailureReasons {
 public:
  using Reason = std::shared_ptr<const std::string>;

  /// The text, or where there is no room for it, where it is to be found.
  Reason share(std::string text);

  /// Bytes that all of a job take at most.
  static constexpr size_t kMostBytes = size_t{64} << 10U;

 private:
  struct ByText {
    bool operator()(const Reason& a, const Reason& b) const { return *a < *b; }
  };

  void forget_unused();

  std::set<Reason, ByText> reasons_;
  size_t bytes_ = 0;
};

}  // namespace hyades::coordinator
