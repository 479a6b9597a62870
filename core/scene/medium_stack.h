#pragma once

#include <array>
#include <cstdint>

#include "core/media/medium.h"

namespace hyades::core {

/// The bodies that a path is inside of, innermost last, and so the medium around it. A path keeps
/// one and tells it of every surface that it crosses. Robust against surfaces that are missed or
/// met twice (open meshes): a body that is entered again is inside once, leaving one that was never
/// entered changes nothing.
class MediumStack {
 public:
  /// Outside of all bodies; `atmosphere` (may be null) is what is there.
  explicit MediumStack(const Medium* atmosphere = nullptr) : atmosphere_(atmosphere) {}

  /// What is around; null: nothing.
  const Medium* medium() const { return size_ > 0 ? inside_[size_ - 1].medium : atmosphere_; }

  /// Whether light from outside comes in straight: not through glass.
  bool open() const { return size_ == 0 || inside_[size_ - 1].open; }

  /// Comes into `body`, which is filled with `medium` (may be null); `open`: through a surface that
  /// scatters nothing.
  void enter(uint32_t body, const Medium* medium, bool open) {
    leave(body);
    if (size_ < kDeepest) inside_[size_++] = {body, medium, open};
  }

  void leave(uint32_t body) {
    uint32_t kept = 0;
    for (uint32_t i = 0; i < size_; ++i) {
      if (inside_[i].body != body) inside_[kept++] = inside_[i];
    }
    size_ = kept;
  }

 private:
  /// Bodies within bodies; deeper ones are as if they were not there.
  static constexpr uint32_t kDeepest = 15;

  struct Entry {
    uint32_t body;
    const Medium* medium;
    bool open;
  };

  const Medium* atmosphere_;
  uint32_t size_ = 0;
  std::array<Entry, kDeepest> inside_;
};

}  // namespace hyades::core
