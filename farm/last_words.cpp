#include "farm/last_words.h"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>

#include "farm/log.h"

namespace hyades::farm {
namespace {

const char* g_program = "";
const char* g_advice = "";

/// Text as JSON has it between quotes, as far as there is room; takes no memory.
class Quoted {
 public:
  void add(const char* text) {
    for (; *text != 0 && length_ + 3 < buffer_.size(); ++text) {
      const auto c = static_cast<unsigned char>(*text);
      if (c == '"' || c == '\\') buffer_[length_++] = '\\';
      // What is not ASCII may be no UTF-8.
      buffer_[length_++] = c < ' ' || c >= 127 ? ' ' : static_cast<char>(c);
    }
  }
  const char* text() const { return buffer_.data(); }

 private:
  std::array<char, 1000> buffer_{};
  size_t length_ = 0;
};

void say(const char* why) {
  if (log_format() == LogFormat::json) {
    Quoted text;
    for (const char* part : {"stops: ", why, "; ", g_advice}) text.add(part);
    std::fprintf(stderr, "{\"level\":\"error\",\"program\":\"%s\",\"text\":\"%s\"}\n", g_program,
                 text.text());
  } else {
    std::fprintf(stderr, "%s stops: %s; %s\n", g_program, why, g_advice);
  }
  std::abort();
}

[[noreturn]] void die() {
  try {
    if (const std::exception_ptr thrown = std::current_exception()) std::rethrow_exception(thrown);
  } catch (const std::bad_alloc&) {
    say("it has no memory left");
  } catch (const std::exception& e) {
    say(e.what());
  } catch (...) {
  }
  say("a mistake in the program");
  std::abort();
}

}  // namespace

void die_with_words(const char* program, const char* advice) {
  g_program = program;
  g_advice = advice;
  std::set_terminate(die);
}

}  // namespace hyades::farm
