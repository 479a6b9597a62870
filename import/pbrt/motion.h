#pragma once

#include "import/pbrt/context.h"

namespace hyades::core::pbrt {

/// When the camera's shutter is open, in the time of TransformTimes.
struct Shutter {
  double open = 0.0;
  double close = 1.0;
};
Shutter shutter_of(Context& context);

/// Whether anything moves between the two times of its transform.
bool scene_moves(const ParsedScene& scene);

/// What a transform is while the shutter is open, at shutter time u from 0 to 1.
Mat4d at_shutter(Context& context, const Motion& motion, double u);

/// A list of steps for an object: keys at frames 1 and 2, which the shutter goes from and to, where
/// it moves. `before` is applied to the object first, `to_job` after all. Null where it stays.
YamlPtr motion_node(Context& context, const Motion& motion, const Mat4d& before, const Place& place,
                    bool in_group);

}  // namespace hyades::core::pbrt
