#include "import/lua/places.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include <glm/gtc/matrix_transform.hpp>

#include "core/base/elementary.h"
#include "core/base/vec.h"
#include "import/lua/list_item.h"
#include "import/lua/machine.h"
#include "import/mass_copies.h"

namespace hyades::core::lua {

namespace {

constexpr std::array<std::string_view, 5> kKeys = {"at", "scale", "rotate_x", "rotate_y",
                                                   "rotate_z"};

/// One table of the list, on top of the stack.
class Copy : public ListItem {
 public:
  Copy(lua_State* state, lua_Integer index) : ListItem(state, "copy", index) {}

  Mat4 matrix() const {
    check_keys(kKeys, "at, scale, rotate_x, rotate_y or rotate_z");
    Mat4 m(1.0F);
    const Vec3 scale = vector("scale", Vec3(1.0F));
    for (int i = 0; i < 3; ++i) m[i] *= scale[i];
    for (int axis = 0; axis < 3; ++axis) turn(m, axis);
    m[3] = Vec4(vector("at", Vec3(0.0F)), 1.0F);
    return m;
  }

 private:
  Vec3 vector(const char* key, const Vec3& otherwise) const {
    const int type = lua_getfield(state_, -1, key);
    if (type == LUA_TNIL) {
      lua_pop(state_, 1);
      return otherwise;
    }
    if (type == LUA_TNUMBER && std::string_view(key) == "scale") return Vec3(take_number(key));
    if (type != LUA_TTABLE || lua_rawlen(state_, -1) != 3) {
      luaL_error(state_, "%s of copy %I is a %s, expected {x, y, z}", key, index_,
                 type == LUA_TTABLE ? "table without three numbers" : luaL_typename(state_, -1));
    }
    Vec3 value;
    for (int i = 0; i < 3; ++i) {
      lua_rawgeti(state_, -1, i + 1);
      value[i] = take_number(key);
    }
    lua_pop(state_, 1);
    return value;
  }

  /// Turns `m` about x (0), y (1) or z (2), as the steps of a job's transform do.
  void turn(Mat4& m, int axis) const {
    const char* const key = kKeys[static_cast<size_t>(axis) + 2].data();
    if (lua_getfield(state_, -1, key) == LUA_TNIL) {
      lua_pop(state_, 1);
      return;
    }
    const SinCos angle = sin_cos(kRadians * take_number(key));
    const int a = (axis + 1) % 3;
    const int b = (axis + 2) % 3;
    for (int column = 0; column < 3; ++column) {
      const Vec4 old = m[column];
      m[column][a] = angle.cos * old[a] - angle.sin * old[b];
      m[column][b] = angle.sin * old[a] + angle.cos * old[b];
    }
  }
};

}  // namespace

std::vector<PlaceMatrix> read_copies(lua_State* state, int at) {
  luaL_checktype(state, at, LUA_TTABLE);
  const auto count = static_cast<lua_Integer>(lua_rawlen(state, at));
  if (count == 0) luaL_error(state, "a list without copies, expected one at least");
  if (count > static_cast<lua_Integer>(kMostCopies)) {
    luaL_error(state, "%I copies, expected at most %I", count,
               static_cast<lua_Integer>(kMostCopies));
  }
  Machine::of(state).spend(16 * static_cast<uint64_t>(count));
  // The matrices, and the file of them.
  Machine::of(state).need(3 * sizeof(PlaceMatrix) * static_cast<size_t>(count));
  std::vector<PlaceMatrix> places;
  places.reserve(static_cast<size_t>(count));
  for (lua_Integer i = 1; i <= count; ++i) {
    if (lua_rawgeti(state, at, i) != LUA_TTABLE) {
      luaL_error(state, "copy %I is a %s, expected a table such as {at = {1, 0, 2}}", i,
                 luaL_typename(state, -1));
    }
    const Mat4 matrix = Copy(state, i).matrix();
    if (!can_be_copied(matrix)) luaL_error(state, "copy %I is flat or too small to be seen", i);
    places.emplace_back(matrix);
    if (i % 16 == 0)
      Machine::of(state).look();  // tables may have millions of slots that were emptied
    lua_pop(state, 1);
  }
  return places;
}

}  // namespace hyades::core::lua
