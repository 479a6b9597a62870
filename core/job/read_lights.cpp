#include <optional>
#include <string>
#include <utility>

#include "core/job/read_sections.h"

namespace hyades::core {

void check_keys(MapReader& reader, SkyDesc& /*sky*/) {
  if (!reader.has("sun_direction")) return;
  if (reader.has("elevation") || reader.has("azimuth")) {
    reader.complain(reader.where_of("sun_direction"),
                    "sky has both sun_direction and elevation or azimuth, expected one of them");
  }
}

void check_keys(MapReader& reader, EnvironmentDesc& environment) {
  if (environment.sky && reader.has("image")) {
    reader.complain(reader.where_of("sky"),
                    "environment has both sky and image, expected one of them");
  }
}

void read_lights(MapReader& top) {
  read_named(top, "lights", "light", std::nullopt, [](MapReader& reader, const std::string& name) {
    LightDesc light;
    light.name = name;
    light.where = reader.where();
    if (!read_kind(reader, "lights", light)) return;
    reader.finish();
    reader.context().job.lights.push_back(std::move(light));
  });
}

void read_environment(MapReader& top, Job& job) {
  top.map("environment", "environment", job.environment);
}

}  // namespace hyades::core
