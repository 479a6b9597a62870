#include "cli/client/trace_writer.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "core/film/unit.h"

namespace hyades::cli {
namespace {

using farm::Json;

constexpr int kCoordinator = 1;
/// Threads of the coordinator, and where lanes begin of each kind that may run side by side.
constexpr int kJobThread = 1;
constexpr int kMergeThread = 10;
constexpr int kFinishThread = 100;
constexpr int kVideoThread = 200;
/// Lanes of workers that do not tell their threads.
constexpr int kUntoldThread = 10'000;
constexpr int kMostLanes = 64;
constexpr size_t kMostHeld = 20'000;
/// What a coordinator may tell, be it hostile, and what is kept of it.
constexpr size_t kMostWorkers = 20'000;
constexpr size_t kMostNameBytes = 200;
constexpr int64_t kSecond = 1'000'000;
/// Who has the slices of workers beyond kMostWorkers.
const std::string kOtherWorkers = "others";

}  // namespace

TraceWriter::TraceWriter(std::ostream& out, const v1::Job& job)
    : out_(out),
      frame_samples_(job.frames() > 0 ? job.samples() / job.frames() : 0),
      epoch_us_(job.submitted_ms() * 1000) {
  coordinator_.pid = kCoordinator;
  out_ << "{\"displayTimeUnit\":\"ms\",\"traceEvents\":[\n";
  write({{"ph", "M"},
         {"name", "process_name"},
         {"pid", kCoordinator},
         {"args", {{"name", "coordinator"}}}});
  name_thread(coordinator_, kJobThread, "job");
}

void TraceWriter::write(const Json& event) {
  if (!std::exchange(first_, false)) out_ << ",\n";
  // What is no UTF-8 becomes a replacement character, not an exception.
  out_ << event.dump(-1, ' ', false, Json::error_handler_t::replace);
}

TraceWriter::Process& TraceWriter::worker(const std::string& name) {
  const bool room = workers_.size() < kMostWorkers || workers_.contains(name);
  const auto [entry, fresh] = workers_.try_emplace(room ? name : kOtherWorkers);
  if (fresh) {
    entry->second.pid = kCoordinator + static_cast<int>(workers_.size());
    write({{"ph", "M"},
           {"name", "process_name"},
           {"pid", entry->second.pid},
           {"args", {{"name", "worker " + name}}}});
  }
  return entry->second;
}

void TraceWriter::name_thread(const Process& process, int tid, const std::string& name) {
  write({{"ph", "M"},
         {"name", "thread_name"},
         {"pid", process.pid},
         {"tid", tid},
         {"args", {{"name", name}}}});
}

/// The first thread from `first` on that was free at `begun`; a new one where none was.
int TraceWriter::lane(Process& process, int first, int64_t begun, const char* name) {
  int tid = first;
  for (; tid < first + kMostLanes - 1; ++tid) {
    const auto known = process.ends.find(tid);
    if (known == process.ends.end()) {
      name_thread(process, tid, name);
      break;
    }
    if (known->second <= begun) break;
  }
  return tid;
}

/// The thread of a worker that tells them. Workers may share a name: where most of the slice lies
/// in another one's time it is a namesake's.
int TraceWriter::told_thread(Process& process, const v1::TimelineStep& step) {
  const auto thread = static_cast<int>(step.thread() % kUntoldThread);
  const int64_t middle = (step.begun_us() + step.ended_us()) / 2 - epoch_us_;
  for (int namesake = 0; namesake < kMostLanes; ++namesake) {
    const int tid = thread + namesake * 2 * kUntoldThread;
    const auto known = process.ends.find(tid);
    if (known == process.ends.end()) {
      name_thread(process, tid, fmt::format("thread {}", thread));
      return tid;
    }
    if (known->second <= middle) return tid;
  }
  return thread;
}

void TraceWriter::take(const v1::TimelineStep& told) {
  v1::TimelineStep step = told;
  // Another string: one that is only shortened keeps its memory.
  if (told.worker().size() > kMostNameBytes) {
    *step.mutable_worker() = told.worker().substr(0, kMostNameBytes);
  }
  if (holding_) learn_samples(step);
  if (holding_) {
    held_.push_back(std::move(step));
    if (held_.size() >= kMostHeld) flush_held();
    return;
  }
  write_step(step);
}

/// A frame that is finished has all its pixels: with how many samples all of it has, that says how
/// many each has.
void TraceWriter::learn_samples(const v1::TimelineStep& step) {
  const v1::Unit& unit = step.unit();
  if (step.kind() == v1::TimelineStep::KIND_RENDER) {
    Frame& frame = frames_[unit.frame()];
    frame.batches = std::max(frame.batches, unit.first_batch() + unit.batches());
    if (unit.first_batch() > 0) return;
    const v1::PixelRect& tile = unit.tile();
    frame.pixels += int64_t{tile.x1() - tile.x0()} * (tile.y1() - tile.y0());
    return;
  }
  if (step.kind() != v1::TimelineStep::KIND_FINISH) return;
  const auto finished = frames_.extract(unit.frame());
  if (!finished || finished.mapped().pixels <= 0) return;
  const auto pixels = static_cast<uint64_t>(finished.mapped().pixels);
  const uint64_t each = frame_samples_ / pixels;
  // Some of the frame's units may not have come, or twice.
  if (each * pixels != frame_samples_ || each > UINT32_MAX ||
      core::batch_count(static_cast<uint32_t>(each)) != finished.mapped().batches) {
    return;
  }
  samples_per_pixel_ = static_cast<uint32_t>(each);
  flush_held();
}

void TraceWriter::flush_held() {
  holding_ = false;
  frames_.clear();
  for (const v1::TimelineStep& step : std::exchange(held_, {})) write_step(step);
}

uint64_t TraceWriter::samples_of(const v1::Unit& unit) const {
  const v1::PixelRect& tile = unit.tile();
  return core::samples_in({tile.x0(), tile.y0(), tile.x1(), tile.y1()},
                          {unit.first_batch(), unit.batches()},
                          samples_per_pixel_ > 0 ? samples_per_pixel_ : UINT32_MAX);
}

void TraceWriter::write_step(const v1::TimelineStep& step) {
  const v1::Unit& unit = step.unit();
  const v1::PixelRect& tile = unit.tile();
  const std::string frame = fmt::format("frame {}", unit.frame());
  const int64_t begun = step.begun_us() - epoch_us_;
  Json arguments;
  if (step.kind() == v1::TimelineStep::KIND_RENDER || step.kind() == v1::TimelineStep::KIND_MERGE) {
    arguments = {{"frame", unit.frame()},
                 {"tile", {tile.x0(), tile.y0(), tile.x1(), tile.y1()}},
                 {"first_batch", unit.first_batch()},
                 {"batches", unit.batches()}};
  }
  switch (step.kind()) {
    case v1::TimelineStep::KIND_RENDER: {
      const uint64_t samples = samples_of(unit);
      arguments["samples"] = samples;
      arguments["result"] = "counted";
      Process& process = worker(step.worker());
      const int tid = step.thread() == 0 ? lane(process, kUntoldThread, begun, "a thread")
                                         : told_thread(process, step);
      write_slice(process, tid, step, frame, "render", std::move(arguments));
      ++units_;
      count(step.ended_us(), samples);
      break;
    }
    case v1::TimelineStep::KIND_MERGE:
      write_slice(coordinator_, lane(coordinator_, kMergeThread, begun, "merging"), step,
                  "merge " + frame, "merge", std::move(arguments));
      break;
    case v1::TimelineStep::KIND_FINISH:
      write_slice(coordinator_, lane(coordinator_, kFinishThread, begun, "finishing"), step,
                  "finish " + frame, "finish", {{"frame", unit.frame()}});
      break;
    case v1::TimelineStep::KIND_VIDEO:
      write_slice(coordinator_, lane(coordinator_, kVideoThread, begun, "video"), step, "video",
                  "video", Json::object());
      break;
    default:
      break;  // of a newer coordinator
  }
}

void TraceWriter::write_slice(Process& process, int tid, const v1::TimelineStep& step,
                              const std::string& name, const char* category, Json arguments) {
  int64_t& last = process.ends.try_emplace(tid, INT64_MIN).first->second;
  const int64_t told = step.begun_us() - epoch_us_;
  // A film takes some time to come, one more than another: a thread does one thing after the other.
  const int64_t begun = std::max(told, last);
  const int64_t ended = std::max(step.ended_us() - epoch_us_, begun);
  last = ended;
  if (begun != told) arguments["took_us"] = step.ended_us() - step.begun_us();
  write({{"ph", "X"},
         {"name", name},
         {"cat", category},
         {"pid", process.pid},
         {"tid", tid},
         {"ts", begun},
         {"dur", ended - begun},
         {"args", std::move(arguments)}});
}

void TraceWriter::count(int64_t ended_us, uint64_t samples) {
  samples_ += samples;
  const int64_t second = std::max<int64_t>(ended_us - epoch_us_, 0) / kSecond;
  if (second > second_) {
    if (second_ >= 0) {
      write_rate(second_, in_second_);
      if (second > second_ + 1) write_rate(second_ + 1, 0);
    }
    second_ = second;
    in_second_ = 0;
  }
  in_second_ += samples;
}

void TraceWriter::write_rate(int64_t second, uint64_t samples) {
  write({{"ph", "C"},
         {"name", "samples/s"},
         {"pid", kCoordinator},
         {"ts", second * kSecond},
         {"args", {{"samples/s", samples}}}});
}

void TraceWriter::take(const v1::LogLine& line) {
  if (holding_) flush_held();
  const auto known = workers_.find(line.worker().substr(0, kMostNameBytes));
  Json arguments = {{"level", farm::level_name(line.level())}};
  if (!line.worker().empty()) arguments["worker"] = line.worker();
  if (line.of_frame()) arguments["frame"] = line.frame();
  write({{"ph", "i"},
         {"name", line.text()},
         {"cat", "log"},
         {"pid", known == workers_.end() ? kCoordinator : known->second.pid},
         {"tid", kJobThread},
         {"ts", line.time_ms() * 1000 - epoch_us_},
         {"s", "p"},
         {"args", std::move(arguments)}});
}

void TraceWriter::end(const v1::Job& job) {
  if (holding_) flush_held();
  if (second_ >= 0) {
    write_rate(second_, in_second_);
    write_rate(second_ + 1, 0);
  }
  if (job.ended_ms() >= job.submitted_ms()) {
    write({{"ph", "X"},
           {"name", job.name()},
           {"cat", "job"},
           {"pid", kCoordinator},
           {"tid", kJobThread},
           {"ts", 0},
           {"dur", (job.ended_ms() - job.submitted_ms()) * 1000},
           {"args", {{"state", farm::state_name(job.state())}, {"frames", job.frames()}}}});
  }
  const Json facts = {{"job", job.id()},
                      {"name", job.name()},
                      {"begins_us_since_1970", std::to_string(epoch_us_)},
                      {"units", units_},
                      {"samples", samples_},
                      {"samples_are_exact", samples_per_pixel_ > 0},
                      {"clock", "the coordinator's"}};
  out_ << "\n],\"otherData\":" << facts.dump(-1, ' ', false, Json::error_handler_t::replace)
       << "}\n";
}

}  // namespace hyades::cli
