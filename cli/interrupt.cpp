#include "cli/interrupt.h"

#include <poll.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstddef>
#include <cstring>

namespace hyades::cli {
namespace {

constexpr unsigned kPatience = 1;  // seconds

volatile std::sig_atomic_t g_signals = 0;

// Two, so that a handler never reads what is being written.
std::array<std::array<char, 200>, 2> g_words{{{"interrupted\n"}, {}}};
std::atomic<size_t> g_current{0};
static_assert(std::atomic<size_t>::is_always_lock_free);

// Handlers call only what POSIX allows in them.

void leave() {
  // A terminal that is stopped, or a pipe that nobody reads, must not hold it up.
  pollfd out{STDERR_FILENO, POLLOUT, 0};
  if (::poll(&out, 1, 0) > 0) {
    const char* clear = "\r\033[K";  // the line of progress
    if (::isatty(STDERR_FILENO) == 1) (void)!::write(STDERR_FILENO, clear, std::strlen(clear));
    const char* words = interrupted_words();
    (void)!::write(STDERR_FILENO, words, std::strlen(words));
  }
  ::_exit(kInterrupted);
}

void on_signal(int) {
  g_signals = g_signals + 1;
  if (g_signals > 1) leave();
  ::alarm(kPatience);
}

void on_alarm(int) { leave(); }

}  // namespace

void watch_for_interrupts() {
  struct sigaction action {};
  action.sa_flags = SA_RESTART;
  action.sa_handler = on_alarm;
  sigaction(SIGALRM, &action, nullptr);
  action.sa_handler = on_signal;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

void set_interrupted_words(const std::string& words) {
  const size_t next = 1 - g_current;
  std::array<char, 200>& room = g_words[next];
  room[words.copy(room.data(), room.size() - 1)] = '\0';
  g_current = next;
}

const char* interrupted_words() { return g_words[g_current].data(); }

bool interrupted() { return g_signals > 0; }

}  // namespace hyades::cli
