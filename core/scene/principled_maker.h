#pragma once

#include "core/base/result.h"
#include "core/scene/appearance.h"

namespace hyades::core {

/// The principled material that `desc` describes at the moment of `looks`.
Result<MaterialPtr> principled_material(const PrincipledDesc& desc, Appearance& looks);

}  // namespace hyades::core
