#pragma once

#include <algorithm>
#include <mutex>
#include <vector>

namespace hyades::bench {

/// Times of one kind, in milliseconds, from many threads.
class Latencies {
 public:
  struct Summary {
    size_t count = 0;
    double p50 = 0, p90 = 0, p99 = 0, most = 0;
  };

  void add(double milliseconds) {
    const std::lock_guard lock(mutex_);
    values_.push_back(milliseconds);
  }

  /// Of those since the last call, which are forgotten.
  Summary take() {
    std::vector<double> values;
    {
      const std::lock_guard lock(mutex_);
      values.swap(values_);
    }
    if (values.empty()) return {};
    std::sort(values.begin(), values.end());
    const auto at = [&](double share) {
      return values[static_cast<size_t>(share * static_cast<double>(values.size() - 1))];
    };
    return {values.size(), at(0.5), at(0.9), at(0.99), values.back()};
  }

 private:
  std::mutex mutex_;
  std::vector<double> values_;
};

}  // namespace hyades::bench
