#include "core/finish/picture_layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/base/hash.h"
#include "core/base/text.h"
#include "core/base/vec.h"
#include "core/film/layout.h"
#include "core/finish/cryptomatte.h"
#include "core/job/output_names.h"

namespace hyades::core {
namespace {

constexpr float kPositionUnit = 10.0F;   ///< m
constexpr float kMotionReach = 32.0F;    ///< pixels, to either end of the scale
constexpr float kInfiniteDepth = 1e30F;  ///< nothing was met

std::vector<std::string> colours(const std::string& name) {
  return {name + ".R", name + ".G", name + ".B"};
}

std::vector<std::string> cryptomatte_channels(const std::string& name) {
  std::vector<std::string> channels;
  for (int level = 0; level < kCryptomatteRanks / 2; ++level) {
    for (const char c : {'R', 'G', 'B', 'A'})
      channels.push_back(fmt::format("{}{:02}.{}", name, level, c));
  }
  return channels;
}

/// Of every light group that the picture holds.
std::vector<std::string> group_channels(const Image& picture) {
  std::vector<std::string> channels;
  for (const std::string& channel : picture.channels) {
    if (channel.starts_with(group_channel(""))) channels.push_back(channel);
  }
  return channels;
}

bool is_component(std::string_view layer) {
  for (size_t i = 0; i < kLightComponents; ++i) {
    if (layer == name_of(static_cast<LightComponent>(i))) return true;
  }
  return false;
}

/// The values of the layer's first three channels in a pixel; those that it lacks are 0.
using Pixel = Vec3;
using Show = Vec3 (*)(const Pixel& value, const Pixel& largest);

Vec3 show_direction(const Pixel& v, const Pixel&) { return 0.5F + 0.5F * v; }

Vec3 show_position(const Pixel& v, const Pixel&) {
  const Vec3 scaled = v / kPositionUnit;
  return scaled - glm::floor(scaled);
}

Vec3 show_depth(const Pixel& v, const Pixel& largest) {
  if (!(v.x < kInfiniteDepth) || !(largest.x > 0.0F)) return Vec3(0.0F);
  return Vec3(1.0F - v.x / largest.x);
}

Vec3 show_motion(const Pixel& v, const Pixel&) {
  const Vec2 scaled = 0.5F + 0.5F * Vec2(v) / kMotionReach;
  return {scaled.x, scaled.y, 0.5F};
}

Vec3 show_share(const Pixel& v, const Pixel& largest) {
  return Vec3(largest.x > 0.0F ? v.x / largest.x : 0.0F);
}

Vec3 show_id(const Pixel& v, const Pixel&) {
  const auto id = std::bit_cast<uint32_t>(v.x);
  if (id == 0) return Vec3(0.0F);
  const uint64_t random = mix64(id);
  const auto part = [&](unsigned shift) {
    return 0.15F + 0.85F * static_cast<float>(random >> shift & 0xFFU) / 255.0F;
  };
  return {part(0), part(8), part(16)};
}

/// How a layer that is no light is shown; null: it is light.
Show how_to_show(std::string_view layer) {
  if (layer == "normal") return show_direction;
  if (layer == "position") return show_position;
  if (layer == "depth") return show_depth;
  if (layer == "motion") return show_motion;
  if (layer == "samples" || layer == "alpha") return show_share;
  if (layer == "object_id" || layer == "material_id" || layer.starts_with("crypto_"))
    return show_id;
  return nullptr;
}

}  // namespace

std::vector<std::string> channels_of(std::string_view layer, const Image& picture) {
  const std::string name(layer);
  if (layer == "beauty") return {"R", "G", "B"};
  if (layer == "alpha") return {"A"};
  if (layer == "depth") return {"depth.Z"};
  if (layer == "normal" || layer == "position") return {name + ".X", name + ".Y", name + ".Z"};
  if (layer == "motion") return {"forward.u", "forward.v"};
  if (layer == "samples") return {"samples.N"};
  if (layer == "albedo" || layer == "variance" || layer == "denoised" || is_component(layer))
    return colours(name);
  if (layer == "light_groups") return group_channels(picture);
  if (layer.starts_with(kGroupPrefix))
    return colours(group_channel(layer.substr(kGroupPrefix.size())));
  if (layer == "object_id" || layer == "material_id") return {name + ".ID"};
  if (layer == "crypto_object") return cryptomatte_channels("CryptoObject");
  if (layer == "crypto_material") return cryptomatte_channels("CryptoMaterial");
  return {};
}

namespace {

/// The layers of jobs that are in the picture.
std::vector<std::string> layers_held(const Image& picture) {
  std::vector<std::string> held;
  for (const std::string& layer : layer_names()) {
    const std::vector<std::string> channels = channels_of(layer, picture);
    const bool all = std::all_of(channels.begin(), channels.end(), [&](const std::string& channel) {
      return picture.find_channel(channel) >= 0;
    });
    if (all && !channels.empty()) held.push_back(layer);
  }
  return held;
}

}  // namespace

Result<LayerView> view_layer(const Image& picture, const std::string& layer) {
  std::vector<int> sources;
  for (const std::string& channel : channels_of(layer, picture)) {
    sources.push_back(picture.find_channel(channel));
    if (sources.size() == 3) break;
  }
  if (sources.empty() || std::find(sources.begin(), sources.end(), -1) != sources.end()) {
    const std::vector<std::string> held = layers_held(picture);
    return Error{fmt::format("there is no layer '{}' in it, expected {}{}", layer, join_names(held),
                             did_you_mean(layer, held))};
  }
  const size_t stride = picture.channels.size();
  const size_t pixels = picture.data.size() / stride;
  const auto value = [&](size_t pixel) {
    Pixel v(0.0F);
    for (size_t c = 0; c < sources.size(); ++c)
      v[static_cast<int>(c)] = picture.data[pixel * stride + static_cast<size_t>(sources[c])];
    return v;
  };
  Pixel largest(0.0F);
  for (size_t i = 0; i < pixels; ++i) {
    const Pixel v = value(i);
    for (int c = 0; c < 3; ++c) {
      if (v[c] < kInfiniteDepth) largest[c] = std::max(largest[c], v[c]);
    }
  }
  const Show show = how_to_show(layer);
  LayerView view{make_image(picture.width, picture.height, {"R", "G", "B"}), show == nullptr};
  view.image.placement = picture.placement;
  for (size_t i = 0; i < pixels; ++i) {
    const Vec3 shown = show != nullptr ? show(value(i), largest) : value(i);
    for (size_t c = 0; c < 3; ++c) view.image.data[3 * i + c] = shown[static_cast<int>(c)];
  }
  return view;
}

}  // namespace hyades::core
