#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/rect.h"
#include "core/base/result.h"
#include "core/film/coverage.h"
#include "core/film/fixed128.h"
#include "core/film/id_counts.h"
#include "core/film/layout.h"
#include "core/film/splats.h"
#include "core/film/unit.h"
#include "core/image/image.h"

namespace hyades::core {

/// An accumulation buffer over a rectangle of a frame: exact sums per pixel, never averages
/// (invariant 2). Merging is associative and commutative to the last bit, so a frame's film does
/// not depend on who rendered what, or when. Not thread-safe: one owner at a time.
class Film {
 public:
  Film() = default;
  Film(FilmLayout layout, PixelRect window) : Film(std::move(layout), window, window) {}
  /// A film with splats (layout.layers.splats) has them in all of `region`, the part of the frame
  /// that its job renders, which contains the window.
  Film(FilmLayout layout, PixelRect window, PixelRect region);

  const FilmLayout& layout() const { return layout_; }
  const PixelRect& window() const { return window_; }
  const Coverage& coverage() const { return coverage_; }
  const SplatLayer& splats() const { return splats_; }
  /// What splats brought to each part of light (FilmLayout::part_names); empty without splats.
  std::span<const PartSplatLayer> part_splats() const { return part_splats_; }
  /// Whose window is empty where the layout has no such ids.
  const IdLayer& ids(IdKind kind) const { return ids_[static_cast<size_t>(kind)]; }

  /// Bytes that it takes.
  uint64_t memory() const;

  /// Adds one batch of all pixels of `tile` (inside the window). `values` holds layout().deposited
  /// floats per pixel, row by row: for sum channels the batch's sum over `samples` samples, rounded
  /// once to float32; for min channels the minimum (+inf where nothing was hit). All sums are
  /// finite (the renderer has counted and dropped others); beyond +-kMaxDeposit they are clamped,
  /// as is moment2. 1 <= samples <= kBatchSamples. It is a bug to deposit a batch twice.
  void deposit(const PixelRect& tile, uint32_t batch, uint32_t samples,
               std::span<const float> values);

  /// Adds what the light paths of a batch brought that deposit() adds as well. Only for films with
  /// splats.
  void deposit_splats(std::vector<PixelSplat> splats);
  /// Adds what the light paths of a batch brought of one part of light.
  void deposit_splats(size_t part, std::vector<PixelSplat> splats);

  /// Adds all of `other`, whose window lies inside this one's. Refused, with nothing changed, where
  /// the layouts or the regions of splats differ or a batch of a pixel is in both (the message
  /// names tile and batches).
  Status merge(const Film& other);

  /// Takes out all that the film holds of the pixels of `tile`, as if it had never been there. The
  /// splats of a tile cannot be told from others': of a film with splats all goes or nothing, so
  /// that `tile` must contain its window.
  void erase(const PixelRect& tile);

  /// The exact sum of a pixel's channel (min channels: the minimum, +inf where nothing was hit).
  Fixed128 sum(int x, int y, int channel) const;
  float minimum(int x, int y, int channel) const;

  /// All samples of all pixels: each traced one light path, where there are splats.
  double all_samples() const;

  /// The picture so far: sums divided by the pixel's sample count, as float. Channels: "R","G","B",
  /// "A", then those of the chosen layers under their names, then "variance.R","G","B": the
  /// variance of the pixel's mean, estimated over batches (0 where fewer than two are there), and
  /// "samples.N". R, G and B have the sum of the splats on top, divided by the number of all
  /// samples of the window: each traced one light path. Pixels without samples are 0. depth is the
  /// minimum (+inf where samples hit nothing); normal is the mean vector, not normalised.
  Image normalised() const;

  /// SHA-256 over layout, window, coverage (in canonical form), sums and splats: equal films, equal
  /// digests.
  std::string digest() const;

  /// Raw planes for codecs: one Fixed128 per pixel of the window, row by row, for each sum channel;
  /// min channels keep a float's bits in `low`.
  std::span<const Fixed128> plane(int channel) const;
  std::span<Fixed128> mutable_plane(int channel);
  Coverage& mutable_coverage() { return coverage_; }
  SplatLayer& mutable_splats() { return splats_; }
  std::span<PartSplatLayer> mutable_part_splats() { return part_splats_; }
  IdLayer& mutable_ids(IdKind kind) { return ids_[static_cast<size_t>(kind)]; }

  /// Whether the parts agree, for films that were read: boxes lie inside the window, and every
  /// pixel holds a whole number of samples that its batches can hold, zeros where it has none.
  /// Splats are there only where a batch is; no pixel has more ids than samples.
  Status check() const;

  /// Whether the ids take no more memory than those of such a film may (id_room(), which
  /// film_memory() counts). What films added up say does not depend on their order.
  Status check_id_room() const;

  /// How many batches each pixel of the window holds, row by row.
  std::vector<uint32_t> batch_counts() const;

 private:
  FilmLayout layout_;
  PixelRect window_;
  Coverage coverage_;
  std::vector<std::vector<Fixed128>> planes_;
  SplatLayer splats_;
  std::vector<PartSplatLayer> part_splats_;
  std::array<IdLayer, kIdKinds> ids_;

  size_t offset(int x, int y) const;
  Status check_splats() const;
  Status check_ids() const;
  void add_splats(Image& image) const;
  void add_part_splats(Image& image) const;
};

}  // namespace hyades::core
