#pragma once

#include <atomic>
#include <cstdint>
#include <memory>

namespace hyades::coordinator {

/// How much memory copies of films take together, which are made for those who look at them while
/// they grow. What grows is counted elsewhere (--film-memory). Thread-safe.
class FilmCopies {
 public:
  explicit FilmCopies(uint64_t most) : most_(most) {}

  uint64_t most() const { return most_; }

  /// Room for so many bytes, for as long as the result is kept, which the FilmCopies outlive; null
  /// where there is none.
  std::shared_ptr<const void> hold(uint64_t bytes) {
    if (held_ += bytes; held_ > most_) {
      held_ -= bytes;
      return nullptr;
    }
    return {this, [this, bytes](const void*) { held_ -= bytes; }};
  }

 private:
  const uint64_t most_;
  std::atomic<uint64_t> held_{0};
};

}  // namespace hyades::coordinator
