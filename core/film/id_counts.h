#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/base/rect.h"
#include "core/base/result.h"

namespace hyades::core {

/// The id of what is called `name`, by the Cryptomatte specification (Friedman and Jones 2015,
/// version 1.2.0): its MurmurHash3, one bit turned where its bits would be a denormal, infinite or
/// no number. Never 0.
uint32_t id_of(const std::string& name);

/// How many samples of a pixel met what `id` names.
struct IdCount {
  uint32_t pixel = 0;  ///< of the window, row by row
  uint32_t id = 0;
  uint32_t count = 0;
  friend bool operator==(const IdCount&, const IdCount&) = default;
};

/// What the first surfaces of samples were called: for every pixel of a window how many samples met
/// which id, as integers, so that layers add up to the same in any order (invariant 2), and the
/// ids' names. Samples that met nothing have id kNothing, so that a pixel's counts add up to the
/// samples that count. Holds no more than what was met. Not thread-safe.
class IdLayer {
 public:
  static constexpr uint32_t kNothing = 0;

  IdLayer() = default;
  explicit IdLayer(PixelRect window);

  const PixelRect& window() const { return window_; }

  /// Adds counts, in any order, none of them 0.
  void deposit(std::vector<IdCount> counts);

  /// Says what `id` is called. Of two names of one id the one that comes first in the alphabet
  /// stays.
  void name(uint32_t id, const std::string& name);

  /// Adds all of `other`, whose window lies in this one's.
  void merge(const IdLayer& other);

  /// Takes out what the pixels of `tile` hold, and names that are met nowhere any more.
  void erase(const PixelRect& tile);

  /// What row `y` of the window holds: by pixel, then by id.
  std::span<const IdCount> row(int y) const;

  /// What the pixel holds, by id.
  std::span<const IdCount> at(int x, int y) const;

  const std::map<uint32_t, std::string>& names() const { return names_; }
  uint64_t count() const;  ///< pairs of pixel and id
  /// Bytes that it takes. They depend on what it holds alone, not on how that came together.
  uint64_t memory() const;

  /// Adds counts in ascending order, each pair once; false where they are not that, or are outside.
  /// For readers of files.
  bool add_sorted(std::span<const IdCount> counts);

  /// Whether every id but kNothing has a name, and every name an id that is met, for layers that
  /// were read.
  Status check() const;

  /// SHA-256, in hex, of counts and names.
  std::string digest() const;

 private:
  void add_row(std::vector<IdCount>& into, std::span<const IdCount> from) const;

  PixelRect window_;
  std::vector<std::vector<IdCount>> rows_;  ///< ascending each
  std::map<uint32_t, std::string> names_;
  uint64_t name_bytes_ = 0;  ///< of all names together
};

}  // namespace hyades::core
