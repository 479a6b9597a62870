#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/job/yaml_tree.h"
#include "import/lua/lua_api.h"

namespace hyades::core::lua {

/// What one run of a script may take.
struct Limits {
  /// Instructions of Lua's machine; 16 bytes that are allocated count as one, and so does each item
  /// that a function of ours looks at.
  uint64_t steps = 10'000'000'000;
  size_t memory = size_t{1} << 30;  ///< bytes, of everything that the script holds
  size_t text = size_t{16} << 20;   ///< bytes of one string
  double seconds = 600.0;           ///< processor time
  double overtime = 60.0;           ///< beyond `seconds`, after which the process is ended
};

/// Lua 5.4 for scripts that nobody trusts: what it may take is bounded, no `pcall` catches that
/// bound, and it knows at which line each table was made. It has no libraries until they are opened
/// (libraries.h). For one thread.
class Machine {
 public:
  explicit Machine(const Limits& limits);
  ~Machine();
  Machine(const Machine&) = delete;
  Machine& operator=(const Machine&) = delete;

  lua_State* state() const { return state_; }

  /// The machine that `state` belongs to.
  static Machine& of(lua_State* state);

  /// Compiles `text` and leaves the function on the stack. `shown` is what errors call the file,
  /// `name` what places (made_at()) call it. False, with the error on the stack, where it is no
  /// Lua; compiled Lua is refused.
  bool load(std::string_view text, const std::string& shown, const std::string& name);

  /// Calls the function below `arguments` values on the stack; `results` values are left there. An
  /// error names file and line, and has the traceback in the lines after the first.
  Status call(int arguments, int results);

  /// Counts what a function of ours is about to do; raises Lua's error, which nobody catches, where
  /// that is too much.
  void spend(uint64_t steps);

  /// Looks at all limits now, before or while a function of ours does what may take seconds and
  /// counts as few steps; raises Lua's error, which nobody catches, where one is met.
  void look();

  /// Raises Lua's error, which nobody catches, where the script has no room for `bytes` more, which
  /// a function of ours is about to take by itself.
  void need(size_t bytes);

  /// Whether a limit was met: then every protected call fails.
  bool stopped() const { return stopped_; }

  /// A call has failed for want of memory: from now on the machine is stopped().
  void stop_for_memory();

  /// Where the table at `pointer` (lua_topointer) was made; line 0: not known.
  YamlPlace made_at(const void* pointer) const;

  /// The number of the table or function of Lua at `pointer`, by age: an order that is the same in
  /// every run.
  static uint64_t age_of(const void* pointer);

 private:
  struct Header;
  struct File {
    std::string chunk;  ///< as Lua calls it
    std::shared_ptr<const std::string> name;
  };

  static void* allocate(void* self, void* pointer, size_t old_size, size_t new_size);
  static void on_count(lua_State* state, lua_Debug* where);
  static int add_traceback(lua_State* state);

  void* take(void* pointer, size_t old_size, size_t new_size);
  void refuse(std::string why);
  std::string too_many_steps() const;
  std::string too_late() const;
  std::string too_much_memory() const;
  bool is_spent() const;
  bool is_late() const;
  [[noreturn]] void stop(const std::string& why);
  void find_line(Header& header) const;
  std::string line_now() const;
  Error error_of(int status);

  const Limits limits_;
  lua_State* state_ = nullptr;
  std::vector<File> files_;
  size_t used_ = 0;         ///< bytes
  uint64_t taken_ = 0;      ///< bytes, of all allocations together
  uint64_t steps_ = 0;      ///< without those of `taken_`
  uint64_t next_look_ = 0;  ///< of spend() at the clock, by steps_
  uint64_t objects_ = 0;    ///< allocations so far
  double begin_ = 0.0;      ///< of the thread's processor time
  bool stopped_ = false;
  bool hurried_ = false;      ///< the next instruction looks at the limits
  std::string stop_text_;     ///< why it is stopped, with file, line and traceback
  std::string refused_text_;  ///< the last allocation that was refused
};

}  // namespace hyades::core::lua
