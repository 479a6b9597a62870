#pragma once

#include <vector>

#include "core/scene/appearance.h"
#include "core/scene/flatten.h"
#include "core/scene/scene.h"

namespace hyades::core {

/// Takes what objects say of their outside (`exterior`) at their word, and makes sure that it is
/// so: outside of all bodies it is the atmosphere, and becomes that where the job names none;
/// within another body it must be what fills that. `scene` has its world, its bodies and its
/// atmosphere. Errors name the object and what is there instead.
Status settle_exteriors(const Job& job, const std::vector<FlatObject>& objects, Appearance& looks,
                        Scene& scene);

}  // namespace hyades::core
