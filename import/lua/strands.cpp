#include "import/lua/strands.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "import/lua/list_item.h"
#include "import/lua/machine.h"

namespace hyades::core::lua {

namespace {

constexpr std::array<std::string_view, 3> kStrandKeys = {"points", "width", "color"};
constexpr lua_Integer kMostStrands = 4'000'000;
constexpr size_t kMostPointsOfOne = 65536;  ///< as many as its file can say

/// One table of the list, on top of the stack.
class Strand : public ListItem {
 public:
  Strand(lua_State* state, lua_Integer index) : ListItem(state, "strand", index) {}

  void add_to(StrandList& list) const {
    check_keys(kStrandKeys, "points, width or color");
    const auto [root, tip] = width();
    const size_t count = add_points(list);
    list.sizes.push_back(static_cast<uint32_t>(count));
    for (size_t i = 0; i < count; ++i) {
      const float share = static_cast<float>(i) / static_cast<float>(count - 1);
      list.radii.push_back(0.5F * std::lerp(root, tip, share));
    }
    add_color(list, count);
  }

 private:
  struct Widths {
    float root;
    float tip;
  };

  /// The list of `count` numbers on top of the stack.
  template <size_t count>
  std::array<float, count> numbers(const char* key) const {
    if (lua_type(state_, -1) != LUA_TTABLE || lua_rawlen(state_, -1) != count) {
      luaL_error(state_, "%s of strand %I has a %s, expected %d numbers", key, index_,
                 lua_type(state_, -1) == LUA_TTABLE ? "table of others" : luaL_typename(state_, -1),
                 static_cast<int>(count));
    }
    std::array<float, count> values{};
    for (size_t i = 0; i < count; ++i) {
      lua_rawgeti(state_, -1, static_cast<lua_Integer>(i) + 1);
      values[i] = take_number(key);
    }
    return values;
  }

  Widths width() const {
    Widths widths{};
    const int type = lua_getfield(state_, -1, "width");
    if (type == LUA_TNUMBER) {
      lua_pushvalue(state_, -1);
      widths.root = widths.tip = take_number("width");
    } else if (type != LUA_TTABLE) {
      luaL_error(state_, "width of strand %I is a %s, expected a number or {root, tip}", index_,
                 lua_typename(state_, type));
    } else {
      const auto both = numbers<2>("width");
      widths = {both[0], both[1]};
    }
    lua_pop(state_, 1);
    if (widths.root < 0.0F || widths.tip < 0.0F) {
      luaL_error(state_, "width of strand %I is below 0", index_);
    }
    return widths;
  }

  size_t add_points(StrandList& list) const {
    const bool given = lua_getfield(state_, -1, "points") == LUA_TTABLE;
    const size_t count = given ? lua_rawlen(state_, -1) : 0;
    if (count < 2 || count > kMostPointsOfOne) {
      luaL_error(state_, "strand %I has %I points, expected 2 to %I", index_,
                 static_cast<lua_Integer>(count), static_cast<lua_Integer>(kMostPointsOfOne));
    }
    Machine::of(state_).spend(8 * static_cast<uint64_t>(count));
    // The points, and the file of them.
    Machine::of(state_).need(3 * (sizeof(Vec4) + sizeof(Vec3)) * (list.points.size() + count));
    for (size_t i = 1; i <= count; ++i) {
      lua_rawgeti(state_, -1, static_cast<lua_Integer>(i));
      const auto [x, y, z] = numbers<3>("points");
      list.points.emplace_back(x, y, z);
      lua_pop(state_, 1);
    }
    lua_pop(state_, 1);
    return count;
  }

  void add_color(StrandList& list, size_t count) const {
    const bool given = lua_getfield(state_, -1, "color") != LUA_TNIL;
    const bool expected = index_ == 1 ? given : !list.colors.empty();
    if (given != expected) {
      luaL_error(state_, "strand %I has %s color, but those before have %s", index_,
                 given ? "a" : "no", given ? "none" : "one");
    }
    if (given) {
      const auto [r, g, b] = numbers<3>("color");
      for (const float part : {r, g, b}) {
        if (part >= 0.0F && part <= 1.0F) continue;
        luaL_error(state_, "color of strand %I has %f, expected 0 to 1%s", index_,
                   static_cast<double>(part),
                   part > 1.0F ? "; if they go from 0 to 255, divide by 255" : "");
      }
      list.colors.insert(list.colors.end(), count, Vec3(r, g, b));
    }
    lua_pop(state_, 1);
  }
};

}  // namespace

StrandList read_strands(lua_State* state, int at) {
  luaL_checktype(state, at, LUA_TTABLE);
  const auto count = static_cast<lua_Integer>(lua_rawlen(state, at));
  if (count == 0) luaL_error(state, "a list without strands, expected one at least");
  if (count > kMostStrands) {
    luaL_error(state, "%I strands, expected at most %I", count, kMostStrands);
  }
  StrandList list;
  for (lua_Integer i = 1; i <= count; ++i) {
    if (lua_rawgeti(state, at, i) != LUA_TTABLE) {
      luaL_error(state, "strand %I is a %s, expected a table such as {points = {...}, width = 0.1}",
                 i, luaL_typename(state, -1));
    }
    Strand(state, i).add_to(list);
    if (i % 16 == 0) Machine::of(state).look();
    lua_pop(state, 1);
  }
  return list;
}

}  // namespace hyades::core::lua
