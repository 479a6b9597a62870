#pragma once

#include <vector>

#include "core/geometry/point_instancer.h"
#include "import/lua/lua_api.h"

namespace hyades::core::lua {

/// The copies of the list at `at` of the stack: each a table with `at` [x, y, z], `scale` (a number
/// or [x, y, z]) and `rotate_x`, `rotate_y`, `rotate_z` [degrees], applied in the order scale, x,
/// y, z, at; all of them may be left out. Raises Lua's error, which names the copy: other keys,
/// what is no number, what is flat or too small, more than a scene may have.
std::vector<PlaceMatrix> read_copies(lua_State* state, int at);

}  // namespace hyades::core::lua
