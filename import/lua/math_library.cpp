#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/base/elementary.h"
#include "import/lua/libraries.h"

namespace hyades::core::lua {

namespace {

/// Functions with the same bits on every machine, from single precision: that is what pictures are
/// computed in.
template <float (*function)(float)>
int of_one(lua_State* state) {
  lua_pushnumber(state, function(static_cast<float>(luaL_checknumber(state, 1))));
  return 1;
}

int atan(lua_State* state) {
  const auto y = static_cast<float>(luaL_checknumber(state, 1));
  const auto x = static_cast<float>(luaL_optnumber(state, 2, 1.0));
  lua_pushnumber(state, core::atan2(y, x));
  return 1;
}

/// log(x), log(x, base).
int logarithm(lua_State* state) {
  const auto x = static_cast<float>(luaL_checknumber(state, 1));
  if (lua_isnoneornil(state, 2)) {
    lua_pushnumber(state, core::log(x));
  } else {
    lua_pushnumber(state,
                   core::log2(x) / core::log2(static_cast<float>(luaL_checknumber(state, 2))));
  }
  return 1;
}

/// x to the power of y. Lua's own `^` is the C library's, which is not the same everywhere.
int power(lua_State* state) {
  const auto x = static_cast<float>(luaL_checknumber(state, 1));
  const auto y = static_cast<float>(luaL_checknumber(state, 2));
  const bool whole = std::floor(y) == y;
  const float size = core::pow(whole ? std::abs(x) : x, y);
  const bool odd = whole && std::fmod(y, 2.0F) != 0.0F;
  lua_pushnumber(state, odd && x < 0.0F ? -size : size);
  return 1;
}

int no_random(lua_State* state) {
  return luaL_error(state,
                    "math.random makes another scene each time, expected a generator of one's own: "
                    "local rnd = random(seed), then rnd(), rnd(n) or rnd(first, last)");
}

constexpr std::array<luaL_Reg, 12> kMathFunctions = {{{"sin", of_one<core::sin>},
                                                      {"cos", of_one<core::cos>},
                                                      {"tan", of_one<core::tan>},
                                                      {"asin", of_one<core::asin>},
                                                      {"acos", of_one<core::acos>},
                                                      {"atan", atan},
                                                      {"exp", of_one<core::exp>},
                                                      {"log", logarithm},
                                                      {"pow", power},
                                                      {"random", no_random},
                                                      {"randomseed", no_random},
                                                      {nullptr, nullptr}}};

}  // namespace

void open_math(lua_State* state) {
  luaL_requiref(state, LUA_MATHLIBNAME, luaopen_math, 1);
  luaL_setfuncs(state, kMathFunctions.data(), 0);
  lua_pop(state, 1);
}

}  // namespace hyades::core::lua
