#include "cli/status_line.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "core/base/text.h"

namespace hyades::cli {
namespace {

constexpr auto kRedraw = std::chrono::milliseconds(150);
constexpr auto kPlainEvery = std::chrono::seconds(10);
constexpr int kBarWidth = 24;
constexpr int kShortestBar = 6;
constexpr std::string_view kFull = "█";
constexpr std::string_view kEmpty = "░";

bool is_terminal() {
  const char* term = std::getenv("TERM");
  return isatty(STDERR_FILENO) == 1 && term != nullptr && std::string(term) != "dumb";
}

int terminal_width() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

std::string bar_of(int filled, int width) {
  std::string bar;
  for (int i = 0; i < width; ++i) bar += i < filled ? kFull : kEmpty;
  return bar;
}

bool begins_character(char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }

/// Characters, not bytes: the bar's blocks take three bytes each.
int columns_of(std::string_view text) {
  return static_cast<int>(std::count_if(text.begin(), text.end(), begins_character));
}

}  // namespace

std::string progress_bar(double share) {
  return bar_of(static_cast<int>(share * kBarWidth), kBarWidth);
}

std::string fitted(std::string text, int columns) {
  const auto block_at = [&](size_t at) -> std::string_view {
    const std::string_view rest = std::string_view(text).substr(at);
    return rest.starts_with(kFull) ? kFull : rest.starts_with(kEmpty) ? kEmpty : "";
  };
  const int over = columns_of(text) - columns;
  const size_t first = std::min(text.find(kFull), text.find(kEmpty));
  if (over > 0 && first != std::string::npos) {
    int width = 0;
    int filled = 0;
    size_t end = first;
    for (std::string_view block = block_at(end); !block.empty(); block = block_at(end)) {
      ++width;
      filled += block == kFull ? 1 : 0;
      end += block.size();
    }
    const int left = width - over;
    if (left >= kShortestBar) {
      text.replace(first, end - first, bar_of(filled * left / width, left));
    } else {
      text.erase(first, text.find_first_not_of(' ', end) - first);
    }
  }
  size_t end = 0;
  for (int room = columns; end < text.size(); ++end) {
    if (begins_character(text[end]) && room-- == 0) break;
  }
  return text.substr(0, end);
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
  std::fprintf(stderr, "\r\033[K%s", fitted(text, terminal_width() - 1).c_str());
  std::fflush(stderr);
}

void StatusLine::clear() {
  if (drawn_) std::fprintf(stderr, "\r\033[K");
  drawn_ = false;
}

void ShareDone::show(double share) {
  if (quiet_ || !line_.is_due()) return;
  const std::string bar = line_.redraws() ? progress_bar(share) + "  " : "";
  const std::chrono::duration<double> gone = StatusLine::Clock::now() - begun_;
  const std::string left =
      share > 0.0 ? "  " + core::format_time_left(gone.count() * (1.0 - share) / share) + " left"
                  : "";
  line_.show(fmt::format("{}{:3.0f} %{}", bar, 100.0 * share, left));
}

}  // namespace hyades::cli
