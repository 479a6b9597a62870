#include "core/film/film_part.h"

#include <algorithm>
#include <cstddef>

namespace hyades::core {

Image normalised_part(const Film& film, const PixelRect& part) {
  const PixelRect& window = film.window();
  if (film.layout().layers.splats) {
    return cut_out(film.normalised(), part.x0 - window.x0, part.y0 - window.y0, part.width(),
                   part.height());
  }
  Film cut(film.layout(), part);
  for (const CoverageBox& box : film.coverage().boxes()) {
    const PixelRect common = intersection(box.tile, part);
    if (!common.empty()) cut.mutable_coverage().add({common, box.batches});
  }
  const auto width = static_cast<size_t>(part.width());
  for (size_t c = 0; c < film.layout().channels.size(); ++c) {
    const auto from = film.plane(static_cast<int>(c));
    const auto to = cut.mutable_plane(static_cast<int>(c));
    for (int y = part.y0; y < part.y1; ++y) {
      const auto row = static_cast<size_t>(y - window.y0) * static_cast<size_t>(window.width()) +
                       static_cast<size_t>(part.x0 - window.x0);
      std::copy_n(
          from.begin() + static_cast<std::ptrdiff_t>(row), width,
          to.begin() + static_cast<std::ptrdiff_t>(static_cast<size_t>(y - part.y0) * width));
    }
  }
  return cut.normalised();
}

}  // namespace hyades::core
