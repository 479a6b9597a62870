#include <cstddef>
#include <span>
#include <string>

#include <fmt/format.h>

#include "core/base/hash.h"
#include "core/film/film.h"

namespace hyades::core {

std::string Film::digest() const {
  // A text that names everything, the planes by their own hashes: no copy of the film is made.
  std::string text = fmt::format("hyades film 1\nwindow {} {} {} {}\n", window_.x0, window_.y0,
                                 window_.x1, window_.y1);
  for (const CoverageBox& box : coverage_.canonical()) {
    text += fmt::format("holds {} {} {} {} {} {}\n", box.tile.x0, box.tile.y0, box.tile.x1,
                        box.tile.y1, box.batches.first, box.batches.count);
  }
  for (size_t c = 0; c < planes_.size(); ++c) {
    const FilmChannel& channel = layout_.channels[c];
    const std::span<const Fixed128> plane = planes_[c];
    text += fmt::format("{} {} {}\n", channel.rule == MergeRule::min ? "min" : "sum", channel.name,
                        to_hex(sha256(std::as_bytes(plane))));
  }
  if (layout_.layers.splats) {
    const PixelRect& region = splats_.region();
    text += fmt::format("splats {} {} {} {} {}\n", region.x0, region.y0, region.x1, region.y1,
                        splats_.digest());
    for (size_t i = 0; i < part_splats_.size(); ++i)
      text += fmt::format("splats {} {}\n", layout_.part_names[i], part_splats_[i].digest());
  }
  for (size_t kind = 0; kind < kIdKinds; ++kind) {
    if (layout_.layers.ids[kind]) text += fmt::format("ids {} {}\n", kind, ids_[kind].digest());
  }
  return to_hex(sha256(text));
}

}  // namespace hyades::core
