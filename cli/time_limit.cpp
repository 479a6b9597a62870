#include "cli/time_limit.h"

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <ios>
#include <set>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "cli/part.h"
#include "core/base/atomic_file.h"

namespace hyades::cli {
namespace {

/// The share of the time that trying may take, and what is kept for frames that cost more than
/// those tried, and for writing them.
constexpr double kTrying = 0.05, kReserve = 0.05;
constexpr double kLeastTry = 0.2, kLongestTry = 10.0;  // seconds, of a frame

}  // namespace

TimeLimit::TimeLimit(const RenderOptions& options, std::string file,
                     std::chrono::steady_clock::time_point began)
    : options_(options), file_(std::move(file)), began_(began) {}

std::string TimeLimit::command() const {
  return fmt::format("{} s of frames {}", options_.time, options_.frames);
}

uint32_t TimeLimit::chosen_before() const {
  if (options_.restart) return 0;
  // The folder may be somebody else's: no more is read than is looked for.
  const std::string begin = command() + "\n";
  std::string noted(begin.size() + 10, '\0');
  std::ifstream file(file_, std::ios::binary);
  file.read(noted.data(), static_cast<std::streamsize>(noted.size()));
  noted.resize(static_cast<size_t>(file.gcount()));
  if (!noted.starts_with(begin) || !noted.ends_with('\n')) return 0;
  noted.pop_back();
  const auto samples = parse_samples(noted.substr(begin.size()));
  return samples && !samples->range ? samples->of : 0;
}

core::Result<uint32_t> TimeLimit::samples(JobFrames& frames, const std::vector<int32_t>& numbers) {
  samples_ = chosen_before();
  if (samples_ == 0) {
    const auto chosen = choose(frames, numbers);
    if (!chosen) return chosen.error();
    samples_ = *chosen;
  }
  return samples_;
}

core::Result<uint32_t> TimeLimit::choose(JobFrames& frames,
                                         const std::vector<int32_t>& numbers) const {
  const std::set<int32_t> tried{numbers.front(), numbers[numbers.size() / 2], numbers.back()};
  const double time = std::clamp(options_.time * kTrying / static_cast<double>(tried.size()),
                                 kLeastTry, kLongestTry);
  double cost = 0;
  for (const int32_t frame : tried) {
    const auto seconds = frames.seconds_per_sample(frame, options_.threads, time);
    if (!seconds) return seconds.error();
    cost += *seconds / static_cast<double>(tried.size());
  }
  const std::chrono::duration<double> gone = std::chrono::steady_clock::now() - began_;
  const double left = (options_.time - gone.count()) * (1.0 - kReserve);
  const double pixels =
      static_cast<double>(frames.window().area()) * static_cast<double>(numbers.size());
  return static_cast<uint32_t>(std::clamp(left / (cost * pixels), 1.0, double{kMostSamples}));
}

void TimeLimit::write() const {
  if (samples_ == 0 || !options_.keep_work) return;
  const std::string text = fmt::format("{}\n{}\n", command(), samples_);
  (void)core::write_file(file_, std::as_bytes(std::span(text)));
}

}  // namespace hyades::cli
