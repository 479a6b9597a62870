#include "import/lua/script_run.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "core/base/hash.h"
#include "core/base/printable.h"
#include "core/base/text.h"
#include "core/geometry/read_hair.h"
#include "core/geometry/read_places.h"
#include "import/lua/libraries.h"
#include "import/lua/places.h"
#include "import/lua/random.h"
#include "import/lua/setting.h"
#include "import/lua/strands.h"
#include "import/lua/time_guard.h"
#include "import/lua/tree.h"
#include "import/within_folder.h"

namespace hyades::core::lua {

namespace {

constexpr size_t kMaxDepth = 16;
constexpr size_t kMaxScript = size_t{4} << 20;
constexpr size_t kMostParameters = 1000;

/// That an included file runs, however that ends.
class Opening {
 public:
  Opening(std::vector<std::string>& open, const std::string& name) : open_(open) {
    open_.push_back(name);
  }
  ~Opening() { open_.pop_back(); }
  Opening(const Opening&) = delete;
  Opening& operator=(const Opening&) = delete;

 private:
  std::vector<std::string>& open_;
};

class Run {
 public:
  explicit Run(const ScriptRequest& request)
      : request_(request),
        guard_(request.limits.seconds + request.limits.overtime,
               printable(request.script) + ": the script has run for 10 s; it may take " +
                   format_duration(request.limits.seconds) + " of processor time",
               printable(request.script) + ": the script takes more than " +
                   format_duration(request.limits.seconds) +
                   " of processor time, and can be interrupted only by ending the program"),
        machine_(request.limits) {}

  Result<ScriptResult> run() {
    lua_State* const state = machine_.state();
    lua_pushcfunction(state, &Run::prepare);
    lua_pushlightuserdata(state, this);
    if (auto ready = machine_.call(1, 0); !ready) return ready.error();
    const std::string name = std::filesystem::path(request_.script).filename().string();
    if (auto loaded = load(name); !loaded) return loaded.error();
    if (auto done = machine_.call(0, 1); !done) return done.error();
    if (auto known = check_settings(); !known) return known.error();
    if (!lua_istable(state, -1)) {
      return Error{fmt::format(
          "{}: the script returns {}, expected a table of a job's sections: "
          "return {{objects = {{...}}}}",
          request_.script, lua_isnil(state, -1) ? "nothing" : luaL_typename(state, -1))};
    }
    // Within a call, for the limits hold there.
    lua_pushcfunction(state, &Run::read_tree);
    lua_insert(state, -2);
    lua_pushlightuserdata(state, this);
    if (auto read = machine_.call(2, 0); !read) return read.error();
    if (!bad_tree_.message.empty()) return told_beside(request_.script, bad_tree_);
    return std::move(result_);
  }

 private:
  /// Compiles a file of the script's folder, and leaves the function on the stack.
  Status load(const std::string& name) {
    const std::string shown = resolve_reference(name, request_.script);
    const auto bytes = request_.files.open(name, request_.script);
    if (!bytes) return bytes.error();
    if (bytes->size() > kMaxScript) {
      return Error{fmt::format("{}: a script of {}, expected at most {}", shown,
                               format_bytes(bytes->size()), format_bytes(kMaxScript))};
    }
    if (machine_.load({bytes->chars(), bytes->size()}, shown, name)) return {};
    const Error error{printable(lua_tostring(machine_.state(), -1))};
    lua_pop(machine_.state(), 1);
    return error;
  }

  Status check_settings() const {
    std::vector<std::string> names;
    std::string known;
    for (const Parameter& parameter : result_.parameters) {
      names.push_back(parameter.name);
      known += fmt::format("\n  {} = {}", parameter.name, printable(parameter.usual));
      if (!parameter.help.empty()) known += "  (" + printable(parameter.help) + ")";
    }
    for (const auto& [name, value] : request_.set) {
      if (std::find(names.begin(), names.end(), name) != names.end()) continue;
      if (names.empty()) {
        return Error{fmt::format("{}: there is no parameter '{}': the script has none",
                                 request_.script, name)};
      }
      return Error{fmt::format("{}: there is no parameter '{}'{}; the script has{}",
                               request_.script, name, did_you_mean(name, names), known)};
    }
    return {};
  }

  static Run& of(lua_State* state) {
    return *static_cast<Run*>(lua_touserdata(state, lua_upvalueindex(1)));
  }

  /// Reads the table at 1.
  static int read_tree(lua_State* state) {
    Run& run = *static_cast<Run*>(lua_touserdata(state, 2));
    auto tree = tree_of(state, 1);
    if (tree) {
      run.result_.tree = *tree;
    } else {
      run.bad_tree_ = tree.error();
    }
    return 0;
  }

  /// Opens the libraries and the functions below.
  static int prepare(lua_State* state) {
    void* const self = lua_touserdata(state, 1);
    open_libraries(state);
    lua_pushglobaltable(state);
    constexpr std::array<luaL_Reg, 8> kCalls = {{{"param", param},
                                                 {"frame", frame},
                                                 {"time", time},
                                                 {"include", include},
                                                 {"places", places},
                                                 {"strands", strands},
                                                 {"random", make_random},
                                                 {nullptr, nullptr}}};
    lua_pushlightuserdata(state, self);
    luaL_setfuncs(state, kCalls.data(), 1);
    return 0;
  }

  /// param(name, default, help).
  static int param(lua_State* state) {
    Run& run = of(state);
    const Setting setting = read_setting(state, run.request_.set);
    const auto same =
        std::find_if(run.result_.parameters.begin(), run.result_.parameters.end(),
                     [&](const Parameter& parameter) { return parameter.name == setting.name; });
    if (same != run.result_.parameters.end() && same->usual != setting.usual) {
      return luaL_error(state, "parameter %s has the default %s here and %s elsewhere",
                        setting.name.c_str(), setting.usual.c_str(), same->usual.c_str());
    }
    if (same == run.result_.parameters.end()) {
      if (run.result_.parameters.size() >= kMostParameters) {
        return luaL_error(state, "more than %d parameters", static_cast<int>(kMostParameters));
      }
      run.result_.parameters.push_back({setting.name, setting.usual, setting.help});
    }
    return 1;
  }

  static int frame(lua_State* state) {
    Run& run = of(state);
    run.result_.asks_frame = true;
    lua_pushinteger(state, run.request_.frame);
    return 1;
  }

  static int time(lua_State* state) {
    Run& run = of(state);
    run.result_.asks_frame = true;
    lua_pushnumber(state, (run.request_.frame - 1) / run.request_.fps);
    return 1;
  }

  /// include(file): what another script of the folder returns, which runs once.
  static int include(lua_State* state) {
    Run& run = of(state);
    const auto name = within_folder(luaL_checkstring(state, 1));
    if (!name) return luaL_error(state, "include: %s", name.error().message.c_str());
    if (!is_script_file(*name)) {
      return luaL_error(state, "include: '%s', expected a script (.lua)", name->c_str());
    }
    if (lua_getfield(state, LUA_REGISTRYINDEX, name->c_str()) == LUA_TTABLE) {
      lua_rawgeti(state, -1, 1);
      return 1;
    }
    const bool open = std::find(run.open_.begin(), run.open_.end(), *name) != run.open_.end();
    if (open || run.open_.size() >= kMaxDepth) {
      return luaL_error(state,
                        open ? "include: '%s' includes itself in the end"
                             : "include: '%s' lies too deep, expected at most 16 levels",
                        name->c_str());
    }
    if (auto loaded = run.load(*name); !loaded) {
      return luaL_error(state, "include: %s", loaded.error().message.c_str());
    }
    {
      const Opening opening(run.open_, *name);
      lua_call(state, 0, 1);
    }
    lua_createtable(state, 1, 0);
    lua_pushvalue(state, -2);
    lua_rawseti(state, -2, 1);
    lua_setfield(state, LUA_REGISTRYINDEX, name->c_str());
    return 1;
  }

  /// places(list): the name of a file with these copies, for an instance's `places`.
  static int places(lua_State* state) {
    return make_file(state, places_bytes(read_copies(state, 1)), "places", ".ply");
  }

  /// strands(list): the name of a file with these strands, for an object's `curves`.
  static int strands(lua_State* state) {
    return make_file(state, hair_bytes(read_strands(state, 1)), "strands", ".hair");
  }

  static int make_file(lua_State* state, const Bytes& file, const char* kind, const char* ending) {
    Run& run = of(state);
    if (file.size() > run.request_.limits.memory - run.made_bytes_) {
      return luaL_error(state, "more than %s of %s in all",
                        format_bytes(run.request_.limits.memory).c_str(), kind);
    }
    const Sha256 hash = sha256({file.chars(), file.size()});
    const std::string name = fmt::format("{}-{}{}", kind, to_hex(std::span(hash).first(8)), ending);
    if (run.result_.made.emplace(name, file).second) run.made_bytes_ += file.size();
    const std::string reference = run.request_.made + name;
    lua_pushlstring(state, reference.data(), reference.size());
    return 1;
  }

  const ScriptRequest& request_;
  ScriptResult result_;
  Error bad_tree_;  ///< why what it returns is no tree
  size_t made_bytes_ = 0;
  std::vector<std::string> open_;  ///< included files that are running
  TimeGuard guard_;
  Machine machine_;
};

}  // namespace

Error told_beside(const std::string& script, const Error& error) {
  const size_t folder = script.rfind('/');
  const bool has_place = error.message.find(".lua:") < error.message.find(' ');
  if (!has_place) return error.in(script);
  return folder == std::string::npos ? error : Error{script.substr(0, folder + 1) + error.message};
}

Result<ScriptResult> run_script(const ScriptRequest& request) { return Run(request).run(); }

}  // namespace hyades::core::lua
