#include "core/scene/camera_makers.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/base/elementary.h"
#include "core/cameras/make_camera.h"
#include "core/scene/transforms.h"

namespace hyades::core {
namespace {

/// m, the short side of a 35 mm frame: what f-stops refer to.
constexpr float kSensorHeight = 0.024F;

std::unique_ptr<Camera> make_of_type(const Job& job, std::vector<CameraPose> poses,
                                     ApertureShape aperture) {
  const Vec2i resolution(job.film.width, job.film.height);
  if (job.camera.type == "equirectangular")
    return make_equirectangular_camera(std::move(poses), resolution);
  const auto make =
      job.camera.type == "orthographic" ? make_orthographic_camera : make_perspective_camera;
  return make(std::move(poses), resolution, aperture);
}

/// Where the camera is and what it sees.
CameraPose view_at(const Job& job, const JobTime& time) {
  const CameraDesc& camera = job.camera;
  CameraPose pose;
  pose.from = camera.look_from.at(time) * job.units;
  pose.at = camera.look_at.at(time) * job.units;
  pose.up = camera.up.at(time);
  pose.fov = camera.fov.at(time) * kRadians;
  pose.shift = camera.shift.at(time);
  pose.height = camera.height.at(time) * job.units;
  return pose;
}

Error focus_behind(const Job& job, const JobTime& time, float distance) {
  const std::string message = fmt::format(
      "focus is on the object '{}', whose centre lies {:.4g} m behind the camera at frame "
      "{:.10g}, "
      "expected one in front of it",
      job.camera.focus_object, -distance, time.frame);
  return {Diagnostic{job.camera.focus_where, message}.to_string()};
}

Result<CameraPose> pose_at(const Job& job, int32_t frame, float shutter_time,
                           const CenterOf& center_of) {
  const CameraDesc& camera = job.camera;
  const JobTime time = job.time_of(frame, shutter_time);
  CameraPose pose = view_at(job, time);
  Vec3 axis = pose.at - pose.from;
  const float length = std::sqrt(glm::dot(axis, axis));
  axis = length > 0.0F ? axis / length : Vec3(0.0F, 0.0F, -1.0F);
  if (!camera.focus_object.empty()) {
    pose.focus_distance = glm::dot(center_of(camera.focus_object, shutter_time) - pose.from, axis);
    if (!(pose.focus_distance > 0.0F)) return focus_behind(job, time, pose.focus_distance);
  } else if (camera.focus_distance) {
    pose.focus_distance = camera.focus_distance->at(time) * job.units;
  } else {
    pose.focus_distance = glm::dot(pose.at - pose.from, axis);
  }
  pose.focus_distance = std::max(pose.focus_distance, 1e-6F * job.units);
  if (camera.aperture.f_stop) {
    const float focal_length = 0.5F * kSensorHeight / tan(0.5F * pose.fov);
    pose.lens_radius = focal_length / (2.0F * camera.aperture.f_stop->at(time));
  } else {
    pose.lens_radius = camera.aperture.radius.at(time) * job.units;
  }
  return pose;
}

}  // namespace

Result<std::unique_ptr<Camera>> make_camera(const Job& job, int32_t frame,
                                            const CenterOf& center_of) {
  const bool moves = job.frames.shutter > 0.0F;
  const int steps = moves ? kShutterMoments - 1 : 0;
  std::vector<CameraPose> poses;
  for (int i = 0; i <= steps; ++i) {
    const float shutter_time = moves ? static_cast<float>(i) / static_cast<float>(steps) : 0.0F;
    auto pose = pose_at(job, frame, shutter_time, center_of);
    if (!pose) return pose.error();
    poses.push_back(*pose);
  }
  const float rotation = job.camera.aperture.rotation.at(job.time_of(frame));
  return make_of_type(job, std::move(poses), {job.camera.aperture.blades, rotation * kRadians});
}

std::unique_ptr<Camera> make_sharp_camera(const Job& job, const JobTime& time) {
  return make_of_type(job, {view_at(job, time)}, {});
}

}  // namespace hyades::core
