#pragma once

#include <cstdint>

#include "import/lua/lua_api.h"

/// What scripts have of Lua's libraries: `base`, `string`, `table`, `utf8` and `math` without what
/// reaches the machine (files, modules, compiled code), takes time that nobody counts, or differs
/// from run to run. docs/lua.md lists what is left out and what is other.
namespace hyades::core::lua {

/// Opens all of them. Raises Lua's errors.
void open_libraries(lua_State* state);

void open_base(lua_State* state);    ///< part of open_libraries()
void open_text(lua_State* state);    ///< part of open_libraries(): string and utf8
void open_tables(lua_State* state);  ///< part of open_libraries()
void open_math(lua_State* state);    ///< part of open_libraries()

/// Pushes the value at `at` as a text: as Lua does, but tables and functions by their type alone,
/// without an address.
void push_text(lua_State* state, int at);

/// How many tables are asked for an item that the one at `at` does not have, itself among them: it
/// may pass the question on (`event` is "__index" or "__newindex"), to a text too, and so may that
/// one. Of functions that are asked Lua counts itself.
uint64_t tables_asked(lua_State* state, int at, const char* event);

/// Replaces function `name` of the library on top of the stack: `guard` gets the original as its
/// first upvalue, for call_original().
void guard_function(lua_State* state, const char* name, lua_CFunction guard);

/// Goes on with the function that a guard stands before.
int call_original(lua_State* state);

}  // namespace hyades::core::lua
