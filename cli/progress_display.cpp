#include "cli/progress_display.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/base/text.h"

namespace hyades::cli {
namespace {

double fraction(const coordinator::Progress& p) {
  return p.samples > 0 ? static_cast<double>(p.samples_done) / static_cast<double>(p.samples) : 0.0;
}

}  // namespace

std::string percent_done(const coordinator::Progress& progress) {
  return fmt::format("{:.0f} %", std::floor(100.0 * fraction(progress)));
}

ProgressDisplay::ProgressDisplay(std::string name, bool quiet)
    : name_(std::move(name)), quiet_(quiet) {}

std::string progress_line(const std::string& name, const coordinator::Progress& p, bool bar) {
  const double done = fraction(p);
  std::string text = name + "  ";
  if (bar) text += progress_bar(done) + "  ";
  text += fmt::format("{:3.0f} %", 100.0 * done);
  if (p.frames > 1)
    text += fmt::format("  frame {}/{}", std::min(p.frames_done + 1, p.frames), p.frames);
  // In front: a line that is cut to the terminal's width still says why nothing happens.
  if (!p.trouble.empty()) return text + "  " + p.trouble;
  if (p.frames_finishing > 0 && p.samples_done >= p.samples) {
    text += "  making the outputs";
    if (p.frames > 1) text += " of " + core::counted(p.frames_finishing, "frame");
    // That of the rendering, which is over, says nothing.
    if (p.seconds_left > 0.0) text += "  " + core::format_time_left(p.seconds_left) + " left";
    return text;
  }
  if (p.samples_per_second > 0.0) text += "  " + core::format_rate(p.samples_per_second, "samples");
  if (p.noise >= 0.0) text += "  noise " + core::format_noise(p.noise);
  if (p.noise_aim > 0.0) text += " (aim " + core::format_noise(p.noise_aim) + ")";
  if (p.seconds_left >= 0.0) text += "  " + core::format_time_left(p.seconds_left) + " left";
  return text;
}

void ProgressDisplay::update(const coordinator::Progress& progress) {
  if (quiet_) return;
  if (status_.redraws()) {
    if (status_.is_due()) status_.show(progress_line(name_, progress, status_.redraws()));
    return;
  }
  const Far far(static_cast<int>(100.0 * fraction(progress)), progress.frames_done,
                progress.frames_finishing > 0);
  // Why nothing happens is said at once, but once.
  const bool at_once = !progress.trouble.empty() && progress.trouble != told_;
  if (!at_once && (far == told_far_ || !status_.is_due())) return;
  if (at_once) told_ = progress.trouble;
  told_far_ = far;
  status_.show(progress_line(name_, progress, status_.redraws()));
}

void ProgressDisplay::clear() { status_.clear(); }

}  // namespace hyades::cli
