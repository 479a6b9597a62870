#include "import/lua/setting.h"

#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "core/base/text.h"
#include "core/job/read_values.h"

namespace hyades::core::lua {

namespace {

/// Bytes of a default and of what explains it.
constexpr size_t kMostShown = 1000;

/// The text at `at`, which people are shown.
std::string text_to_show(lua_State* state, int at, const char* what) {
  size_t size = 0;
  const char* const text = lua_tolstring(state, at, &size);
  if (size > kMostShown) {
    luaL_error(state, "%s of parameter %s is a text of %s, expected at most %s", what,
               lua_tostring(state, 1), format_bytes(size).c_str(),
               format_bytes(kMostShown).c_str());
  }
  return {text, size};
}

/// Pushes a number as the default at 2 is one; false: the text is none.
bool push_number(lua_State* state, const std::string& text) {
  double number = 0.0;
  if (!parse_number(text, number)) return false;
  lua_Integer whole = 0;
  if (lua_isinteger(state, 2) == 0) {
    lua_pushnumber(state, number);
    return true;
  }
  // Whole numbers keep all their digits.
  if (lua_stringtonumber(state, text.c_str()) != text.size() + 1) return false;
  int is_whole = 0;
  whole = lua_tointegerx(state, -1, &is_whole);
  lua_pop(state, 1);
  if (is_whole != 0) lua_pushinteger(state, whole);
  return is_whole != 0;
}

bool push_value(lua_State* state, const std::string& text) {
  switch (lua_type(state, 2)) {
    case LUA_TNUMBER:
      return push_number(state, text);
    case LUA_TBOOLEAN:
      if (text != "true" && text != "false") return false;
      lua_pushboolean(state, static_cast<int>(text == "true"));
      return true;
    default:
      lua_pushlstring(state, text.data(), text.size());
      return true;
  }
}

const char* expected(lua_State* state) {
  if (lua_type(state, 2) == LUA_TBOOLEAN) return "true or false";
  return lua_isinteger(state, 2) != 0 ? "a whole number" : "a number";
}

/// The default at 2 as a person writes it.
std::string usual_value(lua_State* state) {
  switch (lua_type(state, 2)) {
    case LUA_TBOOLEAN:
      return lua_toboolean(state, 2) != 0 ? "true" : "false";
    case LUA_TNUMBER:
      return lua_isinteger(state, 2) != 0 ? fmt::format("{}", lua_tointeger(state, 2))
                                          : fmt::format("{}", lua_tonumber(state, 2));
    case LUA_TSTRING:
      return '"' + text_to_show(state, 2, "the default") + '"';
    default:
      luaL_error(state,
                 "the default of parameter %s is a %s, expected a number, a text, true or "
                 "false",
                 lua_tostring(state, 1), luaL_typename(state, 2));
      return {};
  }
}

}  // namespace

Setting read_setting(lua_State* state, const ScriptSettings& set) {
  lua_settop(state, 3);
  Setting setting;
  setting.name = luaL_checkstring(state, 1);
  if (!is_setting_name(setting.name)) {
    luaL_error(state, "a parameter called '%s', expected a name of 1 to 64 letters, digits and '_'",
               setting.name.substr(0, 60).c_str());
  }
  setting.usual = usual_value(state);
  if (!lua_isnoneornil(state, 3)) {
    luaL_checkstring(state, 3);
    setting.help = text_to_show(state, 3, "the explanation");
  }
  const std::string* given = nullptr;
  for (const auto& [name, value] : set) {
    if (name == setting.name) given = &value;
  }
  if (given == nullptr) {
    lua_pushvalue(state, 2);
  } else if (!push_value(state, *given)) {
    luaL_error(state, "parameter %s is '%s', expected %s (default: %s)", setting.name.c_str(),
               given->c_str(), expected(state), setting.usual.c_str());
  }
  return setting;
}

}  // namespace hyades::core::lua
