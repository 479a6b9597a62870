#pragma once

#include <string>
#include <vector>

#include "core/job/material_desc.h"

namespace hyades::core {

/// The names of all textures that a material itself refers to, in no order that matters.
std::vector<std::string> textures_of(const MaterialDesc& material);

}  // namespace hyades::core
