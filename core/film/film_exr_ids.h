#pragma once

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/film/film.h"

namespace hyades::core {

/// The channels of part "sums" that hold ids: the first id of each pixel (ascending) is
/// "object.0.id" with "object.0.count", the second "object.1.id", ...; "material.0.id", ... One row
/// of pixels lies here at a time.
class IdRows {
 public:
  /// With as many channels as `film` needs.
  explicit IdRows(const Film& film);

  /// With as many channels as a file has for ids; its others are not looked at.
  IdRows(const FilmLayout& layout, const PixelRect& window, const Imf::ChannelList& channels);

  const std::vector<std::string>& names() const { return names_; }

  /// Where OpenEXR reads and writes every row.
  void insert(Imf::FrameBuffer& buffer);

  /// Row `y` of `film` into the buffer.
  void fill(const Film& film, int y);

  /// The buffer into row `y` of `film`, whose ids are read in ascending rows; false where it holds
  /// none that a film could.
  bool take(int y, Film& film) const;

 private:
  void make();
  size_t entry(size_t kind, int x, size_t rank) const;  ///< its place in row_

  PixelRect window_;
  std::array<size_t, kIdKinds> ranks_{};  ///< how many ids a pixel has at most
  std::vector<std::string> names_;
  std::vector<uint32_t> row_;  ///< by pixel: id and count of all ranks of all kinds
};

}  // namespace hyades::core
