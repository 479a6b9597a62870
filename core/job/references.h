#pragma once

#include <string>
#include <vector>

#include "core/job/fields.h"
#include "core/job/light_desc.h"
#include "core/job/material_desc.h"
#include "core/job/medium_desc.h"

namespace hyades::core {

/// The names of things of `kind` that a material itself refers to, in the order of its keys, as
/// often as it does.
std::vector<std::string> names_in(const MaterialDesc& material, NameKind kind);

/// The files that something names, in the order of its keys.
std::vector<std::string> files_in(const LightDesc& light);
std::vector<std::string> files_in(const MediumDesc& medium);

}  // namespace hyades::core
