#pragma once

#include <vector>

#include "core/scene/flatten.h"
#include "core/scene/scene.h"

namespace hyades::core {

/// Checks what objects say of their outside (`exterior`) at some points around each: outside of all
/// bodies it is the atmosphere, within another body what fills that. `scene` has its world and its
/// bodies. Errors name the object and what is there instead.
Status check_exteriors(const Job& job, const std::vector<FlatObject>& objects, const Scene& scene);

}  // namespace hyades::core
