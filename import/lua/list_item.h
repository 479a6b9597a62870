#pragma once

#include <span>
#include <string_view>

#include "import/lua/lua_api.h"

namespace hyades::core::lua {

/// A table of a list that a script gives, on top of the stack. What is wrong with it is raised as
/// Lua's error, which names it by its place in the list.
class ListItem {
 public:
  /// `noun`: what it is called, as in "copy 3".
  ListItem(lua_State* state, const char* noun, lua_Integer index)
      : state_(state), noun_(noun), index_(index) {}

  /// Raises where the table has another key than `keys`, which `expected` lists for people.
  void check_keys(std::span<const std::string_view> keys, const char* expected) const;

  /// Takes the number of `key` off the stack, which lies above the table; raises where it is none,
  /// or not finite.
  float take_number(const char* key) const;

 protected:
  lua_State* state_;
  const char* noun_;
  lua_Integer index_;
};

}  // namespace hyades::core::lua
