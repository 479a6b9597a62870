#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

#include "core/base/text.h"
#include "core/job/read_sections.h"
#include "core/job/read_values.h"

namespace hyades::core {

namespace {

void read_matrix(MapReader& reader, std::string_view key, Mat4& matrix) {
  std::array<float, 16> rows{};
  for (size_t i = 0; i < 16; i += 5) rows[i] = 1.0F;
  if (!reader.numbers(key, rows, kAnyNumber)) return;
  if (rows[12] != 0.0F || rows[13] != 0.0F || rows[14] != 0.0F || rows[15] != 1.0F) {
    reader.complain(reader.where_of(key),
                    "matrix has another last row than 0, 0, 0, 1 (16 numbers, row by row)");
    return;
  }
  for (int r = 0; r < 4; ++r) {
    for (int c = 0; c < 4; ++c) matrix[c][r] = rows[static_cast<size_t>(4 * r + c)];
  }
}

/// rotate: {axis: [x, y, z], angle: degrees} or {quaternion: [x, y, z, w]}
void read_rotation(MapReader& reader, TransformStep& step) {
  const YamlNode* node = reader.find("rotate");
  if (node != nullptr && node->kind == YamlNode::Kind::list) {
    reader.complain(node->where,
                    "rotate is a list, expected {axis: [x, y, z], angle: degrees}; turns about x, "
                    "y and z are steps of their own: {rotate_y: 90}");
    return;
  }
  reader.map("rotate", "transform.rotate", [&](MapReader& map) {
    if (map.node().find("quaternion") != nullptr) {
      step.kind = TransformStep::Kind::quaternion;
      for (const char* key : {"axis", "angle"}) {
        if (!map.has(key)) continue;
        map.complain(map.where_of(key),
                     fmt::format("rotate has both quaternion and {}, expected quaternion, or axis "
                                 "and angle",
                                 key));
      }
    } else {
      map.require("axis", "[x, y, z]");
      map.require("angle", "degrees");
    }
    map.direction("axis", step.vector);
    map.animated("angle", step.angle, kAnyNumber);
    map.enter_section("transform.rotate.quaternion");
    map.rotation("quaternion", step.quaternion);
  });
}

const std::array<std::string, 7> kSteps = {"translate", "scale",  "rotate_x", "rotate_y",
                                           "rotate_z",  "rotate", "matrix"};

void read_step(MapReader& reader, const std::string& name, TransformStep& step) {
  using Kind = TransformStep::Kind;
  if (name == "translate") {
    step.kind = Kind::translate;
    reader.animated(name, step.vector, kAnyNumber);
  } else if (name == "scale") {
    step.kind = Kind::scale;
    step.vector = Animated<Vec3>(Vec3(1.0F));
    reader.animated_scale(name, step.vector, kAnyNumber);
  } else if (name == "rotate") {
    step.kind = Kind::rotate;
    read_rotation(reader, step);
  } else if (name == "matrix") {
    step.kind = Kind::matrix;
    read_matrix(reader, name, step.matrix);
  } else {
    step.kind = name == "rotate_x"   ? Kind::rotate_x
                : name == "rotate_y" ? Kind::rotate_y
                                     : Kind::rotate_z;
    reader.animated(name, step.angle, kAnyNumber);
  }
}

void read_list(MapReader& reader, const YamlNode& list, TransformList& steps) {
  if (!reader.context().spend(list.list.size(), list.where)) return;
  size_t place = 0;
  for (const YamlPtr& item : list.list) {
    const bool one_key = item->kind == YamlNode::Kind::map && item->map.size() == 1;
    if (!one_key) {
      const std::string found = item->kind == YamlNode::Kind::map
                                    ? fmt::format("has {} keys", item->map.size())
                                    : "is " + describe(*item);
      reader.complain(item->where, fmt::format("a transform step {}, expected one key of {}", found,
                                               join_names(kSteps)));
      continue;
    }
    MapReader step_reader(reader.context(), *item, "a transform step",
                          fmt::format("{}.transform[{}]", reader.path(), place++), "transform");
    const std::string& name = item->map.front().key;
    for (const std::string& known : kSteps) {
      if (known != name) step_reader.find(known);
    }
    if (std::find(kSteps.begin(), kSteps.end(), name) != kSteps.end()) {
      TransformStep step;
      read_step(step_reader, name, step);
      steps.push_back(std::move(step));
    }
    step_reader.finish();
  }
}

}  // namespace

void MapReader::place(TransformList& steps, Animated<Vec3>& at) {
  context_.in_shutter = true;
  animated("at", at, kAnyNumber.in("length"));
  transform("transform", steps);
  context_.in_shutter = false;
}

void MapReader::transform(std::string_view key, TransformList& target) {
  if (listing()) tell(key, {.takes = "list of steps", .below = "transform"});
  const YamlNode* node = find(key);
  if (listing()) {
    MapReader step_reader(context_, empty_map(), "", "", "transform");
    TransformStep step;
    for (const std::string& name : kSteps) read_step(step_reader, name, step);
    return;
  }
  if (node == nullptr) return;
  if (node->kind == YamlNode::Kind::list) {
    read_list(*this, *node, target);
  } else {
    mismatch(key, *node, "a list of steps, such as [{scale: 2}, {rotate_y: 45}]");
  }
}

}  // namespace hyades::core
