#pragma once

#include "core/base/result.h"
#include "core/job/yaml_tree.h"
#include "import/lua/lua_api.h"

namespace hyades::core::lua {

/// The value at `at` of the stack as a tree of the job language: tables with 1 to n for keys are
/// lists, others maps with their keys sorted (under the key `keys`, whose keys are frames, by
/// number); an empty one is an empty map. Every node stands where its table was made. Errors name
/// that place and the path in the tree ("objects.ball.at[2]"): mixed keys, holes, functions,
/// numbers that are not finite, and what is beyond the limits of a job's text.
Result<YamlPtr> tree_of(lua_State* state, int at);

}  // namespace hyades::core::lua
