#include <array>
#include <cstddef>
#include <string>

#include "import/pbrt/directives.h"
#include "import/pbrt/transforms.h"

namespace hyades::core::pbrt {

Status Directives::set(const Mat4d& m) {
  if (!is_placement(m)) {
    return error(
        "this makes a transform that cannot be undone, or one of perspective; expected one that "
        "moves, turns and stretches");
  }
  for (size_t i = 0; i < 2; ++i) {
    if (state_.active[i]) state_.to_world.at[i] = m;
  }
  return {};
}

Status Directives::multiply(const Mat4d& m) {
  for (size_t i = 0; i < 2; ++i) {
    if (!state_.active[i]) continue;
    const Mat4d product = state_.to_world.at[i] * m;
    if (!is_placement(product)) {
      return error(
          "this makes a transform that cannot be undone, or one of perspective; expected one that "
          "moves, turns and stretches");
    }
    state_.to_world.at[i] = product;
  }
  return {};
}

Status Directives::identity() { return set(Mat4d(1.0)); }

Status Directives::translate() {
  Vec3d by;
  if (Status s = take_numbers(&by.x, 3); !s) return s;
  return multiply(translation(by));
}

Status Directives::scale() {
  Vec3d by;
  if (Status s = take_numbers(&by.x, 3); !s) return s;
  return multiply(scaling(by));
}

Status Directives::rotate() {
  std::array<double, 4> n{};
  if (Status s = take_numbers(n.data(), 4); !s) return s;
  const Vec3d axis(n[1], n[2], n[3]);
  if (!(glm::dot(axis, axis) > 0.0)) return error("the axis is 0 0 0, expected a direction");
  return multiply(rotation(n[0], axis));
}

Status Directives::look_at_directive() {
  std::array<double, 9> n{};
  if (Status s = take_numbers(n.data(), 9); !s) return s;
  const auto m = look_at({n[0], n[1], n[2]}, {n[3], n[4], n[5]}, {n[6], n[7], n[8]});
  if (!m)
    return error("eye, point and up say no direction: two are equal, or up is along the view");
  return multiply(*m);
}

Status Directives::transform() {
  std::array<double, 16> n{};
  if (Status s = take_numbers(n.data(), 16); !s) return s;
  return set(from_columns(n.data()));
}

Status Directives::concat_transform() {
  std::array<double, 16> n{};
  if (Status s = take_numbers(n.data(), 16); !s) return s;
  return multiply(from_columns(n.data()));
}

Status Directives::coordinate_system() {
  std::string name;
  if (Status s = take_text(name, "a name"); !s) return s;
  coordinate_systems_[name] = state_.to_world;
  return {};
}

Status Directives::coord_sys_transform() {
  std::string name;
  if (Status s = take_text(name, "a name"); !s) return s;
  const auto found = coordinate_systems_.find(name);
  if (found == coordinate_systems_.end()) {
    return error("there is no coordinate system '" + name + "'");
  }
  state_.to_world = found->second;
  return {};
}

Status Directives::active_transform() {
  const Token token = tokens_->next();
  if (token.text == "All") {
    state_.active = {true, true};
  } else if (token.text == "StartTime") {
    state_.active = {true, false};
  } else if (token.text == "EndTime") {
    state_.active = {false, true};
  } else {
    return unexpected(token, "All, StartTime or EndTime");
  }
  return {};
}

Status Directives::transform_times() {
  if (Status s = only_before_world(); !s) return s;
  std::array<double, 2> n{};
  if (Status s = take_numbers(n.data(), 2); !s) return s;
  if (!(n[0] < n[1])) return error("the end is not after the start");
  scene_.start_time = n[0];
  scene_.end_time = n[1];
  return {};
}

}  // namespace hyades::core::pbrt
