#include <array>

#include "core/job/kinds.h"
#include "core/job/read_sections.h"

namespace hyades::core {

namespace {

void read_point(MapReader& reader, LightDesc& light) {
  reader.animated("at", light.at, kAnyNumber);
  reader.color("color", light.color, kNotNegative);
  reader.animated("power", light.power, kNotNegative);
}

void read_spot(MapReader& reader, LightDesc& light) {
  light.angle = Animated<float>(30.0F);
  read_point(reader, light);
  reader.animated("look_at", light.look_at, kAnyNumber);
  reader.keep_apart("at", light.at, "look_at", light.look_at);
  reader.animated("angle", light.angle, {0.0, 90.0, true});
  reader.animated("blend", light.blend, kUnitInterval);
}

void read_sun(MapReader& reader, LightDesc& light) {
  reader.direction("direction", light.direction);
  reader.color("color", light.color, kNotNegative);
  reader.animated("irradiance", light.irradiance, kNotNegative);
  reader.animated("angle", light.angle, {0.0, 90.0});
}

const std::array<TypeRow<LightDesc>, 3> kTypes = {{
    {"point", read_point},
    {"spot", read_spot},
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
               if (!read_by_type<LightDesc>(reader, "type", "lights", light, kTypes)) return;
               reader.finish();
               top.context().job.lights.push_back(std::move(light));
             });
}

void read_environment(MapReader& top, Job& job) {
  top.map("environment", "environment", [&](MapReader& reader) {
    EnvironmentDesc environment;
    environment.where = reader.where();
    reader.file("image", environment.image);
    reader.color("color", environment.color, kNotNegative);
    reader.animated("rotate_y", environment.rotate_y, kAnyNumber);
    reader.animated("strength", environment.strength, kNotNegative);
    reader.flag("visible_to_camera", environment.visible_to_camera);
    job.environment = environment;
  });
}

}  // namespace hyades::core
