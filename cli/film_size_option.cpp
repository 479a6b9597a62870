#include "cli/film_size_option.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include <CLI/CLI.hpp>

#include "cli/number_range.h"
#include "cli/whole_numbers.h"

namespace hyades::cli {
namespace {

constexpr int32_t kMostSide = 65536;  ///< pixels

/// "640x360".
std::optional<std::pair<int32_t, int32_t>> size_in(const std::string& text) {
  const auto sides = whole_numbers(text, 'x', 2);
  if (!sides) return std::nullopt;
  for (const int side : *sides) {
    if (side < 1 || side > kMostSide) return std::nullopt;
  }
  return std::pair((*sides)[0], (*sides)[1]);
}

std::string size_error(const std::string& text) {
  return size_in(text) ? std::string() : text + ": expected WIDTHxHEIGHT, such as 640x360";
}

int32_t scaled(int32_t length, double scale) {
  return static_cast<int32_t>(
      std::clamp(std::round(length * scale), 1.0, static_cast<double>(kMostSide)));
}

void resize(core::FilmDesc& film, int32_t width, int32_t height) {
  if (film.crop) {
    const double x = static_cast<double>(width) / film.width;
    const double y = static_cast<double>(height) / film.height;
    core::PixelRect& crop = *film.crop;
    crop = {static_cast<int32_t>(std::floor(crop.x0 * x)),
            static_cast<int32_t>(std::floor(crop.y0 * y)),
            std::min(static_cast<int32_t>(std::ceil(crop.x1 * x)), width),
            std::min(static_cast<int32_t>(std::ceil(crop.y1 * y)), height)};
  }
  film.width = width;
  film.height = height;
}

}  // namespace

void declare_film_size(CLI::App& app, FilmSizeOption& option) {
  auto* size = app.add_option("--size", option.size,
                              "the film's size in pixels, 640x360, instead of the job's")
                   ->check(size_error)
                   ->type_name("WIDTHxHEIGHT");
  app.add_option("--scale", option.scale, "of the film's size: 0.5 has half as many columns")
      ->check(in_range(0.001, 100.0))
      ->excludes(size);
}

void resize_film(const FilmSizeOption& option, core::FilmDesc& film) {
  if (const auto size = size_in(option.size)) resize(film, size->first, size->second);
  if (option.scale > 0.0) {
    resize(film, scaled(film.width, option.scale), scaled(film.height, option.scale));
  }
}

}  // namespace hyades::cli
