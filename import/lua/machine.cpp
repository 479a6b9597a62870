#include "import/lua/machine.h"

#include <algorithm>
#include <new>

#include <cstdlib>
#include <cstring>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "core/base/machine.h"
#include "core/base/printable.h"
#include "core/base/text.h"

namespace hyades::core::lua {

namespace {

/// Instructions between two looks at the limits.
constexpr int kStepsPerLook = 1000;
constexpr uint64_t kBytesPerStep = 16;
/// Steps of functions between two looks at the clock: some milliseconds.
constexpr uint64_t kStepsPerFunctionLook = 1'000'000;
/// Functions up the stack that are looked at for a line.
constexpr int kMostLevels = 8;

/// What a script says of itself, as a terminal may show it: lines stay.
std::string shown_lines(std::string text) {
  for (size_t at = 0; (at = text.find('\t', at)) != std::string::npos;) text.replace(at, 1, "  ");
  return printable_lines(text);
}

}  // namespace

/// Stands before every block that Lua takes.
struct alignas(16) Machine::Header {
  uint64_t age;
  uint32_t file;  ///< index of `files_`; of a table without a line: none
  uint32_t line;  ///< 0: not known
};

Machine::Machine(const Limits& limits) : limits_(limits), begin_(thread_seconds()) {
  lua_State* const state = lua_newstate(&Machine::allocate, this);
  if (state == nullptr) throw std::bad_alloc();
  *static_cast<Machine**>(lua_getextraspace(state)) = this;
  lua_sethook(state, &Machine::on_count, LUA_MASKCOUNT, kStepsPerLook);
  state_ = state;
}

Machine::~Machine() {
  lua_State* const state = std::exchange(state_, nullptr);
  lua_close(state);
}

Machine& Machine::of(lua_State* state) {
  return **static_cast<Machine**>(lua_getextraspace(state));
}

bool Machine::load(std::string_view text, const std::string& shown, const std::string& name) {
  files_.push_back({"@" + shown, std::make_shared<const std::string>(name)});
  const bool good = luaL_loadbufferx(state_, text.data(), text.size(), files_.back().chunk.c_str(),
                                     "t") == LUA_OK;
  if (!good) files_.pop_back();
  return good;
}

Status Machine::call(int arguments, int results) {
  const int base = lua_gettop(state_) - arguments;
  lua_pushcfunction(state_, &Machine::add_traceback);
  lua_insert(state_, base);
  const int status = lua_pcall(state_, arguments, results, base);
  lua_remove(state_, base);
  if (status == LUA_OK) return {};
  const Error error = error_of(status);
  lua_pop(state_, 1);
  return error;
}

Error Machine::error_of(int status) {
  if (status == LUA_ERRMEM) stop_for_memory();
  if (stopped_) return {shown_lines(stop_text_)};
  size_t size = 0;
  const char* const text =
      lua_type(state_, -1) == LUA_TSTRING ? lua_tolstring(state_, -1, &size) : nullptr;
  return {shown_lines(text != nullptr ? std::string(text, size) : "an error without a text")};
}

int Machine::add_traceback(lua_State* state) {
  if (lua_type(state, 1) == LUA_TNUMBER) lua_tostring(state, 1);
  if (lua_type(state, 1) != LUA_TSTRING) {
    lua_pushfstring(state, "an error that is a %s, expected a text", luaL_typename(state, 1));
    lua_replace(state, 1);
  }
  luaL_traceback(state, state, lua_tostring(state, 1), 1);
  return 1;
}

void Machine::spend(uint64_t steps) {
  const uint64_t room = std::numeric_limits<uint64_t>::max() - steps_;
  steps_ += std::min(steps, room);
  if (steps_ >= next_look_ || is_spent() || stopped_) look();
}

void Machine::look() {
  next_look_ =
      steps_ + std::min(kStepsPerFunctionLook, std::numeric_limits<uint64_t>::max() - steps_);
  on_count(state_, nullptr);
}

void Machine::need(size_t bytes) {
  if (used_ <= limits_.memory && bytes <= limits_.memory - used_) return;
  stop(too_much_memory());
}

bool Machine::is_spent() const {
  const uint64_t allocated = taken_ / kBytesPerStep;
  return allocated > limits_.steps || steps_ > limits_.steps - allocated;
}

bool Machine::is_late() const { return thread_seconds() - begin_ > limits_.seconds; }

void Machine::on_count(lua_State* state, lua_Debug* where) {
  Machine& self = of(state);
  if (where != nullptr) self.steps_ += self.hurried_ ? 1 : kStepsPerLook;
  if (self.stopped_) {
    lua_pushlstring(state, self.stop_text_.data(), self.stop_text_.size());
    lua_error(state);
  }
  if (self.is_spent()) self.stop(self.too_many_steps());
  if (self.is_late()) self.stop(self.too_late());
}

std::string Machine::too_many_steps() const {
  return fmt::format("the script takes more than {} steps", format_count(limits_.steps));
}

std::string Machine::too_late() const {
  return fmt::format("the script takes more than {} of processor time",
                     format_duration(limits_.seconds));
}

std::string Machine::too_much_memory() const {
  return fmt::format("the script takes more than {} of memory", format_bytes(limits_.memory));
}

void Machine::stop(const std::string& why) {
  stopped_ = true;
  stop_text_ = line_now() + why;
  // From now on every instruction fails, so that whoever catches this gets no further.
  lua_sethook(state_, &Machine::on_count, LUA_MASKCOUNT, 1);
  luaL_traceback(state_, state_, stop_text_.c_str(), 0);
  stop_text_ = lua_tostring(state_, -1);
  lua_error(state_);
  std::abort();  // lua_error does not return, but is not declared so
}

void Machine::stop_for_memory() {
  if (stopped_) return;
  stopped_ = true;
  stop_text_ = refused_text_.empty() ? "not enough memory" : refused_text_;
  lua_sethook(state_, &Machine::on_count, LUA_MASKCOUNT, 1);
}

void* Machine::allocate(void* self, void* pointer, size_t old_size, size_t new_size) {
  auto& machine = *static_cast<Machine*>(self);
  if (new_size != 0) return machine.take(pointer, old_size, new_size);
  if (pointer == nullptr) return nullptr;
  machine.used_ -= old_size + sizeof(Header);
  std::free(static_cast<Header*>(pointer) - 1);
  return nullptr;
}

void* Machine::take(void* pointer, size_t old_size, size_t new_size) {
  // Of a new block Lua tells what it is for, and no size.
  const bool fresh = pointer == nullptr;
  const size_t before = fresh ? 0 : old_size + sizeof(Header);
  const size_t after = new_size + sizeof(Header);
  if (fresh && old_size == LUA_TSTRING && new_size > limits_.text) {
    refuse(fmt::format("a text of more than {}", format_bytes(limits_.text)));
    return nullptr;
  }
  if (after > before && used_ - before + after > limits_.memory) {
    refuse(too_much_memory());
    return nullptr;
  }
  void* const block = std::realloc(fresh ? nullptr : static_cast<Header*>(pointer) - 1, after);
  if (block == nullptr) return nullptr;
  auto* const header = static_cast<Header*>(block);
  used_ += after - before;
  if (after > before) taken_ += new_size;
  if (fresh) {
    *header = {++objects_, 0, 0};
    if (old_size == LUA_TTABLE) find_line(*header);
  }
  if (!hurried_ && is_spent() && state_ != nullptr) {
    hurried_ = true;
    lua_sethook(state_, &Machine::on_count, LUA_MASKCOUNT, 1);
  }
  return header + 1;
}

void Machine::refuse(std::string why) {
  if (state_ != nullptr) refused_text_ = line_now() + std::move(why);
}

std::string Machine::line_now() const {
  Header here{};
  find_line(here);
  if (here.line == 0) return files_.empty() ? "" : files_.front().chunk.substr(1) + ": ";
  return files_[here.file].chunk.substr(1) + ":" + std::to_string(here.line) + ": ";
}

void Machine::find_line(Header& header) const {
  if (state_ == nullptr) return;
  lua_Debug frame;
  for (int level = 0; level < kMostLevels && lua_getstack(state_, level, &frame) != 0; ++level) {
    // These two ask for nothing that Lua would have to allocate.
    lua_getinfo(state_, "Sl", &frame);
    if (frame.currentline <= 0) continue;
    for (size_t i = 0; i < files_.size(); ++i) {
      if (files_[i].chunk != frame.source) continue;
      header.file = static_cast<uint32_t>(i);
      header.line = static_cast<uint32_t>(frame.currentline);
      return;
    }
  }
}

YamlPlace Machine::made_at(const void* pointer) const {
  const Header& header = static_cast<const Header*>(pointer)[-1];
  if (header.line == 0) return {};
  return {files_[header.file].name, static_cast<int>(header.line), 0};
}

uint64_t Machine::age_of(const void* pointer) {
  return static_cast<const Header*>(pointer)[-1].age;
}

}  // namespace hyades::core::lua
