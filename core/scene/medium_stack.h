#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>

#include "core/media/make_medium.h"

namespace hyades::core {

/// The inside of a closed surface, as light knows it that crosses the surface: all parts of the
/// surface (a cylinder and its caps) lead into one body.
struct Body {
  MediumPtr medium;         ///< what fills it; null: nothing
  std::string filled_with;  ///< the name of `medium` in the job; empty: nothing, or a subsurface
  float index = 0.0F;       ///< of refraction inside; 0: that of what is around (null surfaces)
  bool open = true;         ///< light comes in straight: the surface is null
  /// Where bodies overlap, the one of highest rank says what is there. No two are equal.
  uint32_t rank = 0;
  bool may_be_hidden = false;  ///< parts of its surface, by bodies of higher rank
  uint32_t object = 0;         ///< index of the placement whose surface encloses it

  bool refracts() const { return index > 0.0F; }
};

/// The bodies that a path is inside of, and so what is around it. A path keeps one and tells it of
/// every surface that it crosses. Where bodies overlap, the one of highest rank fills the place,
/// and surfaces of lower ones there are not met at all (Schmidt and Budge 2002, "Simple Nested
/// Dielectrics in Ray Traced Images"); ranks, not the order of crossings, decide, so that light
/// finds the same on its way back. Robust against surfaces that are missed or met twice (open
/// meshes): a body that is entered again is inside once, leaving one that was never entered changes
/// nothing.
class MediumStack {
 public:
  /// Outside of all bodies; `atmosphere` (may be null) is what is there.
  explicit MediumStack(const Medium* atmosphere = nullptr) : atmosphere_(atmosphere) {}

  // Copies take no more than is there: paths make many.
  MediumStack(const MediumStack& other) : atmosphere_(other.atmosphere_), size_(other.size_) {
    std::copy_n(other.inside_.begin(), size_, inside_.begin());
  }
  // NOLINTNEXTLINE(bugprone-unhandled-self-assignment): it would come out the same
  MediumStack& operator=(const MediumStack& other) {
    atmosphere_ = other.atmosphere_;
    size_ = other.size_;
    std::copy_n(other.inside_.begin(), size_, inside_.begin());
    return *this;
  }

  /// Outside of all bodies.
  bool empty() const { return size_ == 0; }

  /// The body that fills the place; null: outside of all.
  const Body* body() const { return size_ > 0 ? inside_[0] : nullptr; }

  /// What is around; null: nothing.
  const Medium* medium() const { return size_ > 0 ? inside_[0]->medium.get() : atmosphere_; }

  /// Whether light from outside comes in straight: not through glass.
  bool open() const { return size_ == 0 || inside_[0]->open; }

  /// Index of refraction on the outer side of the surface of `body` (null: of a surface that
  /// bounds none), which the path is at: of what else is there.
  float index_outside(const Body* body) const {
    for (uint32_t i = 0; i < size_; ++i) {
      if (inside_[i] != body && inside_[i]->refracts()) return inside_[i]->index;
    }
    return 1.0F;
  }

  /// Whether the surface of `body` (may be null) is not there, for another body that refracts and
  /// has a higher rank fills the place.
  bool hides(const Body* body) const {
    if (body == nullptr || !body->refracts()) return false;
    for (uint32_t i = 0; i < size_ && inside_[i]->rank > body->rank; ++i) {
      if (inside_[i]->refracts()) return true;
    }
    return false;
  }

  void enter(const Body& body) {
    leave(body);
    uint32_t at = size_;
    while (at > 0 && inside_[at - 1]->rank < body.rank) --at;
    if (at == kDeepest) return;
    size_ = std::min(size_ + 1, kDeepest);
    for (uint32_t i = size_ - 1; i > at; --i) inside_[i] = inside_[i - 1];
    inside_[at] = &body;
  }

  /// Forgets the bodies that are not there for what follows, those for which `is_there` is false.
  template <class IsThere>
  void keep(const IsThere& is_there) {
    const auto end = inside_.begin() + size_;
    const auto last =
        std::remove_if(inside_.begin(), end, [&](const Body* body) { return !is_there(*body); });
    size_ = static_cast<uint32_t>(last - inside_.begin());
  }
  void keep_no_atmosphere() { atmosphere_ = nullptr; }

  void leave(const Body& body) {
    const auto end = inside_.begin() + size_;
    size_ = static_cast<uint32_t>(std::remove(inside_.begin(), end, &body) - inside_.begin());
  }

 private:
  /// Bodies in one place; of more, those of lowest rank are as if they were not there.
  static constexpr uint32_t kDeepest = 64;

  const Medium* atmosphere_;
  uint32_t size_ = 0;
  std::array<const Body*, kDeepest> inside_;  ///< by rank, highest first
};

}  // namespace hyades::core
