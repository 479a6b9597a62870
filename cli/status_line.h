#pragma once

#include <chrono>
#include <functional>
#include <string>

namespace hyades::cli {

/// A bar of blocks, filled by `share` (0 to 1).
std::string progress_bar(double share);

/// `text` in so many columns of a terminal: a bar in it gets shorter, or goes, before the end is
/// cut.
std::string fitted(std::string text, int columns);

/// One line of standard error that is drawn again and again, where that is a terminal; elsewhere a
/// plain line every ten seconds.
class StatusLine {
 public:
  using Clock = std::chrono::steady_clock;

  explicit StatusLine(std::function<Clock::time_point()> now = Clock::now);
  ~StatusLine() { clear(); }
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;

  /// Whether lines can be drawn again: there is room for a bar.
  bool redraws() const { return terminal_; }

  /// Whether the last line is long enough ago.
  bool is_due() const;

  /// Draws `text`, fitted() to the terminal's width, or prints it where nothing can be drawn again.
  void show(const std::string& text);

  /// Removes the line, so that other text can be written.
  void clear();

 private:
  std::function<Clock::time_point()> now_;
  bool terminal_;
  bool drawn_ = false;
  Clock::time_point last_;
};

/// How much of some work is done and how long the rest will take, in a StatusLine that is as long
/// there as this is; nothing where `quiet`.
class ShareDone {
 public:
  explicit ShareDone(bool quiet) : quiet_(quiet) {}

  /// `share`: 0 to 1.
  void show(double share);
  /// Removes the line, so that other text can be written.
  void clear() { line_.clear(); }

 private:
  bool quiet_;
  StatusLine line_;
  StatusLine::Clock::time_point begun_ = StatusLine::Clock::now();
};

}  // namespace hyades::cli
