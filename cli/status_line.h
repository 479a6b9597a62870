#pragma once

#include <chrono>
#include <string>

namespace hyades::cli {

/// A bar of blocks, filled by `share` (0 to 1).
std::string progress_bar(double share);

/// One line of standard error that is drawn again and again, where that is a terminal.
class StatusLine {
 public:
  StatusLine();
  ~StatusLine() { clear(); }
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;

  /// Whether lines can be drawn again at all; if not, show() prints nothing.
  bool redraws() const { return terminal_; }

  /// Whether the last drawing is long enough ago for the eye.
  bool is_due() const;

  /// Draws `text`, cut to the terminal's width.
  void show(const std::string& text);

  /// Removes the line, so that other text can be written.
  void clear();

 private:
  bool terminal_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point last_;
};

}  // namespace hyades::cli
