#pragma once

#include <string>
#include <vector>

#include "core/job/job.h"
#include "core/job/read_context.h"

namespace hyades::core {

/// Complains about textures that hand a colour brighter than 1 to a material where colours are
/// shares of light: colours of 0 to 255, mostly. Arithmetic in between may have its reasons; what
/// is made by it is not looked at.
void check_texture_colors(ReadContext& context);

/// What is likely no radiance among the colours of what gives light, as these may be as bright as
/// they like: numbers of bytes, and temperatures without their K. A line each.
std::vector<std::string> doubtful_light_colors(const Job& job);

}  // namespace hyades::core
