#include "core/integrators/path_in_words.h"

#include <fmt/format.h>

namespace hyades::core {
namespace {

std::string place_of(const Scene& scene, const PathVertex& v) {
  switch (v.kind) {
    case PathVertex::Kind::lens:
      return "begins at the lens at " + in_words(v.position);
    case PathVertex::Kind::light: {
      const std::string begins = "begins at the light '" + scene.light_names[v.light] + "'";
      return v.infinitely_far ? begins : begins + " at " + in_words(v.position);
    }
    case PathVertex::Kind::surface:
      return fmt::format("meets '{}' at {}, carries {}", v.object->name, in_words(v.position),
                         in_words(v.throughput));
    case PathVertex::Kind::medium:
      break;
  }
  return fmt::format("scatters in the medium at {}, carries {}", in_words(v.position),
                     in_words(v.throughput));
}

}  // namespace

std::string in_words(const Vec3& v) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", v.x, v.y, v.z);
}

void tell_subpath(const Scene& scene, const Subpath& path, const std::string& name, PathLog& log) {
  log.lines.push_back(fmt::format("{} of {} vertices", name, path.size()));
  for (int i = 0; i < path.size(); ++i)
    log.lines.push_back(fmt::format("  {}: {}", i + 1, place_of(scene, path[i])));
}

}  // namespace hyades::core
