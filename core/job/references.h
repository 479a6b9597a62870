#pragma once

#include <string>
#include <vector>

#include "core/job/fields.h"
#include "core/job/light_desc.h"
#include "core/job/material_desc.h"
#include "core/job/medium_desc.h"
#include "core/job/object_desc.h"
#include "core/job/texture_desc.h"

namespace hyades::core {

/// The names of things of `kind` that something itself refers to, in the order of its keys, as
/// often as it does.
std::vector<std::string> names_in(const MaterialDesc& material, NameKind kind);
std::vector<std::string> names_in(const TextureDesc& texture, NameKind kind);

/// The files that something names, in the order of its keys.
std::vector<std::string> files_in(const TextureDesc& texture);
std::vector<std::string> files_in(const LightDesc& light);
std::vector<std::string> files_in(const MediumDesc& medium);
std::vector<std::string> files_in(const ObjectDesc& object);

}  // namespace hyades::core
