#include <optional>

#include "core/scene/texture_kind_makers.h"
#include "core/scene/texture_mapping.h"
#include "core/scene/texture_names.h"

namespace hyades::core {
namespace {

/// make(a, b, mapping) of the two colours of `desc`.
template <class Kind, class Make>
Result<TexturePtr> between_colors(const Kind& desc, Appearance& looks, const Make& make) {
  const auto a = looks.color_texture(desc.a);
  if (!a) return a.error();
  const auto b = looks.color_texture(desc.b);
  if (!b) return b.error();
  return make_mapped(
      desc, Kind::kTraits.on_uv, looks,
      [&](const MappingDesc& mapping) -> Result<TexturePtr> { return make(*a, *b, mapping); });
}

template <class Kind>
Result<TexturePtr> between_colors(const Kind& desc, Appearance& looks, const PatternPtr& pattern) {
  return between_colors(desc, looks, [&](auto& a, auto& b, const MappingDesc& mapping) {
    return make_pattern_texture(a, b, pattern, mapping);
  });
}

std::optional<float> at(const Animated<float>& value, const JobTime& time) {
  return value.at(time);
}
std::optional<float> at(const std::optional<Animated<float>>& value, const JobTime& time) {
  return value ? at(*value, time) : std::nullopt;
}

template <class Noise>
FractalDesc fractal_of(const Noise& desc, const JobTime& time) {
  FractalDesc fractal{desc.octaves, desc.lacunarity.at(time), desc.gain.at(time), {}};
  if constexpr (requires { desc.time; }) fractal.time = at(desc.time, time);
  return fractal;
}

template <class Noise>
Result<TexturePtr> make_fractal(FractalKind kind, const Noise& desc, Appearance& looks) {
  return between_colors(desc, looks, make_fractal_pattern(kind, fractal_of(desc, looks.time())));
}

template <class Lines>
Result<TexturePtr> make_lines(bool grid, const Lines& desc, Appearance& looks) {
  const JobTime& time = looks.time();
  return between_colors(desc, looks,
                        make_line_pattern(grid, desc.width.at(time), desc.softness.at(time)));
}

}  // namespace

Result<TexturePtr> make_texture(const textures::Checker& desc, Appearance& looks) {
  return between_colors(desc, looks, make_checker_texture);
}

Result<TexturePtr> make_texture(const textures::Brick& desc, Appearance& looks) {
  const JobTime& time = looks.time();
  return between_colors(
      desc, looks,
      make_brick_pattern(desc.mortar.at(time), desc.shift.at(time), desc.softness.at(time)));
}

Result<TexturePtr> make_texture(const textures::Stripes& desc, Appearance& looks) {
  return make_lines(false, desc, looks);
}

Result<TexturePtr> make_texture(const textures::Grid& desc, Appearance& looks) {
  return make_lines(true, desc, looks);
}

Result<TexturePtr> make_texture(const textures::Gradient& desc, Appearance& looks) {
  const auto shape = look_up(kGradientShapes, desc.shape, "shape of gradients");
  if (!shape) return shape.error();
  return between_colors(desc, looks, make_gradient_pattern((*shape)->value));
}

Result<TexturePtr> make_texture(const textures::Perlin3d& desc, Appearance& looks) {
  return make_fractal(FractalKind::fbm, desc, looks);
}

Result<TexturePtr> make_texture(const textures::Perlin4d& desc, Appearance& looks) {
  return make_fractal(FractalKind::fbm, desc, looks);
}

Result<TexturePtr> make_texture(const textures::Fbm3d& desc, Appearance& looks) {
  return make_fractal(FractalKind::fbm, desc, looks);
}

Result<TexturePtr> make_texture(const textures::Fbm4d& desc, Appearance& looks) {
  return make_fractal(FractalKind::fbm, desc, looks);
}

Result<TexturePtr> make_texture(const textures::Turbulence& desc, Appearance& looks) {
  return make_fractal(FractalKind::turbulence, desc, looks);
}

Result<TexturePtr> make_texture(const textures::Ridged& desc, Appearance& looks) {
  return make_fractal(FractalKind::ridged, desc, looks);
}

Result<TexturePtr> make_texture(const textures::Marble& desc, Appearance& looks) {
  const JobTime& time = looks.time();
  return between_colors(desc, looks,
                        make_marble_pattern(fractal_of(desc, time), desc.distortion.at(time)));
}

Result<TexturePtr> make_texture(const textures::Wood& desc, Appearance& looks) {
  const JobTime& time = looks.time();
  return between_colors(desc, looks,
                        make_wood_pattern(fractal_of(desc, time), desc.distortion.at(time)));
}

Result<TexturePtr> make_texture(const textures::Cellular& desc, Appearance& looks) {
  const auto metric = look_up(kCellMetrics, desc.metric, "metric");
  if (!metric) return metric.error();
  const auto feature = look_up(kCellFeatures, desc.feature, "feature of cells");
  if (!feature) return feature.error();
  const JobTime& time = looks.time();
  return between_colors(desc, looks,
                        make_cellular_pattern({(*metric)->value, (*feature)->value,
                                               desc.jitter.at(time), at(desc.time, time)}));
}

}  // namespace hyades::core
