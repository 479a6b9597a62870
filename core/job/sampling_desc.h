#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "core/base/rect.h"
#include "core/base/render_class.h"
#include "core/job/fields.h"

namespace hyades::core {

struct FramesDesc {
  int32_t first = 1;
  int32_t last = 1;
  int32_t step = 1;
  float fps = 24.0F;
  float shutter = 0.0F;  ///< fraction of the frame time that the shutter stays open, 0..1
};

enum class FilterKind { box, triangle, gaussian, mitchell, blackman_harris, center };
inline const std::array<std::string, 6> kFilterNames = {"box",      "triangle",        "gaussian",
                                                        "mitchell", "blackman-harris", "center"};
/// By FilterKind: the default of `radius`. A center has none.
inline constexpr std::array<float, 6> kFilterRadii = {0.5F, 1.0F, 1.5F, 2.0F, 1.5F, 0.0F};

struct FilterDesc {
  FilterKind type = FilterKind::blackman_harris;
  float radius = 1.5F;  ///< half its width

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.choice(KeyName{"type", "filter"}, self.type, kFilterNames);
    visit.starts_at(self.radius, kFilterRadii[static_cast<size_t>(self.type)]);
    if (self.type == FilterKind::center) return;
    visit.number(KeyName{"radius", "filter_radius"}, self.radius,
                 Range{0.0, 16.0, true}.in("pixels"));
  }
};

struct FilmDesc {
  int32_t width = 640;
  int32_t height = 360;
  std::optional<PixelRect> crop;  ///< pixels to render; all where absent
  FilterDesc filter;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.integers("size", "width", self.width, "height", self.height, 1, 65536);
    visit.crop("crop", self);
    visit.type_or_map(KeyName{"filter", ""}, "film.filter", self.filter, kFilterNames);
  }
};

/// The part of the frame that a job renders: its crop, or everything.
inline PixelRect render_window(const FilmDesc& film) {
  const PixelRect frame{0, 0, film.width, film.height};
  return film.crop ? intersection(frame, *film.crop) : frame;
}

enum class SamplerName { sobol, independent };
inline const std::array<std::string, 2> kSamplerNames = {"sobol", "independent"};

struct SamplingDesc {
  uint32_t samples = 64;
  uint64_t seed = 0;
  SamplerName sampler = SamplerName::sobol;
  float noise = 0.0F;         ///< at which a tile has samples enough; 0: it gets all
  uint32_t min_samples = 32;  ///< that it gets in any case, where there is a `noise`

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.integer("samples", self.samples, 1, int64_t{1} << 24);
    visit.integer("seed", self.seed);
    visit.choice("sampler", self.sampler, kSamplerNames);
    visit.number("noise", self.noise, kUnitInterval);
    visit.integer("min_samples", self.min_samples, 1, int64_t{1} << 24);
  }
};

struct RenderDesc {
  RenderClass render_class = RenderClass::native;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.choice("class", self.render_class, kRenderClassNames);
  }
};

inline const std::array<std::string, 3> kIntegratorTypes = {"path", "bdpt", "mlt"};
inline const std::array<std::string, 2> kChainTypes = {"bdpt", "path"};

struct IntegratorDesc {
  std::string type = kIntegratorTypes[0];
  int max_depth = 32;      ///< most scattering events between light and camera
  int roulette_depth = 4;  ///< Russian roulette may end a path after this many
  float clamp = 0.0F;      ///< path; biased: largest radiance of one indirect sample; 0 = off

  // bdpt: to look at one strategy alone.
  int light_vertices = -1;   ///< s: only paths of which the light path gives so many; -1: all
  int camera_vertices = -1;  ///< t, likewise
  bool mis = true;           ///< false: unweighted

  // mlt.
  std::string over = kChainTypes[0];  ///< whose samples the chains mutate
  float large_step = 0.3F;            ///< probability of an independent sample

  // Not keys of jobs: fewer, or more, scattering events bring no light.
  int min_events = 0;
  int max_events = 1 << 30;

  /// The keys of its type.
  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    if (self.type == "mlt") visit.choice("over", self.over, kChainTypes);
    visit.integer("max_depth", self.max_depth, 0, 65536);
    visit.integer("roulette_depth", self.roulette_depth, 0, 65536);
    if (self.type == "path") visit.number("clamp", self.clamp, kNotNegative.in("W/(m² sr)"));
    if (self.type == "bdpt") {
      visit.integers("strategy", "light_vertices", self.light_vertices, "camera_vertices",
                     self.camera_vertices, 0, 65538);
      visit.flag("mis", self.mis);
    }
    if (self.type == "mlt") visit.number("large_step", self.large_step, {0.01, 1.0});
  }
};

}  // namespace hyades::core
