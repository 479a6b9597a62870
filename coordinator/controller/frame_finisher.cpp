#include "coordinator/controller/frame_finisher.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "coordinator/controller/disk_watch.h"
#include "coordinator/controller/stored_outputs.h"
#include "coordinator/finisher/finish_process.h"
#include "coordinator/finisher/finish_task.h"
#include "coordinator/meters/meters.h"
#include "core/base/failpoint.h"
#include "core/base/fp_mode.h"
#include "core/base/wall_clock.h"
#include "core/film/black.h"
#include "core/job/film_file.h"

namespace hyades::coordinator {
namespace {

/// What the job's colour configuration consists of, where it has one.
core::Status find_color_files(FinishTask& task, const std::vector<core::AssetRecord>& files,
                              farm::ContentStore& assets) {
  if (!task.color) return {};
  const std::vector<std::string>& named = task.color->files;
  for (const core::AssetRecord& file : files) {
    const bool wanted = file.reference == task.color->config ||
                        std::find(named.begin(), named.end(), file.reference) != named.end();
    if (!wanted) continue;
    auto bytes = assets.read(file.sha256);
    if (!bytes) return bytes.error().in(file.reference);
    task.color_files.emplace_back(file.reference, std::move(*bytes));
  }
  return {};
}

}  // namespace

/// A frame whose film is complete.
struct FrameFinisher::Completed {
  JobId job{};
  uint64_t life = 0;  ///< ActiveJob::life: of a job that was cancelled and retried nothing is left
  int32_t frame = 0;
  uint64_t volume = 0;                                ///< FinishFrame::volume
  std::vector<std::string> parts;                     ///< StoredFrame::parts
  std::optional<std::string> failure = std::nullopt;  ///< why its outputs could not be made
};

void FrameFinisher::add(ActiveJob& active, const FinishFrame& asked,
                        std::vector<std::string> parts) {
  Completed completed{active.id, active.life, asked.frame, asked.volume, std::move(parts)};
  queue_.add(
      active.stored.id,
      [this, completed = std::move(completed)]() mutable { return finish(completed); },
      active.stored.owner);
}

void FrameFinisher::cancel(JobId job) { in_work_.break_off(static_cast<uint64_t>(job)); }

void FrameFinisher::stop() {
  const StateLock lock(context_.mutex);
  in_work_.break_off_all();
}

/// Whether the scheduler has heard what became of it. What fails is told with the next try, so that
/// frames which fail at once keep nobody busy.
bool FrameFinisher::finish(Completed& completed) {
  if (context_.stop) return true;
  if (completed.failure) {
    Turn turn(dispatcher_);
    turn.tell(FinishFailed{completed.job, completed.frame, *completed.failure});
    return true;
  }
  std::optional<TasksInWork::Task> in_work;
  {
    const StateLock lock(context_.mutex);
    in_work.emplace(in_work_, static_cast<uint64_t>(completed.job));
  }
  std::string spec, owner;
  StoredFrame over;
  // Not in the tasks that wait: what a job has in memory goes with it.
  const std::shared_ptr<const core::Film> film = begin(completed, spec, owner, over);
  if (!film) return !completed.failure;
  over.black = core::is_black(*film);
  auto document = context_.documents.read_stored(spec, kReadingPatience, owner);
  if (!document) return false;  // it is tried again
  const int64_t begun_us = core::wall_us();
  auto task = *document ? task_of(***document, static_cast<uint64_t>(completed.job), over)
                        : core::Result<FinishTask>(document->error());
  document.reset();  // making the outputs takes its time
  bool written = false;
  const core::Status done =
      task ? make_outputs(completed, *film, *task, over, in_work->stop(), written)
           : core::Status(task.error());
  // What is written and cannot be stored is no fault of the frame's, nor is a full disk.
  const bool waits = !done && (written || disk_.is_short_for(*film));
  Turn turn(dispatcher_);
  if (ActiveJob* still = jobs_.find(completed.job); still != nullptr) still->finishing_since = 0;
  if (in_work->stop() && !written) return true;
  if (waits) {
    ActiveJob* still = jobs_.find(completed.job);
    if (still == nullptr) return true;
    still->trouble =
        fmt::format("frame {} waits {} to be finished: {}", completed.frame,
                    written ? "for the job store" : "for room on the disk", done.error().message);
    still->touch();
    return false;
  }
  if (!done) {
    completed.failure = done.error().message;
    return false;
  }
  core::Unit all;
  all.frame = completed.frame;
  context_.meters->finished(
      std::chrono::microseconds(std::max<int64_t>(core::wall_us() - begun_us, 0)));
  timelines_.note(static_cast<uint64_t>(completed.job),
                  {v1::TimelineStep::KIND_FINISH, {}, 0, all, begun_us, core::wall_us()});
  if (ActiveJob* still = jobs_.find(completed.job); still != nullptr) {
    still->note_finish(1e-6 * static_cast<double>(core::wall_us() - begun_us));
    if (over.black) {
      still->black.insert(completed.frame);
      jobs_.note(*still, v1::LOG_LEVEL_WARNING, completed.frame, {},
                 std::string("is ") + core::kBlackWords);
    }
  }
  turn.tell(FinishDone{completed.job, completed.frame});
  return true;
}

/// The frame's film, what it is of, and what it will be when it is `over`; null where the job is
/// gone, or the frame has failed.
std::shared_ptr<const core::Film> FrameFinisher::begin(Completed& completed, std::string& spec,
                                                       std::string& owner, StoredFrame& over) {
  const StateLock lock(context_.mutex);
  ActiveJob* active = jobs_.find(completed.job);
  if (active == nullptr || active->ending || active->life != completed.life) return nullptr;
  const auto film = active->complete.find(completed.frame);
  // Where a film could not be merged some of it is missing.
  if (film == active->complete.end() || !film->second ||
      film->second->coverage().volume() != completed.volume) {
    completed.failure = "its film is not whole: 'retry' renders it again";
    return nullptr;
  }
  spec = active->stored.spec;
  owner = active->stored.owner;
  active->finishing_since = core::wall_us();
  const FrameNote& note = active->frames[completed.frame];
  over = {completed.frame,    true, {}, note.worker_class, note.restarts, completed.parts,
          jobs_.next_moment()};
  return film->second;
}

/// What the finisher is told of the frame that will be `over`.
core::Result<FinishTask> FrameFinisher::task_of(const farm::ReadJob& read, uint64_t job,
                                                const StoredFrame& over) const {
  FinishTask task;
  task.info = core::film_info(read.job, over.frame, read.assets);
  task.info.worker_class = over.worker_class;
  task.outputs = read.job.outputs;
  if (read.job.keep_films) task.film = core::film_file(read.job);
  task.folder = context_.output_folder(job);
  task.color = read.job.color;
  if (core::Status found = find_color_files(task, read.assets, *context_.assets); !found) {
    return found.error();
  }
  return task;
}

/// Has the outputs made and stores that the frame is over; `written`: the first of it is done.
core::Status FrameFinisher::make_outputs(const Completed& completed, const core::Film& film,
                                         const FinishTask& task, const StoredFrame& over,
                                         const std::atomic<bool>& stop, bool& written) const {
  const auto id = static_cast<uint64_t>(completed.job);
  const core::FpMode mode;
  const std::string scratch =
      fmt::format("{}/tmp/{}-{}", context_.options.folder, id, completed.frame);
  const auto files = run_finisher(context_.options.finisher, scratch, task, film, stop);
  if (!files) return files.error();
  written = true;
  core::failpoint("outputs-written");
  const core::Status stored =
      context_.store->frame_over(id, over, stored_outputs(*files, completed.frame));
  core::failpoint("frame-stored");
  return stored;
}

}  // namespace hyades::coordinator
