#include "import/lua/list_item.h"

#include <algorithm>
#include <cmath>

namespace hyades::core::lua {

void ListItem::check_keys(std::span<const std::string_view> keys, const char* expected) const {
  lua_pushnil(state_);
  while (lua_next(state_, -2) != 0) {
    lua_pop(state_, 1);
    const bool text = lua_type(state_, -1) == LUA_TSTRING;
    const std::string_view key = text ? lua_tostring(state_, -1) : luaL_typename(state_, -1);
    if (!text || std::find(keys.begin(), keys.end(), key) == keys.end()) {
      luaL_error(state_, "%s %I has the key '%s', expected %s", noun_, index_, key.data(),
                 expected);
    }
  }
}

float ListItem::take_number(const char* key) const {
  if (lua_type(state_, -1) != LUA_TNUMBER || !std::isfinite(lua_tonumber(state_, -1))) {
    luaL_error(state_, "%s of %s %I is a %s, expected a finite number", key, noun_, index_,
               luaL_typename(state_, -1));
  }
  const auto value = static_cast<float>(lua_tonumber(state_, -1));
  lua_pop(state_, 1);
  return value;
}

}  // namespace hyades::core::lua
