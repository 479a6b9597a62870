#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "import/lua/libraries.h"
#include "import/lua/machine.h"

namespace hyades::core::lua {

namespace {

/// Most steps that matching a pattern may take in the worst case: some seconds.
constexpr double kMostMatching = 1e9;

std::string_view text_at(lua_State* state, int at) {
  size_t size = 0;
  const char* const text = luaL_checklstring(state, at, &size);
  return {text, size};
}

/// Bytes that are compared in the time of one step.
constexpr double kComparedPerStep = 32.0;

/// How often a pattern may try a place of a text of `size` bytes: each `*`, `+` and `-` may end
/// anywhere, each `?` in two places; what was captured may be compared to its end. `anchored`: it
/// is tried at the beginning alone. What stands in sets counts as well, which does no harm.
double worst_matching(std::string_view pattern, double size, bool anchored) {
  double steps = anchored ? 1.0 : size + 1.0;
  for (size_t i = 0; i < pattern.size(); ++i) {
    const char c = pattern[i];
    if (c == '%') {
      if (++i == pattern.size()) break;
      if (pattern[i] == 'b' || pattern[i] == 'f') steps *= size + 1.0;
      if (pattern[i] >= '1' && pattern[i] <= '9') steps *= size / kComparedPerStep + 1.0;
    } else if (c == '*' || c == '+' || c == '-') {
      steps *= size + 1.0;
    } else if (c == '?') {
      steps *= 2.0;
    }
  }
  return steps;
}

/// Before `find`, `match`, `gmatch` and `gsub`: Lua's matcher tries all ways to match, counts none
/// of them and cannot be stopped. `knows_anchor`: a `^` before the pattern is none of its letters.
int guard_pattern(lua_State* state, bool knows_anchor) {
  const std::string_view text = text_at(state, 1);
  const std::string_view pattern = text_at(state, 2);
  // A set may be as long as the pattern.
  const double longest = static_cast<double>(pattern.size()) / 100.0 + 1.0;
  const bool anchored = knows_anchor && pattern.starts_with('^');
  const double steps =
      worst_matching(pattern, static_cast<double>(text.size()), anchored) * longest;
  if (!(steps <= kMostMatching)) {
    return luaL_error(state,
                      "this pattern may take too long on a text of %d bytes, expected fewer *, +, "
                      "- and ? in it, ^ before it, or a shorter text",
                      static_cast<int>(text.size()));
  }
  Machine::of(state).spend(text.size());
  Machine::of(state).look();
  return call_original(state);
}

int guard_matching(lua_State* state) { return guard_pattern(state, true); }

/// gsub(text, pattern, by, most): what stands for a match is made anew for each.
int guard_replacing(lua_State* state) {
  const auto places = static_cast<double>(text_at(state, 1).size()) + 1.0;
  const auto most = static_cast<double>(luaL_optinteger(state, 4, INT64_MAX));
  double each = 0.0;
  if (lua_type(state, 3) == LUA_TSTRING) {
    const std::string_view by = text_at(state, 3);
    const auto parts = static_cast<double>(std::count(by.begin(), by.end(), '%'));
    each = static_cast<double>(by.size()) / kComparedPerStep + parts;
  } else if (lua_istable(state, 3)) {
    each = static_cast<double>(tables_asked(state, 3, "__index"));
  }
  const double steps = std::clamp(most, 0.0, places) * each;
  Machine::of(state).spend(static_cast<uint64_t>(std::min(steps, 1e18)));
  return guard_matching(state);
}

int guard_all_matches(lua_State* state) { return guard_pattern(state, false); }

int guard_find(lua_State* state) {
  if (lua_toboolean(state, 4) == 0) return guard_matching(state);
  const auto text = static_cast<double>(text_at(state, 1).size());
  const auto wanted = static_cast<double>(text_at(state, 2).size());
  Machine::of(state).spend(static_cast<uint64_t>(text * (wanted / kComparedPerStep + 1.0)));
  return call_original(state);
}

int guard_repeat(lua_State* state) {
  const lua_Integer count = luaL_checkinteger(state, 2);
  if (count > 0) Machine::of(state).spend(static_cast<uint64_t>(count));
  return call_original(state);
}

/// Before what walks through a text.
int guard_walk(lua_State* state) {
  Machine::of(state).spend(text_at(state, 1).size());
  return call_original(state);
}

/// No addresses: neither by %p nor by the text of a table.
int guard_format(lua_State* state) {
  const std::string_view format = text_at(state, 1);
  for (size_t i = format.find('%'); i < format.size(); i = format.find('%', i + 1)) {
    i = format.find_first_not_of("-+ #0123456789.", i + 1);
    if (i < format.size() && format[i] == 'p') {
      return luaL_error(state, "%%p in a format, expected none: addresses differ from run to run");
    }
    if (i == std::string_view::npos) break;
  }
  for (int i = 2; i <= lua_gettop(state); ++i) {
    const int type = lua_type(state, i);
    if (type == LUA_TNIL || type == LUA_TBOOLEAN || type == LUA_TNUMBER || type == LUA_TSTRING) {
      continue;
    }
    push_text(state, i);
    lua_replace(state, i);
  }
  return call_original(state);
}

}  // namespace

void open_text(lua_State* state) {
  luaL_requiref(state, LUA_STRLIBNAME, luaopen_string, 1);
  lua_pushnil(state);
  lua_setfield(state, -2, "dump");
  guard_function(state, "find", guard_find);
  guard_function(state, "match", guard_matching);
  guard_function(state, "gsub", guard_replacing);
  guard_function(state, "gmatch", guard_all_matches);
  guard_function(state, "rep", guard_repeat);
  guard_function(state, "format", guard_format);
  lua_pop(state, 1);
  luaL_requiref(state, LUA_UTF8LIBNAME, luaopen_utf8, 1);
  for (const char* const name : {"len", "offset", "codepoint"}) {
    guard_function(state, name, guard_walk);
  }
  lua_pop(state, 1);
}

}  // namespace hyades::core::lua
