#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/rect.h"
#include "core/base/result.h"
#include "core/film/coverage.h"
#include "core/film/fixed128.h"
#include "core/film/layout.h"
#include "core/film/unit.h"
#include "core/image/image.h"

namespace hyades::core {

/// An accumulation buffer over a rectangle of a frame: exact sums per pixel, never averages
/// (invariant 2). Merging is associative and commutative to the last bit, so a frame's film does
/// not depend on who rendered what, or when. Not thread-safe: one owner at a time.
class Film {
 public:
  Film() = default;
  Film(FilmLayout layout, PixelRect window);

  const FilmLayout& layout() const { return layout_; }
  const PixelRect& window() const { return window_; }
  const Coverage& coverage() const { return coverage_; }

  /// Adds one batch of all pixels of `tile` (inside the window). `values` holds layout().deposited
  /// floats per pixel, row by row: for sum channels the batch's sum over `samples` samples, rounded
  /// once to float32; for min channels the minimum (+inf where nothing was hit). All sums are
  /// finite (the renderer has counted and dropped others); beyond +-kMaxDeposit they are clamped,
  /// as is moment2. 1 <= samples <= kBatchSamples. It is a bug to deposit a batch twice.
  void deposit(const PixelRect& tile, uint32_t batch, uint32_t samples,
               std::span<const float> values);

  /// Adds all of `other`, whose window lies inside this one's. Refused, with nothing changed, where
  /// the layouts differ or a batch of a pixel is in both (the message names tile and batches).
  Status merge(const Film& other);

  /// Takes out all that the film holds of the pixels of `tile`, as if it had never been there.
  void erase(const PixelRect& tile);

  /// The exact sum of a pixel's channel (min channels: the minimum, +inf where nothing was hit).
  Fixed128 sum(int x, int y, int channel) const;
  float minimum(int x, int y, int channel) const;

  /// The picture so far: sums divided by the pixel's sample count, as float. Channels: "R","G","B",
  /// "A", then those of the chosen layers under their names, then "variance.R","G","B": the
  /// variance of the pixel's mean, estimated over batches (0 where fewer than two are there), and
  /// "samples.N". Pixels without samples are 0. depth is the minimum (+inf where samples hit
  /// nothing); normal is the mean vector, not normalised.
  Image normalised() const;

  /// SHA-256 over layout, window, coverage (in canonical form) and sums: equal films, equal
  /// digests.
  std::string digest() const;

  /// Raw planes for codecs: one Fixed128 per pixel of the window, row by row, for each sum channel;
  /// min channels keep a float's bits in `low`.
  std::span<const Fixed128> plane(int channel) const;
  std::span<Fixed128> mutable_plane(int channel);
  Coverage& mutable_coverage() { return coverage_; }

  /// Whether the parts agree, for films that were read: boxes lie inside the window, and every
  /// pixel holds a whole number of samples that its batches can hold, zeros where it has none.
  Status check() const;

  /// How many batches each pixel of the window holds, row by row.
  std::vector<uint32_t> batch_counts() const;

 private:
  FilmLayout layout_;
  PixelRect window_;
  Coverage coverage_;
  std::vector<std::vector<Fixed128>> planes_;

  size_t offset(int x, int y) const;
};

}  // namespace hyades::core
