#include <array>

#include "core/job/kinds.h"
#include "core/job/light_groups.h"
#include "core/job/read_sections.h"

namespace hyades::core {

namespace {

void read_place_and_power(MapReader& reader, LightDesc& light) {
  reader.animated("at", light.at, kAnyNumber);
  reader.color("color", light.color, kNotNegative);
  reader.animated("power", light.power, kNotNegative);
  read_light_group(reader, light.light_group);
}

void read_aim(MapReader& reader, LightDesc& light) {
  reader.animated("look_at", light.look_at, kAnyNumber);
  reader.keep_apart("at", light.at, "look_at", light.look_at);
}

void read_point(MapReader& reader, LightDesc& light) {
  read_place_and_power(reader, light);
  reader.file("image", light.image);
}

void read_projector(MapReader& reader, LightDesc& light) {
  read_place_and_power(reader, light);
  read_aim(reader, light);
  reader.direction("up", light.up);
  reader.animated("fov", light.fov, {0.0, 180.0, true, true});
  reader.require("image", "the picture that it throws");
  reader.file("image", light.image);
}

void read_spot(MapReader& reader, LightDesc& light) {
  light.angle = Animated<float>(30.0F);
  read_place_and_power(reader, light);
  read_aim(reader, light);
  reader.animated("angle", light.angle, {0.0, 180.0, true});
  reader.animated("blend", light.blend, kUnitInterval);
}

void read_sun(MapReader& reader, LightDesc& light) {
  reader.direction("direction", light.direction);
  reader.color("color", light.color, kNotNegative);
  reader.animated("irradiance", light.irradiance, kNotNegative);
  reader.animated("angle", light.angle, {0.0, 90.0});
  read_light_group(reader, light.light_group);
}

const std::array<TypeRow<LightDesc>, 4> kTypes = {{
    {"point", read_point},
    {"spot", read_spot},
    {"projector", read_projector},
    {"sun", read_sun},
}};

}  // namespace

std::vector<std::string> light_types() { return type_names<LightDesc>(kTypes); }

void read_lights(MapReader& top) {
  read_named(top, "lights", "light", std::nullopt,
             [&](const YamlNode& node, const std::string& name, const std::string& what,
                 const std::string& path) {
               MapReader reader(top.context(), node, what, path, "lights");
               if (node.kind != YamlNode::Kind::map) return;
               LightDesc light;
               light.name = name;
               light.where = node.where;
               reader.find("like");
               read_transform_steps(reader, light.transform);
               if (!read_by_type<LightDesc>(reader, "type", "lights", light, kTypes)) return;
               reader.finish();
               top.context().job.lights.push_back(std::move(light));
             });
}

namespace {

void read_sky(MapReader& reader, EnvironmentDesc& environment) {
  const bool image = reader.has("image");
  reader.map("sky", "environment.sky", [&](MapReader& map) {
    SkyDesc sky;
    map.animated("elevation", sky.elevation, {-90.0, 90.0});
    map.animated("azimuth", sky.azimuth, kAnyNumber);
    if (map.has("sun_direction") || map.listing()) {
      Animated<Vec3> direction(Vec3(0.0F, 1.0F, 0.0F));
      map.direction("sun_direction", direction);
      sky.sun_direction = direction;
      if (map.has("elevation") || map.has("azimuth")) {
        map.complain(map.find("sun_direction")->where,
                     "sky has both sun_direction and elevation or azimuth, expected one of them");
      }
    } else {
      map.find("sun_direction");
    }
    map.animated("turbidity", sky.turbidity, {1.0, 10.0});
    map.color("ground_albedo", sky.ground_albedo, kUnitInterval);
    map.animated("irradiance", sky.irradiance, kNotNegative);
    map.flag("sun", sky.sun);
    map.animated("sun_size", sky.sun_size, {0.0, 90.0});
    environment.sky = sky;
    if (image) {
      map.complain(map.where(), "environment has both sky and image, expected one of them");
    }
  });
}

}  // namespace

void read_environment(MapReader& top, Job& job) {
  top.map("environment", "environment", [&](MapReader& reader) {
    EnvironmentDesc environment;
    environment.where = reader.where();
    reader.file("image", environment.image);
    read_sky(reader, environment);
    reader.color("color", environment.color, kNotNegative);
    reader.animated("rotate_y", environment.rotate_y, kAnyNumber);
    reader.animated("strength", environment.strength, kNotNegative);
    reader.flag("visible_to_camera", environment.visible_to_camera);
    read_light_group(reader, environment.light_group);
    job.environment = environment;
  });
}

}  // namespace hyades::core
