#include "import/pbrt/nanovdb_media.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/base/parallel.h"
#include "core/base/text.h"
#include "core/media/read_nanovdb.h"
#include "import/pbrt/hot_spot.h"

namespace hyades::core::pbrt {
namespace {

using Grid = std::shared_ptr<const VdbGrid<float>>;

/// How temperatures of a grid become kelvin.
struct Scale {
  float offset = 0.0F;
  float factor = 1.0F;
};

/// Density, glow and temperature at the points of the grid of densities.
Result<std::vector<VdbBox>> glowing_boxes(const Grid& density, const Grid& temperature,
                                          const Scale& scale) {
  const Bounds bounds = density->voxels.bounds();
  VdbBox box;
  box.name = "density";
  box.lower = Vec3i(bounds.lower) + 1;
  box.size = Vec3i(bounds.upper) - box.lower;
  box.map = density->to_file;
  const Vec3d sides(box.size);
  if (sides.x * sides.y * sides.z > static_cast<double>(kMostVoxels)) {
    return Error{"the grid spans more points than can be made to glow"};
  }
  const auto row = static_cast<size_t>(box.size.x);
  box.values.resize(row * static_cast<size_t>(box.size.y) * static_cast<size_t>(box.size.z));
  VdbBox glow = box;
  glow.name = "glow";
  VdbBox heat = box;
  heat.name = "temperature";
  const Mat4 to_heat = glm::inverse(temperature->to_file) * density->to_file;
  const Status done = parallel_for(box.values.size() / row, 0, [&](size_t i) {
    for (size_t x = 0; x < row; ++x) {
      const Vec3 p(box.lower + Vec3i(static_cast<int>(x), static_cast<int>(i) % box.size.y,
                                     static_cast<int>(i) / box.size.y));
      const float value = temperature->voxels.at(transform_point(to_heat, p));
      const HotSpot hot = hot_spot((value - scale.offset) * scale.factor);
      const size_t place = i * row + x;
      box.values[place] = density->voxels.at(p);
      heat.values[place] = hot.kelvin;
      glow.values[place] = hot.factor * box.values[place];
    }
  });
  if (!done) return done.error();
  std::vector<VdbBox> boxes;
  boxes.push_back(std::move(box));
  boxes.push_back(std::move(glow));
  boxes.push_back(std::move(heat));
  return boxes;
}

}  // namespace

Result<MediumGrids> nanovdb_grids(Context& context, const NamedEntity& medium, bool check_only) {
  ParameterReader reader = read(context, medium);
  MediumGrids out;
  out.file = reader.text("filename");
  if (out.file.empty()) return medium.place.error("the medium names no file: \"string filename\"");
  const auto bytes = context.loaded.files.find(out.file);
  if (bytes == context.loaded.files.end()) {
    const auto why = context.loaded.missing.find(out.file);
    return medium.place.error(why == context.loaded.missing.end() ? "cannot open '" + out.file + "'"
                                                                  : why->second);
  }
  if (!is_nanovdb(bytes->second)) {
    return medium.place.error(out.file + ": is no file of NanoVDB");
  }
  const auto names = nanovdb_names(bytes->second);
  if (!names) return medium.place.error(out.file + ": " + names.error().message);
  const auto has = [&](const std::string& name) {
    return std::find(names->begin(), names->end(), name) != names->end();
  };
  out.grid = reader.text("gridname", "density");
  if (!has(out.grid)) {
    return medium.place.error(out.file + ": has no grid '" + out.grid + "', expected " +
                              (names->empty() ? "one (there is none)" : join_names(*names)));
  }
  const std::string temperature = reader.text("temperaturename", "temperature");
  if (!has(temperature) || !(reader.number("Lescale", 1.0F) > 0.0F)) return out;
  for (const char* name : {"density", "glow", "temperature"}) {
    out.boxes.emplace_back().name = name;
  }
  const std::string file = std::exchange(out.file, {});
  if (check_only) return out;
  Scale scale;
  scale.offset = reader.number("temperatureoffset", reader.number("temperaturecutoff", 0.0F));
  scale.factor = reader.number("temperaturescale", 1.0F);
  const auto wrong = [&](const Error& error) {
    return medium.place.error(file + ": " + error.message);
  };
  auto density_grid = read_nanovdb_numbers(bytes->second, out.grid);
  if (!density_grid) return wrong(density_grid.error());
  auto temperature_grid = read_nanovdb_numbers(bytes->second, temperature);
  if (!temperature_grid) return wrong(temperature_grid.error());
  auto boxes = glowing_boxes(*density_grid, *temperature_grid, scale);
  if (!boxes) return wrong(boxes.error());
  out.boxes = std::move(*boxes);
  return out;
}

}  // namespace hyades::core::pbrt
