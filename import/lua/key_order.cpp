#include "import/lua/key_order.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <tuple>
#include <vector>

#include "import/lua/machine.h"

namespace hyades::core::lua {

namespace {

/// Where a key stands among others. Numbers as long double, which holds every number of Lua.
struct Rank {
  int kind = 0;
  long double number = 0.0L;
  std::string_view text;  ///< alive while the key is
  uint64_t age = 0;
  lua_Integer index = 0;  ///< in the order of Lua
};

bool comes_before(const Rank& a, const Rank& b) {
  return std::tie(a.kind, a.number, a.text, a.age) < std::tie(b.kind, b.number, b.text, b.age);
}

Rank rank_of(lua_State* state, int at) {
  Rank rank;
  switch (lua_type(state, at)) {
    case LUA_TNUMBER:
      rank.number = lua_isinteger(state, at) != 0
                        ? static_cast<long double>(lua_tointeger(state, at))
                        : static_cast<long double>(lua_tonumber(state, at));
      return rank;
    case LUA_TSTRING: {
      size_t size = 0;
      const char* const text = lua_tolstring(state, at, &size);
      rank.kind = 1;
      rank.text = {text, size};
      return rank;
    }
    case LUA_TBOOLEAN:
      rank.kind = 2;
      rank.age = static_cast<uint64_t>(lua_toboolean(state, at));
      return rank;
    default:
      if (lua_istable(state, at) || (lua_isfunction(state, at) && !lua_iscfunction(state, at))) {
        rank.kind = 3;
        rank.age = Machine::age_of(lua_topointer(state, at));
        return rank;
      }
      luaL_error(state, "a key that is a built-in %s, expected one that has an order",
                 luaL_typename(state, at));
      return rank;
  }
}

/// Steps to the next key of a list of keys: upvalues are the list, how many there are, and how many
/// were visited.
int visit(lua_State* state) {
  const lua_Integer count = lua_tointeger(state, lua_upvalueindex(2));
  lua_Integer at = lua_tointeger(state, lua_upvalueindex(3));
  while (at < count) {
    ++at;
    lua_pushinteger(state, at);
    lua_replace(state, lua_upvalueindex(3));
    lua_rawgeti(state, lua_upvalueindex(1), at);
    lua_pushvalue(state, -1);
    if (lua_rawget(state, 1) != LUA_TNIL) return 2;
    lua_pop(state, 2);
  }
  lua_pushnil(state);
  return 1;
}

/// Pushes a list of the keys of the table at 1, in Lua's order; their ranks.
std::vector<Rank> collect_keys(lua_State* state) {
  std::vector<Rank> ranks;
  lua_newtable(state);
  lua_pushnil(state);
  while (lua_next(state, 1) != 0) {
    lua_pop(state, 1);
    Rank rank = rank_of(state, -1);
    rank.index = static_cast<lua_Integer>(ranks.size()) + 1;
    if (ranks.size() == ranks.capacity()) {
      Machine::of(state).need(3 * sizeof(Rank) * ranks.size());
    }
    ranks.push_back(rank);
    lua_pushvalue(state, -1);
    lua_rawseti(state, -3, rank.index);
  }
  return ranks;
}

}  // namespace

int ordered_pairs(lua_State* state) {
  luaL_checkany(state, 1);
  if (luaL_getmetafield(state, 1, "__pairs") != LUA_TNIL) {
    lua_pushvalue(state, 1);
    lua_call(state, 1, 3);
    return 3;
  }
  luaL_checktype(state, 1, LUA_TTABLE);
  lua_settop(state, 1);
  std::vector<Rank> ranks = collect_keys(state);
  Machine::of(state).spend(8 * ranks.size());
  std::sort(ranks.begin(), ranks.end(), comes_before);
  lua_createtable(state, static_cast<int>(ranks.size()), 0);
  for (size_t i = 0; i < ranks.size(); ++i) {
    lua_rawgeti(state, 2, ranks[i].index);
    lua_rawseti(state, 3, static_cast<lua_Integer>(i) + 1);
  }
  lua_pushinteger(state, static_cast<lua_Integer>(ranks.size()));
  lua_pushinteger(state, 0);
  lua_pushcclosure(state, visit, 3);
  lua_pushvalue(state, 1);
  lua_pushnil(state);
  return 3;
}

int ordered_next(lua_State* state) {
  luaL_checktype(state, 1, LUA_TTABLE);
  lua_settop(state, 2);
  const bool first = lua_isnil(state, 2);
  const Rank after = first ? Rank{} : rank_of(state, 2);
  lua_pushnil(state);  // 3: the best key so far
  Rank best;
  uint64_t looked_at = 0;
  lua_pushnil(state);
  while (lua_next(state, 1) != 0) {
    lua_pop(state, 1);
    const Rank rank = rank_of(state, -1);
    ++looked_at;
    if (!first && !comes_before(after, rank)) continue;
    if (!lua_isnil(state, 3) && !comes_before(rank, best)) continue;
    best = rank;
    lua_pushvalue(state, -1);
    lua_replace(state, 3);
  }
  Machine::of(state).spend(looked_at);
  if (lua_isnil(state, 3)) return 1;
  lua_pushvalue(state, 3);
  lua_rawget(state, 1);
  return 2;
}

}  // namespace hyades::core::lua
