#pragma once

#include "core/job/read_context.h"

namespace hyades::core {

/// Complains about two-sided materials of parts that let light through: it would meet another
/// material from either side. For jobs whose materials are made of few others.
void check_two_sided(ReadContext& context);

/// Complains about parts of materials that shine.
void check_emission(ReadContext& context);

/// Makes images that are used as normal maps linear, for they hold numbers and not colours;
/// complains about those that are said to be colours.
void read_normal_maps_as_numbers(ReadContext& context);

}  // namespace hyades::core
