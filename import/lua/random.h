#pragma once

#include "import/lua/lua_api.h"

namespace hyades::core::lua {

/// `random(seed)`: a function of its own random numbers, the same for the same whole number `seed`
/// everywhere (PCG32, O'Neill 2014, "PCG: A Family of Simple Fast Space-Efficient Statistically
/// Good Algorithms for Random Number Generation"). Called without arguments it gives a number >= 0
/// and < 1, with one a whole number from 1 to that, with two one from the first to the second.
int make_random(lua_State* state);

}  // namespace hyades::core::lua
