#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "import/lua/libraries.h"
#include "import/lua/machine.h"

namespace hyades::core::lua {

namespace {

/// The length of the list at `at`, which must be a table that does not make up its length: these
/// functions go through it without Lua counting.
lua_Integer length_at(lua_State* state, int at) {
  luaL_checktype(state, at, LUA_TTABLE);
  if (luaL_getmetafield(state, at, "__len") != LUA_TNIL) {
    luaL_error(state, "a table with __len, expected a plain list");
  }
  return static_cast<lua_Integer>(lua_rawlen(state, at));
}

}  // namespace

uint64_t tables_asked(lua_State* state, int at, const char* event) {
  constexpr uint64_t kMost = 2000;  // after which Lua calls it a loop
  const int top = lua_gettop(state);
  lua_pushvalue(state, at);
  uint64_t asked = 1;
  while (asked < kMost) {
    const int next = luaL_getmetafield(state, -1, event);
    if (next == LUA_TNIL || next == LUA_TFUNCTION) break;
    lua_replace(state, -2);
    ++asked;
  }
  lua_settop(state, top);
  return asked;
}

namespace {

/// Counts the items from `first` to `last` of the list at `list`, which are read and written there.
void spend_range(lua_State* state, int list, lua_Integer first, lua_Integer last) {
  const uint64_t tables =
      tables_asked(state, list, "__index") + tables_asked(state, list, "__newindex") - 1;
  Machine& machine = Machine::of(state);
  machine.spend(tables);
  if (last < first) return;
  const uint64_t items = static_cast<uint64_t>(last) - static_cast<uint64_t>(first) + 1;
  machine.spend(items > UINT64_MAX / tables ? UINT64_MAX : items * tables);
}

int guard_insert(lua_State* state) {
  const lua_Integer length = length_at(state, 1);
  const lua_Integer first = lua_gettop(state) == 3 ? luaL_checkinteger(state, 2) : length + 1;
  spend_range(state, 1, first, length);
  return call_original(state);
}

int guard_remove(lua_State* state) {
  const lua_Integer length = length_at(state, 1);
  const lua_Integer first = lua_gettop(state) > 1 ? luaL_checkinteger(state, 2) : length;
  spend_range(state, 1, first, length);
  return call_original(state);
}

/// concat(list, between, first, last).
int guard_concat(lua_State* state) {
  const lua_Integer length = length_at(state, 1);
  spend_range(state, 1, luaL_optinteger(state, 3, 1), luaL_optinteger(state, 4, length));
  return call_original(state);
}

/// unpack(list, first, last).
int guard_unpack(lua_State* state) {
  const lua_Integer length = length_at(state, 1);
  spend_range(state, 1, luaL_optinteger(state, 2, 1), luaL_optinteger(state, 3, length));
  return call_original(state);
}

int guard_sort(lua_State* state) {
  if (lua_iscfunction(state, 2) != 0) {
    return luaL_error(state, "a comparison that is a built-in function, expected one of Lua");
  }
  const lua_Integer length = length_at(state, 1);
  uint64_t most = 0;  // steps of a comparison, which may look at all of a text, NUL by NUL
  for (lua_Integer i = 1; i <= length && lua_isnoneornil(state, 2); ++i) {
    if (lua_rawgeti(state, 1, i) == LUA_TSTRING) {
      constexpr size_t kPerStep = 16;  // bytes
      const std::string_view text(lua_tostring(state, -1), lua_rawlen(state, -1));
      const auto ends = static_cast<size_t>(std::count(text.begin(), text.end(), '\0'));
      most = std::max(most, uint64_t{text.size() / kPerStep + ends});
    }
    lua_pop(state, 1);
  }
  Machine::of(state).spend(8 * static_cast<uint64_t>(length) * most);
  spend_range(state, 1, 1, 8 * length);
  return call_original(state);
}

/// move(list, first, last, to, target).
int guard_move(lua_State* state) {
  (void)length_at(state, 1);
  const lua_Integer first = luaL_checkinteger(state, 2);
  const lua_Integer last = luaL_checkinteger(state, 3);
  spend_range(state, 1, first, last);
  if (lua_gettop(state) >= 5 && lua_istable(state, 5)) spend_range(state, 5, first, last);
  return call_original(state);
}

}  // namespace

void open_tables(lua_State* state) {
  luaL_requiref(state, LUA_TABLIBNAME, luaopen_table, 1);
  guard_function(state, "insert", guard_insert);
  guard_function(state, "remove", guard_remove);
  guard_function(state, "concat", guard_concat);
  guard_function(state, "unpack", guard_unpack);
  guard_function(state, "sort", guard_sort);
  guard_function(state, "move", guard_move);
  lua_pop(state, 1);
}

}  // namespace hyades::core::lua
