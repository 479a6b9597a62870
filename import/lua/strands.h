#pragma once

#include "core/geometry/curve_set.h"
#include "import/lua/lua_api.h"

namespace hyades::core::lua {

/// The strands of the list at `at` of the stack: each a table with `points`, a list of [x, y, z],
/// `width`, a number or {at the root, at the tip}, and perhaps `color` {r, g, b}, of all or none.
/// Raises Lua's error, which names the strand: other keys, what is no number, fewer than two points
/// or too many, widths below 0, more points than there is memory for.
StrandList read_strands(lua_State* state, int at);

}  // namespace hyades::core::lua
