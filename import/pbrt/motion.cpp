#include "import/pbrt/motion.h"

#include <algorithm>
#include <array>
#include <glm/gtc/quaternion.hpp>
#include <utility>
#include <vector>

#include "import/pbrt/transforms.h"

namespace hyades::core::pbrt {
namespace {

template <class Things>
bool any_moves(const Things& things) {
  return std::any_of(things.begin(), things.end(),
                     [](const auto& thing) { return thing.to_world.moves(); });
}

YamlPtr keys(YamlPtr at_open, YamlPtr at_close) {
  return YamlMap{{"keys", YamlMap{{"1", std::move(at_open)}, {"2", std::move(at_close)}}.node()}}
      .node();
}

YamlPtr quaternion_node(const glm::dquat& q) {
  const std::array<float, 4> numbers{static_cast<float>(q.x), static_cast<float>(q.y),
                                     static_cast<float>(q.z), static_cast<float>(q.w)};
  return yaml_numbers(numbers);
}

}  // namespace

Shutter shutter_of(Context& context) {
  Report unheard;
  const Entity& camera = context.scene.camera;
  ParameterReader reader(camera.parameters, camera.place, unheard);
  Shutter out;
  out.open = static_cast<double>(reader.number("shutteropen", 0.0F));
  out.close = static_cast<double>(reader.number("shutterclose", 1.0F));
  return out;
}

bool scene_moves(const ParsedScene& scene) {
  return scene.camera.to_world.moves() || any_moves(scene.shapes) || any_moves(scene.instances) ||
         std::any_of(scene.objects.begin(), scene.objects.end(),
                     [](const ObjectDefinition& object) { return any_moves(object.shapes); });
}

Mat4d at_shutter(Context& context, const Motion& motion, double u) {
  if (!motion.moves()) return motion.at[0];
  const Shutter shutter = shutter_of(context);
  const double time = shutter.open + u * (shutter.close - shutter.open);
  const double span = context.scene.end_time - context.scene.start_time;
  return between(motion.at[0], motion.at[1],
                 std::clamp((time - context.scene.start_time) / span, 0.0, 1.0));
}

YamlPtr motion_node(Context& context, const Motion& motion, const Mat4d& before, const Place& place,
                    bool in_group) {
  const Mat4d outer = in_group ? Mat4d(1.0) : context.to_job;
  const Mat4d open = outer * at_shutter(context, motion, 0.0);
  if (!motion.moves()) return transform_node(open * before);
  const Mat4d close = outer * at_shutter(context, motion, 1.0);
  const Parts from = parts_of(open);
  const Parts to = parts_of(close);
  double change = 0.0;
  for (int c = 0; c < 3; ++c) change += glm::length(from.stretch[c] - to.stretch[c]);
  if (change > 1e-6) {
    context.report.note(place, "the shape keeps its size while the shutter is open");
  }
  std::vector<YamlPtr> steps;
  if (const YamlPtr still = transform_node(Mat4d(from.stretch) * before)) steps = still->list;
  glm::dquat turn = to.rotation;
  if (glm::dot(from.rotation, turn) < 0.0) turn = -turn;
  steps.push_back(YamlMap{
      {"rotate",
       YamlMap{{"quaternion", keys(quaternion_node(from.rotation), quaternion_node(turn))}}.node()}}
                      .node());
  steps.push_back(YamlMap{
      {"translate", keys(yaml_vector(Vec3(from.translation)), yaml_vector(Vec3(to.translation)))}}
                      .node());
  return yaml_list(std::move(steps));
}

}  // namespace hyades::core::pbrt
