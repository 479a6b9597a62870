#include "core/scene/texture_kind_makers.h"
#include "core/scene/texture_mapping.h"
#include "core/scene/texture_names.h"

namespace hyades::core {
namespace {

/// `pattern` between the two colours.
Result<TexturePtr> between_colors(const TextureDesc& desc, Appearance& looks,
                                  MappingSpace preferred, const PatternPtr& pattern) {
  const auto a = looks.color_texture(desc.a);
  if (!a) return a.error();
  const auto b = looks.color_texture(desc.b);
  if (!b) return b.error();
  return make_mapped(desc, looks, preferred, [&](const MappingDesc& mapping) -> Result<TexturePtr> {
    return make_pattern_texture(*a, *b, pattern, mapping);
  });
}

std::optional<float> time_of(const TextureDesc& desc, const Appearance& looks) {
  if (!desc.noise.time) return std::nullopt;
  return desc.noise.time->at(looks.time());
}

FractalDesc fractal_of(const TextureDesc& desc, const Appearance& looks) {
  return {desc.noise.octaves, desc.noise.lacunarity.at(looks.time()),
          desc.noise.gain.at(looks.time()), time_of(desc, looks)};
}

Result<TexturePtr> make_fractal(FractalKind kind, const TextureDesc& desc, Appearance& looks) {
  return between_colors(desc, looks, MappingSpace::object,
                        make_fractal_pattern(kind, fractal_of(desc, looks)));
}

Result<TexturePtr> make_lines(bool grid, const TextureDesc& desc, Appearance& looks) {
  const JobTime& time = looks.time();
  return between_colors(
      desc, looks, MappingSpace::uv,
      make_line_pattern(grid, desc.lines.width.at(time), desc.lines.softness.at(time)));
}

}  // namespace

Result<TexturePtr> make_checker(const TextureDesc& desc, Appearance& looks) {
  const auto a = looks.color_texture(desc.a);
  if (!a) return a.error();
  const auto b = looks.color_texture(desc.b);
  if (!b) return b.error();
  return make_mapped(desc, looks, MappingSpace::uv,
                     [&](const MappingDesc& mapping) -> Result<TexturePtr> {
                       return make_checker_texture(*a, *b, mapping);
                     });
}

Result<TexturePtr> make_brick(const TextureDesc& desc, Appearance& looks) {
  const JobTime& time = looks.time();
  return between_colors(desc, looks, MappingSpace::uv,
                        make_brick_pattern(desc.lines.width.at(time), desc.lines.shift.at(time),
                                           desc.lines.softness.at(time)));
}

Result<TexturePtr> make_stripes(const TextureDesc& desc, Appearance& looks) {
  return make_lines(false, desc, looks);
}

Result<TexturePtr> make_grid(const TextureDesc& desc, Appearance& looks) {
  return make_lines(true, desc, looks);
}

Result<TexturePtr> make_gradient(const TextureDesc& desc, Appearance& looks) {
  const auto shape = look_up(kGradientShapes, desc.shape, "shape of gradients");
  if (!shape) return shape.error();
  return between_colors(desc, looks, MappingSpace::uv, make_gradient_pattern((*shape)->value));
}

Result<TexturePtr> make_fbm(const TextureDesc& desc, Appearance& looks) {
  return make_fractal(FractalKind::fbm, desc, looks);
}

Result<TexturePtr> make_turbulence(const TextureDesc& desc, Appearance& looks) {
  return make_fractal(FractalKind::turbulence, desc, looks);
}

Result<TexturePtr> make_ridged(const TextureDesc& desc, Appearance& looks) {
  return make_fractal(FractalKind::ridged, desc, looks);
}

Result<TexturePtr> make_marble(const TextureDesc& desc, Appearance& looks) {
  const float distortion = desc.noise.distortion.at(looks.time());
  return between_colors(desc, looks, MappingSpace::object,
                        make_marble_pattern(fractal_of(desc, looks), distortion));
}

Result<TexturePtr> make_wood(const TextureDesc& desc, Appearance& looks) {
  const float distortion = desc.noise.distortion.at(looks.time());
  return between_colors(desc, looks, MappingSpace::object,
                        make_wood_pattern(fractal_of(desc, looks), distortion));
}

Result<TexturePtr> make_cellular(const TextureDesc& desc, Appearance& looks) {
  const auto metric = look_up(kCellMetrics, desc.cells.metric, "metric");
  if (!metric) return metric.error();
  const auto feature = look_up(kCellFeatures, desc.cells.feature, "feature of cells");
  if (!feature) return feature.error();
  return between_colors(
      desc, looks, MappingSpace::object,
      make_cellular_pattern({(*metric)->value, (*feature)->value,
                             desc.cells.jitter.at(looks.time()), time_of(desc, looks)}));
}

}  // namespace hyades::core
