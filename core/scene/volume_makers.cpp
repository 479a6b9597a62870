#include "core/scene/volume_makers.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "core/job/frame_files.h"
#include "core/media/noise_density.h"
#include "core/media/shell_field.h"
#include "core/scene/name_table.h"
#include "core/scene/transforms.h"

namespace hyades::core {
namespace {

/// Of procedural densities, along the longest side: bounds of noise are narrow only over boxes well
/// below its own cells, and take their time.
constexpr int kProceduralCells = 32;

enum class VdbPlace { fit, native };
constexpr std::array<NameRow<VdbPlace>, 2> kVdbPlaces = {{
    {"fit", VdbPlace::fit},
    {"native", VdbPlace::native},
}};

PlacedVolume in_body(Volume volume) {
  const Vec3i cells = MajorantGrid::cells_for(volume.density->bounds(), kProceduralCells);
  volume.majorants = std::make_shared<const MajorantGrid>(*volume.density, cells);
  return {std::make_shared<const Volume>(std::move(volume))};
}

PlacedVolume make_noise(const NoiseDensityDesc& desc, const JobTime& time, const Bounds& body) {
  NoiseDensity noise;
  noise.scale = desc.scale.at(time);
  noise.offset = desc.offset.at(time);
  noise.octaves = desc.octaves;
  noise.lacunarity = desc.lacunarity.at(time);
  noise.gain = desc.gain.at(time);
  noise.time = desc.time.at(time);
  noise.low = desc.low.at(time);
  noise.high = desc.high.at(time);
  noise.fade = desc.fade.at(time);
  return in_body({make_noise_density(noise, body), nullptr, nullptr, nullptr});
}

Result<PlacedVolume> make_image_shell(const MediumDesc& medium, const JobTime& time,
                                      SceneCache& cache) {
  const ShellDensityDesc& desc = *medium.varying->shell;
  auto image = cache.image(desc.image, ColorSpace::automatic);
  if (!image) return image.error();
  Shell shell;
  shell.image = *image;
  shell.inner = desc.inner.at(time);
  shell.outer = desc.outer.at(time);
  if (shell.inner >= shell.outer) {
    return Error{
        fmt::format("its shell has an inner radius of {:.6g} at this frame, which is not "
                    "below the outer one of {:.6g}",
                    shell.inner, shell.outer)};
  }
  shell.turn = desc.rotate_y.at(time) / 360.0F;
  shell.low = desc.low.at(time);
  shell.high = desc.high.at(time);
  shell.swirl = desc.swirl.at(time);
  shell.scale = desc.scale.at(time);
  shell.octaves = desc.octaves;
  shell.time = desc.time.at(time);
  const ShellFields fields = make_shell(shell);
  return in_body({fields.density, nullptr, desc.tint ? fields.tint : nullptr, fields.glow});
}

/// Moves `box` to the middle of `body`, as large as fits.
Mat4 fitted(const Bounds& box, const Bounds& body) {
  float scale = kInfinity;
  for (int a = 0; a < 3; ++a) {
    if (box.size()[a] > 0.0F) scale = std::min(scale, body.size()[a] / box.size()[a]);
  }
  if (scale == kInfinity) scale = 1.0F;
  Mat4 m(scale);
  m[3] = Vec4(body.center() - scale * box.center(), 1.0F);
  return m;
}

VdbUse use_of(const DensityDesc& desc, const std::string& grid, const JobTime& time) {
  return {frame_file_at(desc.vdb, time), grid, is_file_sequence(desc.vdb)};
}

Result<std::shared_ptr<const ColorField>> make_glow(const MediumDesc& desc, const JobTime& time,
                                                    const Mat4& to_file, SceneCache& cache) {
  GridGlow glow;
  glow.kelvin = desc.emission->kelvin.at(time);
  const auto add = [&](const std::string& name, std::shared_ptr<const BrickGrid<float>>& voxels,
                       Mat4& to_grid) -> Status {
    if (name.empty()) return {};
    auto grid = cache.vdb_numbers(use_of(*desc.varying, name, time));
    if (!grid) return grid.error();
    voxels = {*grid, &(*grid)->voxels};
    to_grid = glm::inverse((*grid)->to_file) * to_file;
    return {};
  };
  if (auto done = add(desc.emission->grid, glow.factor, glow.to_factor); !done) return done.error();
  if (auto done = add(desc.emission->temperature, glow.temperature, glow.to_temperature); !done)
    return done.error();
  return make_grid_glow(glow);
}

Result<PlacedVolume> make_vdb(const MediumDesc& medium, const JobTime& time, const Bounds& body,
                              SceneCache& cache) {
  const DensityDesc& desc = *medium.varying;
  const auto place = look_up(kVdbPlaces, desc.place, "place of a vdb");
  if (!place) return place.error();
  auto density = cache.vdb_density(use_of(desc, desc.grid, time));
  if (!density) return density.error();
  const Mat4& to_file = (*density)->grid->to_file;
  // The field keeps the density, so that other bodies of this frame find it.
  Volume volume{{*density, (*density)->field.get()}, (*density)->majorants, nullptr, nullptr};
  if (!desc.tint.empty()) {
    auto tint = cache.vdb_colors(use_of(desc, desc.tint, time));
    if (!tint) return tint.error();
    volume.tint =
        make_grid_color({*tint, &(*tint)->voxels}, glm::inverse((*tint)->to_file) * to_file);
  }
  if (medium.emission && medium.emission->has_grids()) {
    auto glow = make_glow(medium, time, to_file, cache);
    if (!glow) return glow.error();
    volume.glow = *glow;
  }
  const Mat4 placed = (*place)->value == VdbPlace::native
                          ? Mat4(1.0F)
                          : fitted(transformed(to_file, volume.density->bounds()), body);
  return PlacedVolume{std::make_shared<const Volume>(std::move(volume)),
                      transform_at(desc.transform, desc.at, time) * placed * to_file};
}

}  // namespace

Result<PlacedVolume> make_volume(const MediumDesc& desc, const JobTime& time, const Bounds& body,
                                 SceneCache& cache) {
  if (desc.varying->noise) return make_noise(*desc.varying->noise, time, body);
  if (desc.varying->shell) return make_image_shell(desc, time, cache);
  return make_vdb(desc, time, body, cache);
}

std::vector<std::string> made_vdb_places() { return names_of(kVdbPlaces); }

}  // namespace hyades::core
