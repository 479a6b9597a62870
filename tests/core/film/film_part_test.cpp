#include "core/film/film_part.h"

#include <gtest/gtest.h>

#include "tests/core/film/film_testing.h"

namespace hyades::core {
namespace {

constexpr PixelRect kWindow{5, 7, 45, 37};
constexpr uint32_t kSamples = 40;

/// A film with some batches here and others there.
Film patchy_film(bool splats) {
  LayerSet layers = kAllLayers;
  layers.splats = splats;
  const FilmLayout layout = make_film_layout(layers);
  Film film(layout, kWindow);
  const Unit units[] = {
      {1, {5, 7, 25, 27}, {0, 3}}, {1, {25, 7, 45, 17}, {1, 1}}, {1, {10, 27, 30, 37}, {0, 2}}};
  for (const Unit& unit : units) {
    EXPECT_TRUE(
        film.merge(splats ? render_with_splats(layout, unit.tile, unit.batches, kWindow, kSamples)
                          : render(layout, unit.tile, unit.batches, kSamples)));
  }
  return film;
}

TEST(FilmPart, IsThePictureOfThatPart) {
  for (const bool splats : {false, true}) {
    const Film film = patchy_film(splats);
    const Image whole = film.normalised();
    for (const PixelRect& part :
         {kWindow, PixelRect{5, 7, 6, 8}, PixelRect{20, 12, 33, 31}, PixelRect{40, 30, 45, 37}}) {
      const Image cut = normalised_part(film, part);
      EXPECT_EQ(cut.channels, whole.channels);
      EXPECT_EQ(cut.data, cut_out(whole, part.x0 - kWindow.x0, part.y0 - kWindow.y0, part.width(),
                                  part.height())
                              .data);
    }
  }
}

}  // namespace
}  // namespace hyades::core
