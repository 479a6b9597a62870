#include "import/lua/libraries.h"

#include <array>
#include <cstddef>
#include <cstdio>
#include <string>

#include "core/base/printable.h"
#include "import/lua/key_order.h"
#include "import/lua/machine.h"

namespace hyades::core::lua {

namespace {

/// Bytes of one text that is printed, and of a line before its last.
constexpr size_t kMostPrinted = size_t{1} << 20;

int print(lua_State* state) {
  std::string line;
  const int count = lua_gettop(state);
  for (int i = 1; i <= count; ++i) {
    push_text(state, i);
    size_t size = 0;
    const char* const text = lua_tolstring(state, -1, &size);
    if (size > kMostPrinted || line.size() > kMostPrinted) {
      return luaL_error(state, "a line of more than %d bytes", static_cast<int>(kMostPrinted));
    }
    line.append(i > 1 ? " " : "").append(text, size);
    lua_pop(state, 1);
  }
  Machine::of(state).spend(line.size());
  std::fprintf(stderr, "%s\n", printable(line).c_str());
  return 0;
}

int to_text(lua_State* state) {
  luaL_checkany(state, 1);
  push_text(state, 1);
  return 1;
}

/// After a protected call has failed: raises what no script may catch.
void pass_on_limits(lua_State* state, int status) {
  Machine& machine = Machine::of(state);
  if (status == LUA_ERRMEM) machine.stop_for_memory();
  if (machine.stopped()) lua_error(state);
}

int protected_call(lua_State* state) {
  luaL_checkany(state, 1);
  const int status = lua_pcall(state, lua_gettop(state) - 1, LUA_MULTRET, 0);
  if (status != LUA_OK) pass_on_limits(state, status);
  lua_pushboolean(state, static_cast<int>(status == LUA_OK));
  lua_insert(state, 1);
  return lua_gettop(state);
}

/// A script's handler of errors. At a limit Lua would run it without looking at any.
int handler(lua_State* state) {
  if (Machine::of(state).stopped()) return lua_gettop(state);
  lua_pushvalue(state, lua_upvalueindex(1));
  lua_insert(state, 1);
  lua_call(state, lua_gettop(state) - 1, 1);
  return 1;
}

int protected_call_with_handler(lua_State* state) {
  luaL_checktype(state, 2, LUA_TFUNCTION);
  lua_pushvalue(state, 1);
  lua_pushvalue(state, 2);
  lua_pushcclosure(state, handler, 1);
  lua_replace(state, 1);
  lua_replace(state, 2);  // the handler, the function, its arguments
  const int status = lua_pcall(state, lua_gettop(state) - 2, LUA_MULTRET, 1);
  if (status != LUA_OK) pass_on_limits(state, status);
  lua_pushboolean(state, static_cast<int>(status == LUA_OK));
  lua_replace(state, 1);
  return lua_gettop(state);
}

int set_metatable(lua_State* state) {
  if (lua_istable(state, 2)) {
    // Lua runs finalizers with its limits off, and empties weak tables when it likes.
    for (const char* const refused : {"__gc", "__mode"}) {
      lua_pushstring(state, refused);
      if (lua_rawget(state, 2) != LUA_TNIL) {
        return luaL_error(state, "a metatable with %s, which scenes cannot have", refused);
      }
      lua_pop(state, 1);
    }
  }
  return call_original(state);
}

constexpr std::array<const char*, 6> kLeftOut = {"collectgarbage", "dofile",  "load",
                                                 "loadfile",       "loadlib", "warn"};
constexpr std::array<luaL_Reg, 7> kBaseFunctions = {{{"print", print},
                                                     {"tostring", to_text},
                                                     {"pcall", protected_call},
                                                     {"xpcall", protected_call_with_handler},
                                                     {"pairs", ordered_pairs},
                                                     {"next", ordered_next},
                                                     {nullptr, nullptr}}};

}  // namespace

void push_text(lua_State* state, int at) {
  const int type = lua_type(state, at);
  const bool plain =
      type == LUA_TNIL || type == LUA_TBOOLEAN || type == LUA_TNUMBER || type == LUA_TSTRING;
  const bool says_itself = !plain && luaL_getmetafield(state, at, "__tostring") != LUA_TNIL;
  if (says_itself) lua_pop(state, 1);
  if (plain || says_itself) {
    luaL_tolstring(state, at, nullptr);
  } else {
    lua_pushstring(state, lua_typename(state, type));
  }
}

void guard_function(lua_State* state, const char* name, lua_CFunction guard) {
  lua_getfield(state, -1, name);
  lua_pushcclosure(state, guard, 1);
  lua_setfield(state, -2, name);
}

int call_original(lua_State* state) {
  // In the same frame, so that its complaints name the line that called the guard.
  return lua_tocfunction(state, lua_upvalueindex(1))(state);
}

void open_base(lua_State* state) {
  luaL_requiref(state, LUA_GNAME, luaopen_base, 1);
  for (const char* const name : kLeftOut) {
    lua_pushnil(state);
    lua_setfield(state, -2, name);
  }
  luaL_setfuncs(state, kBaseFunctions.data(), 0);
  guard_function(state, "setmetatable", set_metatable);
  lua_pop(state, 1);
}

void open_libraries(lua_State* state) {
  open_base(state);
  open_text(state);
  open_tables(state);
  open_math(state);
}

}  // namespace hyades::core::lua
