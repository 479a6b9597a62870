#include "farm/last_words.h"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>

namespace hyades::farm {
namespace {

const char* g_program = "";
const char* g_advice = "";

void say(const char* why) {
  std::fprintf(stderr, "%s stops: %s; %s\n", g_program, why, g_advice);
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
