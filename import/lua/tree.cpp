#include "import/lua/tree.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/base/printable.h"
#include "core/base/text.h"
#include "core/job/yaml_build.h"
#include "import/lua/machine.h"

namespace hyades::core::lua {

namespace {

/// From here on numbers are written as they are, for the job's reader to refuse.
constexpr double kBeyondJobs = 1e18;
/// Up to here a number of Lua holds every whole number.
constexpr double kMostWhole = 0x1p53;

/// A key of a map on its way into the tree.
struct Key {
  std::string text;
  double number = 0.0;  ///< of frames
};

class Reader {
 public:
  explicit Reader(lua_State* state) : state_(state), machine_(Machine::of(state)) {}

  YamlPtr value(int at, const YamlPlace& around) {
    if (++count_ > kMaxYamlNodes) {
      return refuse(
          around, fmt::format("lies beyond {} values and keys, which is what a job may have; many "
                              "copies of one thing are told by places(): see docs/lua.md",
                              kMaxYamlNodes));
    }
    switch (lua_type(state_, at)) {
      case LUA_TBOOLEAN:
        return placed(yaml_flag(lua_toboolean(state_, at) != 0), around);
      case LUA_TNUMBER:
        return number(at, around);
      case LUA_TSTRING:
        return text(at, around);
      case LUA_TTABLE:
        return table(lua_absindex(state_, at), around);
      default:
        return refuse(around, fmt::format("is a {}, expected a number, a text, true, false or a "
                                          "table",
                                          luaL_typename(state_, at)));
    }
  }

  const Error& error() const { return error_; }

 private:
  static YamlPtr placed(const YamlPtr& node, const YamlPlace& where) {
    auto copy = std::make_shared<YamlNode>(*node);
    copy->where = where;
    return copy;
  }

  YamlPtr refuse(const YamlPlace& where, const std::string& what) {
    const std::string line =
        where.line > 0 ? fmt::format("{}:{}: ", *where.file, where.line) : std::string();
    error_ = {line + (path_.empty() ? "what the script returns" : printable(path_)) + " " + what};
    return nullptr;
  }

  /// The text at `at`, of which each copy counts: a script that holds it once may name it a million
  /// times. Nothing, after refuse(), beyond what a job's text may have.
  std::optional<std::string> text_at(int at, const YamlPlace& around) {
    size_t size = 0;
    const char* const text = lua_tolstring(state_, at, &size);
    if (size > kMaxYamlBytes - bytes_) {
      (void)refuse(around, fmt::format("lies beyond {} of text, which is what a job may have",
                                       format_bytes(kMaxYamlBytes)));
      return std::nullopt;
    }
    bytes_ += size;
    return std::string(text, size);
  }

  YamlPtr text(int at, const YamlPlace& around) {
    auto text = text_at(at, around);
    return text ? placed(yaml_text(std::move(*text)), around) : nullptr;
  }

  YamlPtr number(int at, const YamlPlace& around) {
    if (lua_isinteger(state_, at) != 0) {
      return placed(yaml_integer(lua_tointeger(state_, at)), around);
    }
    const double number = lua_tonumber(state_, at);
    if (!std::isfinite(number)) {
      return refuse(around, fmt::format("is {}, expected a finite number", number));
    }
    // Whole ones keep all their digits, as seeds of other programs do.
    if (std::floor(number) == number && std::abs(number) <= kMostWhole) {
      return placed(yaml_integer(static_cast<int64_t>(number)), around);
    }
    const bool beyond = std::abs(number) > kBeyondJobs;
    return placed(
        beyond ? yaml_word(fmt::format("{}", number)) : yaml_number(static_cast<float>(number)),
        around);
  }

  YamlPtr table(int at, const YamlPlace& around) {
    const YamlPlace made = machine_.made_at(lua_topointer(state_, at));
    const YamlPlace& where = made.line > 0 ? made : around;
    machine_.look();  // tables may have millions of slots that were emptied
    if (++depth_ > kMaxYamlDepth || lua_checkstack(state_, 4) == 0) {
      return refuse(
          where, fmt::format("lies deeper than {} tables (a table within itself?)", kMaxYamlDepth));
    }
    const auto length = static_cast<lua_Integer>(lua_rawlen(state_, at));
    const bool is_list = length > 0 && !holds_frames_;
    YamlPtr result = is_list ? list(at, length, where) : map(at, where);
    --depth_;
    return result;
  }

  YamlPtr list(int at, lua_Integer length, const YamlPlace& where) {
    if (!check_list(at, length, where)) return nullptr;
    std::vector<YamlPtr> items;
    items.reserve(static_cast<size_t>(length));
    const size_t cut = path_.size();
    for (lua_Integer i = 1; i <= length; ++i) {
      path_ += fmt::format("[{}]", i);
      lua_rawgeti(state_, at, i);
      YamlPtr item = value(-1, where);
      lua_pop(state_, 1);
      if (item == nullptr) return nullptr;
      path_.resize(cut);
      items.push_back(std::move(item));
    }
    return placed(yaml_list(std::move(items)), where);
  }

  /// Whether the keys are 1 to `length` and no others.
  bool check_list(int at, lua_Integer length, const YamlPlace& where) {
    lua_pushnil(state_);
    while (lua_next(state_, at) != 0) {
      lua_pop(state_, 1);
      const bool fits = lua_isinteger(state_, -1) != 0 && lua_tointeger(state_, -1) >= 1 &&
                        lua_tointeger(state_, -1) <= length;
      if (fits) continue;
      (void)refuse(where, fmt::format("has items and the key {}, expected a list (1, 2, 3, ...) or "
                                      "a map of names",
                                      shown_key()));
      lua_pop(state_, 1);
      return false;
    }
    for (lua_Integer i = 1; i <= length; ++i) {
      const bool hole = lua_rawgeti(state_, at, i) == LUA_TNIL;
      lua_pop(state_, 1);
      if (!hole) continue;
      (void)refuse(where,
                   fmt::format("has no item {} of {}, expected a list without holes", i, length));
      return false;
    }
    return true;
  }

  /// The key on top of the stack, for complaints.
  std::string shown_key() const {
    constexpr size_t kShown = 60;
    if (lua_type(state_, -1) == LUA_TSTRING) {
      return "'" + printable(std::string_view(lua_tostring(state_, -1)).substr(0, kShown)) + "'";
    }
    if (lua_isinteger(state_, -1) != 0) return fmt::format("{}", lua_tointeger(state_, -1));
    if (lua_type(state_, -1) == LUA_TNUMBER) return fmt::format("{}", lua_tonumber(state_, -1));
    return std::string("that is a ") + luaL_typename(state_, -1);
  }

  YamlPtr map(int at, const YamlPlace& where) {
    std::vector<Key> keys;
    const bool of_frames = std::exchange(holds_frames_, false);
    if (!read_keys(at, of_frames, where, keys)) return nullptr;
    std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
      return a.number != b.number ? a.number < b.number : a.text < b.text;
    });
    auto node = std::make_shared<YamlNode>();
    node->kind = YamlNode::Kind::map;
    node->where = where;
    const size_t cut = path_.size();
    for (Key& key : keys) {
      path_ += (path_.empty() ? "" : ".") + key.text.substr(0, 100);
      push_item(at, key, of_frames);
      holds_frames_ = key.text == "keys" && lua_istable(state_, -1);
      YamlPtr item = value(-1, where);
      lua_pop(state_, 1);
      if (item == nullptr) return nullptr;
      path_.resize(cut);
      node->weight += item->weight;
      node->map.push_back({std::move(key.text), where, std::move(item)});
    }
    return node;
  }

  bool read_keys(int at, bool of_frames, const YamlPlace& where, std::vector<Key>& keys) {
    lua_pushnil(state_);
    while (lua_next(state_, at) != 0) {
      lua_pop(state_, 1);
      ++count_;  // the reader of jobs counts keys too
      const int type = lua_type(state_, -1);
      if (type == LUA_TSTRING) {
        auto text = text_at(-1, where);
        if (!text) {
          lua_pop(state_, 1);
          return false;
        }
        keys.push_back({std::move(*text)});
      } else if (type == LUA_TNUMBER && of_frames) {
        keys.push_back({shown_key(), lua_tonumber(state_, -1)});
      } else {
        (void)refuse(where,
                     fmt::format("has the key {}, expected a list (1, 2, 3, ...) or a map of "
                                 "names",
                                 shown_key()));
        lua_pop(state_, 1);
        return false;
      }
    }
    return true;
  }

  void push_item(int at, const Key& key, bool of_frames) const {
    lua_pushlstring(state_, key.text.data(), key.text.size());
    if (lua_rawget(state_, at) != LUA_TNIL || !of_frames) return;
    lua_pop(state_, 1);
    lua_pushnumber(state_, key.number);
    lua_rawget(state_, at);
  }

  lua_State* state_;
  Machine& machine_;
  std::string path_;
  Error error_;
  uint64_t count_ = 0;
  size_t bytes_ = 0;  ///< of texts
  int depth_ = 0;
  bool holds_frames_ = false;  ///< the table that comes next maps frames to values
};

}  // namespace

Result<YamlPtr> tree_of(lua_State* state, int at) {
  Reader reader(state);
  YamlPtr tree = reader.value(lua_absindex(state, at), {});
  if (tree == nullptr) return reader.error();
  return tree;
}

}  // namespace hyades::core::lua
