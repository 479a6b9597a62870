#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/scene/appearance.h"

namespace hyades::core {

/// The material that `desc` describes at the moment of `looks`, which gives what it refers to;
/// without its bump.
Result<MaterialPtr> make_material(const MaterialDesc& desc, Appearance& looks);

/// The types that can be made: those of core/job/kinds.h.
std::vector<std::string> made_material_types();

}  // namespace hyades::core
