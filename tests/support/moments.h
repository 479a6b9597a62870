#pragma once

#include <cstdint>

namespace hyades::test {

/// Mean and variance of a stream of numbers (Welford 1962; merging: Chan et al. 1979).
class Moments {
 public:
  void add(double x) {
    ++count_;
    const double delta = x - mean_;
    mean_ += delta / static_cast<double>(count_);
    m2_ += delta * (x - mean_);
  }

  void merge(const Moments& other) {
    if (other.count_ == 0) return;
    const auto a = static_cast<double>(count_);
    const auto b = static_cast<double>(other.count_);
    const double delta = other.mean_ - mean_;
    mean_ += delta * b / (a + b);
    m2_ += other.m2_ + delta * delta * a * b / (a + b);
    count_ += other.count_;
  }

  int64_t count() const { return count_; }
  double mean() const { return mean_; }
  /// Unbiased; 0 for fewer than two numbers.
  double variance() const { return count_ > 1 ? m2_ / static_cast<double>(count_ - 1) : 0.0; }
  /// Variance of the mean.
  double variance_of_mean() const {
    return count_ > 0 ? variance() / static_cast<double>(count_) : 0.0;
  }

 private:
  int64_t count_ = 0;
  double mean_ = 0.0;
  double m2_ = 0.0;
};

}  // namespace hyades::test
