#include "import/lua/random.h"

#include <bit>
#include <cstdint>

#include "core/base/hash.h"

namespace hyades::core::lua {

namespace {

struct Pcg32 {
  uint64_t state;

  uint32_t next() {
    const uint64_t old = state;
    state = old * 6364136223846793005ULL + 1442695040888963407ULL;
    const auto shifted = static_cast<uint32_t>(((old >> 18) ^ old) >> 27);
    return std::rotr(shifted, static_cast<int>(old >> 59));
  }
  uint64_t next_64() {
    const uint64_t high = next();
    return (high << 32) | next();
  }
  /// 0 to `last`, all as likely.
  uint64_t up_to(uint64_t last) {
    const uint64_t mask = last == 0 ? 0 : ~uint64_t{0} >> std::countl_zero(last);
    while (true) {
      const uint64_t drawn = next_64() & mask;
      if (drawn <= last) return drawn;
    }
  }
};

int draw(lua_State* state) {
  auto& generator = *static_cast<Pcg32*>(lua_touserdata(state, lua_upvalueindex(1)));
  if (lua_gettop(state) == 0) {
    lua_pushnumber(state, static_cast<double>(generator.next_64() >> 11) * 0x1p-53);
    return 1;
  }
  const bool two = lua_gettop(state) > 1;
  const lua_Integer first = two ? luaL_checkinteger(state, 1) : 1;
  const lua_Integer last = luaL_checkinteger(state, two ? 2 : 1);
  luaL_argcheck(state, first <= last, two ? 2 : 1, "expected a last number not below the first");
  const uint64_t span = static_cast<uint64_t>(last) - static_cast<uint64_t>(first);
  lua_pushinteger(state,
                  static_cast<lua_Integer>(static_cast<uint64_t>(first) + generator.up_to(span)));
  return 1;
}

}  // namespace

int make_random(lua_State* state) {
  const lua_Integer seed = luaL_checkinteger(state, 1);
  auto* const generator = static_cast<Pcg32*>(lua_newuserdatauv(state, sizeof(Pcg32), 0));
  generator->state = mix64(static_cast<uint64_t>(seed));
  lua_pushcclosure(state, draw, 1);
  return 1;
}

}  // namespace hyades::core::lua
