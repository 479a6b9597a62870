#include "cli/status_line.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <utility>

namespace hyades::cli {
namespace {

constexpr auto kRedraw = std::chrono::milliseconds(150);
constexpr auto kPlainEvery = std::chrono::seconds(10);
constexpr int kBarWidth = 24;

bool is_terminal() {
  const char* term = std::getenv("TERM");
  return isatty(STDERR_FILENO) == 1 && term != nullptr && std::string(term) != "dumb";
}

int terminal_width() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace

std::string progress_bar(double share) {
  const int filled = static_cast<int>(share * kBarWidth);
  std::string bar;
  for (int i = 0; i < kBarWidth; ++i) bar += i < filled ? "█" : "░";
  return bar;
}

StatusLine::StatusLine(std::function<Clock::time_point()> now)
    : now_(std::move(now)), terminal_(is_terminal()), last_(now_()) {}

bool StatusLine::is_due() const {
  if (!terminal_) return now_() - last_ >= kPlainEvery;
  return !drawn_ || now_() - last_ >= kRedraw;
}

void StatusLine::show(const std::string& text) {
  last_ = now_();
  if (!terminal_) {
    std::fprintf(stderr, "%s\n", text.c_str());
    return;
  }
  drawn_ = true;
  // Cut by characters, not bytes: the bar's blocks take three bytes each.
  int columns = terminal_width() - 1;
  size_t end = 0;
  for (; end < text.size() && columns > 0; ++end) {
    if ((static_cast<unsigned char>(text[end]) & 0xC0U) != 0x80U && columns-- == 0) break;
  }
  while (end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) ++end;
  std::fprintf(stderr, "\r\033[K%s", text.substr(0, end).c_str());
  std::fflush(stderr);
}

void StatusLine::clear() {
  if (drawn_) std::fprintf(stderr, "\r\033[K");
  drawn_ = false;
}

}  // namespace hyades::cli
