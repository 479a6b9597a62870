#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/rect.h"
#include "core/base/result.h"

namespace hyades::core {

/// How a channel of two films becomes one.
enum class MergeRule : uint8_t {
  sum,  ///< exact addition (Q64.64)
  min,  ///< the smaller (depth)
};

/// Which way light came: by what it met first, seen from the camera, and whether it came from there
/// straight to its source (direct) or by further scattering (indirect). What the camera sees
/// without any scattering is emission (of surfaces and media) or environment (of what is infinitely
/// far). Every bit of light is in one of them: their sum is beauty.
enum class LightComponent : uint8_t {
  diffuse_direct,
  diffuse_indirect,
  glossy_direct,
  glossy_indirect,
  transmission_direct,
  transmission_indirect,
  volume_direct,
  volume_indirect,
  emission,
  environment,
};
inline constexpr size_t kLightComponents = 10;

/// The name of the layer that holds a component: "diffuse_direct", ...
const char* name_of(LightComponent component);

/// What an id counts: the pixel's objects or its materials.
enum class IdKind : uint8_t { object, material };
inline constexpr size_t kIdKinds = 2;

/// What light of lights without a group counts for, where groups are told apart.
inline constexpr const char* kRestGroup = "rest";
/// The names of light groups' layers are this and the group's name.
inline constexpr std::string_view kGroupPrefix = "light_group:";

/// What a film can hold besides beauty.
struct LayerSet {
  bool depth = false;   ///< distance to the camera plane (camera-space z) of the nearest first hit
  bool albedo = false;  ///< reflectance at the first non-specular hit
  bool normal = false;  ///< world-space shading normal at the first hit
  bool splats = false;  ///< not a layer of the picture: beauty has a part that light paths brought
  bool position = false;  ///< world-space place of the first hit
  bool motion = false;    ///< how far it moves until the next frame, pixels
  std::array<bool, kLightComponents> components{};
  std::vector<std::string> light_groups{};  ///< ascending; kRestGroup: light of no group
  std::array<bool, kIdKinds> ids{};         ///< how many samples met which object, which material
  friend bool operator==(const LayerSet&, const LayerSet&) = default;

  bool has_ids() const { return ids[0] || ids[1]; }
};

/// The layers of `set`, splats too, in a fixed order: "depth, normal, light_group:key".
std::string layers_text(const LayerSet& set);

/// The layers that layers_text() names by `text`; refuses what it would not write.
Result<LayerSet> parse_layers(std::string_view text);

/// The oldest version of film files and film bytes that can hold such layers: 1; 2: splats; 3: any.
int film_version(const LayerSet& layers);

struct FilmChannel {
  std::string name;  ///< EXR name: "R", "A", "depth.Z", "albedo.R", "normal.X", "moment2.R", ...
  MergeRule rule = MergeRule::sum;
  friend bool operator==(const FilmChannel&, const FilmChannel&) = default;
};

/// The channels of a film in fixed order. Deposited channels come first (the integrator fills them
/// in this order: R G B A [depth.Z] [albedo.R G B] [normal.X Y Z] [position.X Y Z] [forward.u v]
/// [R G B of each part of light]); behind them those that the film derives itself: moment2.R G B
/// (sum over batches of s^2 / n, where s is the batch's sum over its n samples) and samples.N (how
/// many samples the pixel holds).
struct FilmLayout {
  LayerSet layers;
  std::vector<FilmChannel> channels;
  int deposited = 0;  ///< how many channels the renderer deposits
  int depth = -1;     ///< index of depth.Z, or -1
  int albedo = -1;    ///< index of albedo.R, or -1
  int normal = -1;    ///< index of normal.X, or -1
  int position = -1;  ///< index of position.X, or -1
  int motion = -1;    ///< index of forward.u, or -1
  int parts = -1;     ///< index of the first part of light's R, or -1; three channels each
  int moment2 = -1;   ///< index of moment2.R
  int samples = -1;   ///< index of samples.N
  /// Components that are held, in their order, then light groups: which part each is, or -1.
  std::array<int, kLightComponents> component_parts{};
  std::vector<std::string> part_names;  ///< "diffuse_direct", ..., "light_group_key"; EXR names
  friend bool operator==(const FilmLayout&, const FilmLayout&) = default;

  size_t part_count() const { return part_names.size(); }
  /// Which part light group `name` is, or -1.
  int group_part(std::string_view name) const;
};

FilmLayout make_film_layout(const LayerSet& layers);

/// The part of an EXR channel's name before the dot that light group `name` has.
std::string group_channel(std::string_view name);

/// Bytes that the sums of a film take in memory at most, splats being those of its window's pixels.
/// Ids of each kind have what id_room() says.
uint64_t film_memory(const FilmLayout& layout, const PixelRect& window);
/// Bytes that the ids of one kind may take: eight of each pixel on the average, and their names.
uint64_t id_room(const PixelRect& window);
/// Bytes that the sums of a film take in memory at most where its splats are those of all of
/// `region`, which contains the window.
uint64_t film_memory(const FilmLayout& layout, const PixelRect& window, const PixelRect& region);

}  // namespace hyades::core
