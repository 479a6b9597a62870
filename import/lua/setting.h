#pragma once

#include <string>

#include "core/job/scene_document.h"
#include "import/lua/lua_api.h"

namespace hyades::core::lua {

/// A parameter as a script asks for it.
struct Setting {
  std::string name;
  std::string usual;  ///< the default as a person writes it: 3, "red", true
  std::string help;   ///< empty: none
};

/// Reads the arguments of `param(name, default, help)` and pushes the parameter's value: the last
/// of its name in `set`, read as the default's type (number, whole number, text or boolean), else
/// the default. Raises Lua's error where that does not fit, or the arguments are wrong.
Setting read_setting(lua_State* state, const ScriptSettings& set);

}  // namespace hyades::core::lua
