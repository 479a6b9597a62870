#include "jobs/generator/images.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/hash.h"
#include "core/base/vec.h"
#include "core/textures/noise.h"

namespace hyades::gallery {
namespace {

using core::Rgb;
using core::Vec2;
using core::Vec3;

float ramp(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.0F, 1.0F);
  return t * t * (3.0F - 2.0F * t);
}

/// Of the tile that `p` (0..1 in both) lies in: how far from its edge, in parts of its inner
/// radius, and a number of its own. Rows of hexagons; 8 x 8 of them make the image.
struct Tile {
  float inward = 0.0F;
  uint64_t name = 0;
};

Tile tile_at(const Vec2& p) {
  constexpr int kColumns = 8, kRows = 8;
  // In a frame where neighbours' centres are 1 apart.
  const float height = 0.8660254F;
  const Vec2 q(p.x * kColumns, p.y * kRows * height);
  Tile tile;
  float nearest = 1e9F, second = 1e9F;
  const int row = static_cast<int>(std::floor(q.y / height));
  for (int r = row - 1; r <= row + 2; ++r) {
    const float shift = (r % 2 + 2) % 2 == 1 ? 0.5F : 0.0F;
    const int column = static_cast<int>(std::floor(q.x - shift));
    for (int c = column - 1; c <= column + 2; ++c) {
      const Vec2 center(static_cast<float>(c) + shift, static_cast<float>(r) * height);
      const float d = glm::length(q - center);
      if (d < nearest) {
        second = nearest;
        nearest = d;
        tile.name = core::mix64(
            static_cast<uint64_t>((r + kRows) % kRows * kColumns + (c + kColumns) % kColumns + 1));
      } else {
        second = std::min(second, d);
      }
    }
  }
  tile.inward = second - nearest;
  return tile;
}

float tile_height(const Vec2& p) { return ramp(0.03F, 0.2F, tile_at(p).inward); }

}  // namespace

core::Image make_leaf(int size) {
  core::Image image = core::make_image(size, size, {"R", "G", "B", "A"});
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      // Along the leaf from its foot (0) to its tip (1); across it, -1..1.
      const float along = (static_cast<float>(y) + 0.5F) / static_cast<float>(size);
      const float across = 2.0F * (static_cast<float>(x) + 0.5F) / static_cast<float>(size) - 1.0F;
      const float teeth = 0.03F * std::abs(std::fmod(along * 14.0F, 1.0F) - 0.5F);
      const float half =
          along < 0.1F
              ? 0.035F
              : 0.78F * std::pow(std::sin(core::kPi * std::pow((along - 0.1F) / 0.9F, 0.62F)),
                                 0.85F) +
                    teeth;
      const float inside = half - std::abs(across);
      const float side_vein =
          std::abs(std::fmod((along - 0.55F * std::abs(across)) * 9.0F + 9.0F, 1.0F) - 0.5F);
      const float vein = std::max(1.0F - ramp(0.012F, 0.035F, std::abs(across)),
                                  0.7F * ramp(0.40F, 0.48F, side_vein));
      const float spots =
          0.5F + 0.5F * core::fbm(Vec3(across * 5.0F, along * 5.0F, 3.0F), 4, 2.0F, 0.5F).value;
      Rgb color = Rgb(0.16F, 0.36F, 0.09F) + spots * Rgb(0.10F, 0.14F, 0.03F);
      color += vein * Rgb(0.20F, 0.20F, 0.10F);
      for (int c = 0; c < 3; ++c) image.at(x, y, c) = color[c];
      image.at(x, y, 3) = ramp(0.0F, 0.012F, inside);
    }
  }
  return image;
}

core::Image make_tiles(int size) {
  core::Image image = core::make_image(size, size, {"R", "G", "B"});
  const std::array<Rgb, 4> glazes = {Rgb(0.55F, 0.19F, 0.13F), Rgb(0.83F, 0.74F, 0.60F),
                                     Rgb(0.20F, 0.34F, 0.38F), Rgb(0.76F, 0.52F, 0.28F)};
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const Vec2 p((static_cast<float>(x) + 0.5F) / static_cast<float>(size),
                   (static_cast<float>(y) + 0.5F) / static_cast<float>(size));
      const Tile tile = tile_at(p);
      const float shade = 0.88F + 0.24F * static_cast<float>(tile.name >> 40 & 255) / 255.0F;
      const Rgb glaze = glazes[tile.name % 4] * shade;
      const float fired = ramp(0.05F, 0.11F, tile.inward);
      const Rgb color = Rgb(0.42F, 0.40F, 0.37F) * (1.0F - fired) + glaze * fired;
      for (int c = 0; c < 3; ++c) image.at(x, y, c) = std::min(color[c], 1.0F);
    }
  }
  return image;
}

core::Image make_tile_normals(int size) {
  core::Image image = core::make_image(size, size, {"R", "G", "B"});
  const float step = 1.0F / static_cast<float>(size);
  constexpr float kDepth = 0.014F;  // of the grout, in widths of the image
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const Vec2 p((static_cast<float>(x) + 0.5F) * step, (static_cast<float>(y) + 0.5F) * step);
      const float du = tile_height(p + Vec2(step, 0.0F)) - tile_height(p - Vec2(step, 0.0F));
      // v grows upwards, rows downwards.
      const float dv = tile_height(p - Vec2(0.0F, step)) - tile_height(p + Vec2(0.0F, step));
      const Vec3 n = glm::normalize(Vec3(-kDepth * du, -kDepth * dv, 2.0F * step));
      for (int c = 0; c < 3; ++c) image.at(x, y, c) = 0.5F + 0.5F * n[c];
    }
  }
  return image;
}

}  // namespace hyades::gallery
