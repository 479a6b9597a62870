#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cli/client/client_app.h"
#include "cli/client/find_job.h"
#include "cli/client/top_page.h"
#include "cli/client_commands.h"
#include "cli/number_range.h"
#include "core/base/wall_clock.h"

namespace hyades::cli {
namespace {

constexpr double kLeastInterval = 0.2;

volatile std::sig_atomic_t g_top_ends = 0;

void end_top(int) { g_top_ends = 1; }

/// The terminal's other screen, without echo, until this is destroyed.
class Screen {
 public:
  Screen() {
    tcgetattr(STDIN_FILENO, &before_);
    termios raw = before_;
    raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    tcsetattr(STDIN_FILENO, TCSANOW, &raw);
    struct sigaction action {};
    action.sa_handler = end_top;  // without SA_RESTART: what waits is woken
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    std::fputs("\033[?1049h\033[?25l", stdout);
  }
  ~Screen() {
    std::fputs("\033[?25h\033[?1049l", stdout);
    std::fflush(stdout);
    tcsetattr(STDIN_FILENO, TCSANOW, &before_);
  }
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  static void draw(const std::vector<std::string>& lines) {
    std::string all = "\033[H";
    for (size_t i = 0; i < lines.size(); ++i) all += (i == 0 ? "" : "\r\n") + lines[i];
    all += "\033[J";
    std::fwrite(all.data(), 1, all.size(), stdout);
    std::fflush(stdout);
  }

  /// Whether somebody has asked for the end meanwhile.
  static bool wait(double seconds) {
    pollfd keys{STDIN_FILENO, POLLIN, 0};
    if (g_top_ends == 0 && poll(&keys, 1, static_cast<int>(seconds * 1000)) > 0) {
      // An arrow or a function key is several bytes, of which the first is that of Escape.
      char keys_read[64];
      const ssize_t count = ::read(STDIN_FILENO, keys_read, sizeof keys_read);
      if (count <= 0) return true;
      const char key = keys_read[0];
      return key == 'q' || key == 'Q' || (key == 27 && count == 1);
    }
    return g_top_ends != 0;
  }

 private:
  termios before_{};
};

winsize terminal_size() {
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0 || size.ws_row == 0) {
    size.ws_col = 160;
    size.ws_row = 60;
  }
  return size;
}

/// Whether there is a terminal on both sides that can be drawn on more than once.
bool can_draw_again() {
  const char* term = std::getenv("TERM");
  return isatty(STDOUT_FILENO) == 1 && isatty(STDIN_FILENO) == 1 && term != nullptr &&
         std::string_view(term) != "dumb";
}

bool shows_colors() {
  const char* none = std::getenv("NO_COLOR");
  return isatty(STDOUT_FILENO) == 1 && (none == nullptr || *none == '\0');
}

Outcome look(FarmClient& client, FarmNow& now) {
  std::vector<v1::Job> jobs;
  if (auto failure = list_all_jobs(client, false, {}, jobs)) return failure;
  v1::WorkersResponse workers;
  if (auto failure = client.workers(workers)) return failure;
  now.jobs = std::move(jobs);
  now.workers.assign(workers.workers().begin(), workers.workers().end());
  now.time_ms = core::wall_ms();
  return std::nullopt;
}

Outcome show_once(FarmClient& client, const std::string& address) {
  FarmNow now;
  if (auto failure = look(client, now)) return failure;
  const int rows = static_cast<int>(now.jobs.size() + now.workers.size()) + 8;
  for (const std::string& line : top_page(now, address, 160, rows, false)) {
    const size_t end = line.find_last_not_of(' ');
    std::printf("%s\n", line.substr(0, end + 1).c_str());
  }
  return std::nullopt;
}

/// `client` is for the first look; `again`, which answers at once, for all others.
Outcome show_always(FarmClient& client, FarmClient& again, const std::string& address,
                    double interval) {
  const bool colors = shows_colors();
  FarmNow now;
  if (auto failure = look(client, now)) return failure;
  const Screen screen;
  for (bool reached = true;;) {
    const winsize size = terminal_size();
    std::vector<std::string> page =
        top_page(now, address, size.ws_col, size.ws_row - (reached ? 0 : 1), colors);
    // What was there last stays in sight meanwhile.
    if (!reached) page.push_back("no answer from " + address + ": trying again; q ends");
    Screen::draw(page);
    if (Screen::wait(interval)) return std::nullopt;
    const Outcome failure = look(again, now);
    reached = !failure;
    if (failure && failure->code != kNoAnswer) return failure;
  }
}

}  // namespace

int top_command(int argc, char** argv) {
  ClientApp app("top",
                "Shows jobs and workers as they change; once, where the output is no terminal.");
  double interval = 1;
  bool once = false;
  app.app()
      .add_option("--interval", interval, "seconds between two looks")
      ->check(in_range(kLeastInterval, 3600.0))
      ->capture_default_str();
  app.app().add_flag("--once", once, "print it once and end");
  app.give_examples(
      {"hyades top", "hyades top --coordinator farm:7700 --interval 5", "hyades top --once | head"},
      "q ends it. NO_COLOR in the environment turns colours off.");
  if (const auto status = app.parse(argc, argv)) return *status;
  const auto client = app.connect();
  const auto again = app.connect_impatiently();
  if (!client || !again) return kBadArguments;
  const Outcome failure = once || !can_draw_again()
                              ? show_once(*client, app.address())
                              : show_always(*client, *again, app.address(), interval);
  return failure ? app.report(*failure) : kDone;
}

}  // namespace hyades::cli
