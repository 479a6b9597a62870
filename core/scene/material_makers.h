#pragma once

#include "core/base/result.h"
#include "core/scene/appearance.h"

namespace hyades::core {

/// The material that `desc` describes at the moment of `looks`, which gives what it refers to;
/// without its bump.
Result<MaterialPtr> make_material(const MaterialDesc& desc, Appearance& looks);

}  // namespace hyades::core
