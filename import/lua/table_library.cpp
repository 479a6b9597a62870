#include <cstdint>

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

/// Counts the items from `first` to `last`.
void spend_range(lua_State* state, lua_Integer first, lua_Integer last) {
  if (last < first) return;
  Machine::of(state).spend(static_cast<uint64_t>(last) - static_cast<uint64_t>(first) + 1);
}

int guard_insert(lua_State* state) {
  const lua_Integer length = length_at(state, 1);
  if (lua_gettop(state) == 3) spend_range(state, luaL_checkinteger(state, 2), length);
  return call_original(state);
}

int guard_remove(lua_State* state) {
  const lua_Integer length = length_at(state, 1);
  if (lua_gettop(state) > 1) spend_range(state, luaL_checkinteger(state, 2), length);
  return call_original(state);
}

/// concat(list, between, first, last).
int guard_concat(lua_State* state) {
  const lua_Integer length = length_at(state, 1);
  spend_range(state, luaL_optinteger(state, 3, 1), luaL_optinteger(state, 4, length));
  return call_original(state);
}

/// unpack(list, first, last).
int guard_unpack(lua_State* state) {
  const lua_Integer length = length_at(state, 1);
  spend_range(state, luaL_optinteger(state, 2, 1), luaL_optinteger(state, 3, length));
  return call_original(state);
}

int guard_sort(lua_State* state) {
  const lua_Integer length = length_at(state, 1);
  spend_range(state, 1, 8 * length);
  return call_original(state);
}

/// move(list, first, last, to, target).
int guard_move(lua_State* state) {
  (void)length_at(state, 1);
  spend_range(state, luaL_checkinteger(state, 2), luaL_checkinteger(state, 3));
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
