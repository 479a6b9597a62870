#pragma once

#include "import/lua/lua_api.h"

namespace hyades::core::lua {

/// `pairs(table)`: goes through numbers by size, then texts by their bytes, then false and true,
/// then tables and functions by age, which is the same order in every run. Keys that are added
/// meanwhile are not visited, those that are removed neither.
int ordered_pairs(lua_State* state);

/// `next(table, key)`: the first key in that order after `key`, and its value.
int ordered_next(lua_State* state);

}  // namespace hyades::core::lua
