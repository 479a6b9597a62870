#include "cli/client/watch.h"

#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <thread>

#include <fmt/format.h>

#include "cli/client/find_job.h"
#include "cli/client/show.h"
#include "cli/progress_display.h"
#include "core/base/text.h"
#include "farm/job_state.h"

namespace hyades::cli {
namespace {

constexpr size_t kMostFramesTold = 10;
constexpr auto kStreamEnded = std::chrono::milliseconds(500);

/// What Ctrl-C says, made before the handler may need it.
char g_farewell[160];

void on_interrupt(int) {
  // Nothing is left to be done where even this cannot be said.
  [[maybe_unused]] const auto said = ::write(STDERR_FILENO, g_farewell, std::strlen(g_farewell));
  ::_exit(kInterrupted);
}

void leave_job_running_on_interrupt(uint64_t id) {
  const std::string text = fmt::format(
      "\nthe job goes on: hyades watch {} shows it again, hyades cancel {} ends it\n", id, id);
  std::strncpy(g_farewell, text.c_str(), sizeof g_farewell - 1);
  struct sigaction action {};
  action.sa_handler = on_interrupt;
  sigaction(SIGINT, &action, nullptr);
}

coordinator::Progress progress_of(const v1::Job& job) {
  coordinator::Progress progress;
  progress.frames = job.frames();
  progress.frames_done = job.frames_done();
  progress.frames_failed = job.frames_failed();
  progress.frames_finishing = job.frames_finishing();
  progress.samples = job.samples();
  progress.samples_done = job.samples_done();
  progress.samples_per_second = job.samples_per_second();
  progress.seconds_left = job.seconds_left();
  if (job.has_noise()) progress.noise = job.noise();
  progress.noise_aim = job.noise_aim();
  progress.trouble = job_trouble(job);
  return progress;
}

/// Follows one job.
class Watcher {
 public:
  explicit Watcher(bool quiet) : quiet_(quiet) {}

  void take(const v1::WatchEvent& event) {
    job_ = event.job();
    more_ = event.more();
    for (const v1::Frame& frame : event.changed()) {
      failed_.erase(frame.frame());
      if (frame.state() != v1::FRAME_STATE_FAILED) continue;
      failed_[frame.frame()] = frame.reason();
      // The others are only counted, whatever number of them the coordinator tells of.
      if (failed_.size() > kMostFramesTold) failed_.erase(std::prev(failed_.end()));
    }
    if (!display_)
      display_ = std::make_unique<ProgressDisplay>(core::printable(job_.name()), quiet_);
    if (!farm::has_ended(job_)) display_->update(progress_of(job_));
  }

  bool ended() const { return farm::has_ended(job_) && !more_; }

  /// Makes room for another line.
  void clear() {
    if (display_) display_->clear();
  }

  Outcome verdict() {
    clear();
    if (job_.state() == v1::JOB_STATE_DONE) {
      if (!quiet_) {
        std::fprintf(stderr, "job %lu is done: %s in %s; hyades fetch %lu brings them\n", job_.id(),
                     core::counted(job_.frames_done(), "frame").c_str(),
                     core::format_duration(seconds_taken(job_).value_or(0)).c_str(), job_.id());
      }
      return std::nullopt;
    }
    for (const auto& [frame, reason] : failed_) {
      std::fprintf(stderr, "frame %d failed: %s\n", frame, core::printable(reason).c_str());
    }
    if (job_.frames_failed() > failed_.size()) {
      std::fprintf(stderr, "... and %zu more (hyades status %lu)\n",
                   job_.frames_failed() - failed_.size(), job_.id());
    }
    const std::string why = job_.reason().empty() ? "" : ": " + core::printable(job_.reason());
    if (job_.state() == v1::JOB_STATE_CANCELLED) {
      return Failure{kCancelled, fmt::format("job {} was cancelled{}", job_.id(), why)};
    }
    return Failure{
        kFailed, fmt::format("job {} failed: {} of {} are done{}; hyades retry {} renders the rest",
                             job_.id(), job_.frames_done(), core::counted(job_.frames(), "frame"),
                             why, job_.id())};
  }

 private:
  bool quiet_;
  v1::Job job_;
  bool more_ = false;                      ///< the last event was not all
  std::map<int32_t, std::string> failed_;  ///< reasons of the first by frame
  std::unique_ptr<ProgressDisplay> display_;
};

/// Of a job that is done the first thing that its log warns of in a picture, and how many more
/// there are: frames that are black, say. What workers went through is not told.
void tell_warnings(FarmClient& client, uint64_t id) {
  v1::LogsRequest request;
  request.set_job(id);
  std::string first;
  size_t count = 0;
  const Outcome failure = client.logs(request, [&](const v1::LogLine& line) {
    if (line.level() != v1::LOG_LEVEL_WARNING || !line.of_frame() || !line.worker().empty()) {
      return true;
    }
    if (++count == 1) {
      first = fmt::format("frame {} {}", line.frame(), core::printable(line.text()));
    }
    return true;
  });
  if (failure || count == 0) return;  // the job is done all the same
  const std::string others =
      count > 1 ? fmt::format(" (and {}: hyades logs {})", core::counted(count - 1, "other"), id)
                : "";
  std::fprintf(stderr, "warning: %s%s\n", first.c_str(), others.c_str());
}

}  // namespace

Outcome watch_job(FarmClient& client, uint64_t id, bool quiet, v1::Job* last, FilmDisplay* films,
                  Viewer* viewer) {
  leave_job_running_on_interrupt(id);
  Watcher watcher(quiet);
  const auto tell = [&](const std::string& text) {
    watcher.clear();
    std::fprintf(stderr, "%s\n", text.c_str());
  };
  client.on_notice(tell);
  Outcome outcome;
  while (!outcome && !watcher.ended()) {
    outcome = client.watch(id, [&](const v1::WatchEvent& event) {
      watcher.take(event);
      if (last != nullptr) *last = event.job();
      if (films != nullptr) films->take(event);
      if (const auto notice = viewer != nullptr ? viewer->take_notice() : std::nullopt) {
        tell(*notice);
      }
      return !watcher.ended();
    });
    // A coordinator that ends the stream in order before the job has ended is about to stop.
    if (!outcome && !watcher.ended()) std::this_thread::sleep_for(kStreamEnded);
  }
  watcher.clear();
  if (outcome) return outcome;
  const Outcome verdict = watcher.verdict();
  if (!verdict && !quiet) tell_warnings(client, id);
  return verdict;
}

}  // namespace hyades::cli
