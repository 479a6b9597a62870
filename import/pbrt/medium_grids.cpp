#include "import/pbrt/medium_grids.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>

#include "core/base/color.h"
#include "core/base/parallel.h"
#include "core/base/text.h"
#include "import/pbrt/classic_noise.h"
#include "import/pbrt/hot_spot.h"
#include "import/pbrt/nanovdb_media.h"

namespace hyades::core::pbrt {
namespace {

constexpr double kCloudSide = 128.0;  ///< points along the longest side

/// The box that grids fill in the medium's space.
struct Extent {
  Vec3d low{0.0};
  Vec3d high{1.0};
};

Extent extent_of(ParameterReader& reader) {
  Extent e;
  const Vec3d a = reader.triple("point3", "p0", Vec3d(0.0));
  const Vec3d b = reader.triple("point3", "p1", Vec3d(1.0));
  e.low = glm::min(a, b);
  e.high = glm::max(a, b);
  return e;
}

/// Points at the middles of `size` cells.
VdbBox box_in(const std::string& name, const Extent& e, const Vec3i& size) {
  VdbBox box;
  box.name = name;
  box.size = size;
  box.voxel = (e.high - e.low) / Vec3d(size);
  box.origin = e.low + 0.5 * box.voxel;
  return box;
}

Result<Vec3i> size_of(ParameterReader& reader, size_t values) {
  const Vec3i size(reader.integer("nx", 1), reader.integer("ny", 1), reader.integer("nz", 1));
  const Vec3d sides(size);
  if (glm::min(glm::min(size.x, size.y), size.z) < 1 ||
      glm::max(glm::max(size.x, size.y), size.z) > kMostVdbSide ||
      sides.x * sides.y * sides.z > static_cast<double>(kMostVoxels) ||
      sides.x * sides.y * sides.z != static_cast<double>(values)) {
    return reader.place().error("the grid has " + format_count(values) +
                                " values, which is not nx * ny * nz");
  }
  return size;
}

Result<MediumGrids> uniform_grid(const NamedEntity& medium, ParameterReader& reader,
                                 bool check_only) {
  const auto density = reader.numbers("float", "density");
  if (density.empty()) return medium.place.error("the grid has no values: \"float density\"");
  auto size = size_of(reader, density.size());
  if (!size) return size.error();
  const Extent extent = extent_of(reader);
  MediumGrids out;
  out.boxes.push_back(box_in("density", extent, *size));
  const auto temperature = reader.numbers("float", "temperature");
  const auto glow = reader.numbers("float", "Lescale");
  for (const auto& values : {temperature, glow}) {
    if (values.size() > 1 && values.size() != density.size()) {
      return medium.place.error("the grid has " + format_count(density.size()) + " densities and " +
                                format_count(values.size()) + " temperatures or scales of light");
    }
  }
  const bool has_glow = glow.size() == density.size() && !glow.empty() && density.size() > 1;
  if (has_glow || !temperature.empty()) out.boxes.push_back(box_in("glow", extent, *size));
  if (!temperature.empty()) out.boxes.push_back(box_in("temperature", extent, *size));
  if (check_only) return out;
  out.boxes[0].values.assign(density.begin(), density.end());
  for (float& value : out.boxes[0].values) value = std::max(value, 0.0F);
  if (out.boxes.size() < 2) return out;
  const float offset = reader.number("temperatureoffset", reader.number("temperaturecutoff", 0.0F));
  const float scale = reader.number("temperaturescale", 1.0F);
  for (size_t i = 0; i < density.size(); ++i) {
    float factor = std::max(density[i], 0.0F) * (has_glow ? std::max(glow[i], 0.0F) : 1.0F);
    if (!temperature.empty()) {
      const HotSpot hot = hot_spot((temperature[i] - offset) * scale);
      out.boxes[2].values.push_back(hot.kelvin);
      factor *= hot.factor;
    }
    out.boxes[1].values.push_back(factor);
  }
  return out;
}

/// Jobs have one density for all channels and a colour of what is scattered: exact where the
/// channels' sums of absorption and scattering are equal.
Result<MediumGrids> rgb_grid(const NamedEntity& medium, ParameterReader& reader, bool check_only) {
  const auto absorbed = reader.numbers("rgb", "sigma_a", 3);
  const auto scattered = reader.numbers("rgb", "sigma_s", 3);
  const auto glow = reader.numbers("rgb", "Le", 3);
  const size_t n = std::max(absorbed.size(), scattered.size()) / 3;
  for (const auto& values : {absorbed, scattered, glow}) {
    if (!values.empty() && values.size() != 3 * n) {
      return medium.place.error("the grids have different numbers of values");
    }
  }
  if (n == 0) return medium.place.error("the grid has no values: \"rgb sigma_s\"");
  auto size = size_of(reader, n);
  if (!size) return size.error();
  const Extent extent = extent_of(reader);
  MediumGrids out;
  out.boxes.push_back(box_in("density", extent, *size));
  out.boxes.push_back(box_in("tint", extent, *size));
  out.boxes[1].colors = true;
  if (!glow.empty()) out.boxes.push_back(box_in("glow", extent, *size));
  const auto at = [](std::span<const float> values, size_t i) {
    // What is not given is 1 everywhere.
    if (values.empty()) return Rgb(1.0F);
    return glm::max(Rgb(values[3 * i], values[3 * i + 1], values[3 * i + 2]), Rgb(0.0F));
  };
  if (!glow.empty()) {
    for (size_t i = 0; i < n; ++i) out.glow += at(glow, i) * at(absorbed, i);
    const float mean = luminance(out.glow);
    out.glow = mean > 0.0F ? out.glow / mean : Rgb(0.0F);
  }
  if (check_only) return out;
  for (size_t i = 0; i < n; ++i) {
    const Rgb s = at(scattered, i);
    const Rgb t = s + at(absorbed, i);
    const float density = max_component(t);
    out.boxes[0].values.push_back(density);
    const Rgb tint = density > 0.0F ? s / density : Rgb(0.0F);
    out.boxes[1].values.insert(out.boxes[1].values.end(), {tint.x, tint.y, tint.z});
    if (!glow.empty()) out.boxes[2].values.push_back(luminance(at(glow, i) * at(absorbed, i)));
  }
  return out;
}

/// The density of a procedural cloud: noise whose places are moved by noise, thinner with height.
double cloud_density(Vec3d p, double density, double wispiness, double frequency) {
  const double height = p.y;
  p *= frequency;
  if (wispiness > 0.0) {
    double strength = 0.05 * wispiness;
    double scale = 10.0;
    for (int i = 0; i < 2; ++i) {
      constexpr double kStep = 0.01;
      const double here = classic_noise(scale * p);
      const Vec3d slope(classic_noise(scale * p + Vec3d(kStep, 0.0, 0.0)) - here,
                        classic_noise(scale * p + Vec3d(0.0, kStep, 0.0)) - here,
                        classic_noise(scale * p + Vec3d(0.0, 0.0, kStep)) - here);
      p += strength * slope / kStep;
      strength *= 0.5;
      scale *= 1.99;
    }
  }
  double sum = 0.0;
  double weight = 0.5;
  double scale = 1.0;
  for (int i = 0; i < 5; ++i) {
    sum += weight * classic_noise(scale * p);
    weight *= 0.5;
    scale *= 1.99;
  }
  const double body = std::clamp((1.0 - height) * 4.5 * density * sum, 0.0, 1.0);
  return std::clamp(body + 2.0 * std::max(0.0, 0.5 - height), 0.0, 1.0);
}

Result<MediumGrids> cloud(const NamedEntity& medium, ParameterReader& reader, bool check_only) {
  const auto density = static_cast<double>(reader.number("density", 1.0F));
  const auto wispiness = static_cast<double>(reader.number("wispiness", 1.0F));
  const auto frequency = static_cast<double>(reader.number("frequency", 5.0F));
  const Extent extent = extent_of(reader);
  const Vec3d sides = extent.high - extent.low;
  const double longest = glm::max(glm::max(sides.x, sides.y), sides.z);
  if (!(glm::min(glm::min(sides.x, sides.y), sides.z) > 0.0)) {
    return medium.place.error("the cloud's box is empty");
  }
  const Vec3i size = glm::max(Vec3i(glm::ceil(sides * (kCloudSide / longest))), Vec3i(1));
  MediumGrids out;
  out.boxes.push_back(box_in("density", extent, size));
  if (check_only) return out;
  VdbBox& box = out.boxes[0];
  const auto row = static_cast<size_t>(size.x);
  box.values.resize(row * static_cast<size_t>(size.y) * static_cast<size_t>(size.z));
  const Status done = parallel_for(box.values.size() / row, 0, [&](size_t i) {
    for (int x = 0; x < size.x; ++x) {
      const Vec3d p(x, static_cast<int>(i) % size.y, static_cast<int>(i) / size.y);
      box.values[i * row + static_cast<size_t>(x)] = static_cast<float>(
          cloud_density(box.origin + box.voxel * p, density, wispiness, frequency));
    }
  });
  if (!done) return done.error();
  return out;
}

}  // namespace

Result<MediumGrids> medium_grids(Context& context, const NamedEntity& medium, bool check_only) {
  ParameterReader reader = read(context, medium);
  const std::string type = reader.text("type");
  if (type == "nanovdb") return nanovdb_grids(context, medium, check_only);
  const Extent extent = extent_of(reader);
  if (!(extent.low.x < extent.high.x && extent.low.y < extent.high.y &&
        extent.low.z < extent.high.z)) {
    return medium.place.error("the grid's box from p0 to p1 is empty");
  }
  if (type == "uniformgrid") return uniform_grid(medium, reader, check_only);
  if (type == "rgbgrid") return rgb_grid(medium, reader, check_only);
  return cloud(medium, reader, check_only);
}

}  // namespace hyades::core::pbrt
