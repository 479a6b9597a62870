#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "core/base/result.h"
#include "core/cameras/camera.h"
#include "core/job/job.h"

namespace hyades::core {

/// Where the middle of the object of that name is at a shutter time (0..1), in metres.
using CenterOf = std::function<Vec3(const std::string& object, float shutter_time)>;

/// The camera of `job` while the shutter of `frame` is open. An error where its focus lies behind
/// it.
Result<std::unique_ptr<Camera>> make_camera(const Job& job, int32_t frame,
                                            const CenterOf& center_of);

/// The camera of `job` at one moment, with a lens of no size.
std::unique_ptr<Camera> make_sharp_camera(const Job& job, const JobTime& time);

}  // namespace hyades::core
