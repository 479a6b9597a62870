#include "coordinator/controller/frame_finisher.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "coordinator/controller/disk_watch.h"
#include "coordinator/controller/wall_clock.h"
#include "coordinator/finisher/finish_process.h"
#include "coordinator/finisher/finish_task.h"
#include "coordinator/meters/meters.h"
#include "core/base/failpoint.h"
#include "core/base/fp_mode.h"
#include "core/job/film_file.h"
#include "farm/wire.h"

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
  int32_t frame = 0;
  std::shared_ptr<const core::Film> film;
  std::vector<std::string> parts;                     ///< StoredFrame::parts
  std::optional<std::string> failure = std::nullopt;  ///< why its outputs could not be made
};

void FrameFinisher::add(ActiveJob& active, int32_t frame, std::vector<std::string> parts) {
  Completed completed{active.id, frame, active.complete[frame], std::move(parts)};
  queue_.add(active.stored.id,
             [this, completed = std::move(completed)]() mutable { return finish(completed); });
}

/// Whether the scheduler has heard what became of it. What fails is told with the next try, so that
/// frames which fail at once keep nobody busy.
bool FrameFinisher::finish(Completed& completed) {
  if (shared_.stop) return true;
  if (completed.failure) {
    Turn turn(dispatcher_);
    turn.tell(FinishFailed{completed.job, completed.frame, *completed.failure});
    return true;
  }
  const auto id = static_cast<uint64_t>(completed.job);
  FinishTask task;
  StoredFrame over;
  std::vector<core::AssetRecord> assets;
  {
    const StateLock lock(shared_.mutex);
    ActiveJob* active = jobs_.find(completed.job);
    if (active == nullptr) return true;
    const FrameNote& note = active->frames[completed.frame];
    task.info = active->film_info(completed.frame);
    task.info.worker_class = note.worker_class;
    task.outputs = active->read.job.outputs;
    if (active->read.job.keep_films) task.film = core::film_file(active->read.job);
    task.folder = shared_.output_folder(id);
    task.color = active->read.job.color;
    if (task.color) assets = active->read.assets;
    over = {completed.frame,    true, {}, note.worker_class, note.restarts, completed.parts,
            jobs_.next_moment()};
  }
  const core::FpMode mode;
  const int64_t begun_us = wall_us();
  const std::string scratch =
      fmt::format("{}/tmp/{}-{}", shared_.options.folder, id, completed.frame);
  core::Status done = find_color_files(task, assets, *shared_.assets);
  core::Result<std::vector<FinishedFile>> files = core::Error{};
  if (done) {
    files = run_finisher(shared_.options.finisher, scratch, task, *completed.film, shared_.stop);
    if (!files) done = files.error();
  }
  if (done) {
    std::vector<StoredOutput> outputs;
    for (const FinishedFile& file : *files) {
      const auto digest = farm::digest_from_hex(file.sha256);
      outputs.push_back(
          {file.path, completed.frame, file.size, digest ? farm::to_wire(*digest) : std::string()});
    }
    core::failpoint("outputs-written");
    done = shared_.store->frame_over(id, over, outputs);
    core::failpoint("frame-stored");
  }
  // What is written and cannot be stored is no fault of the frame's, nor is a full disk.
  const bool waits = !done && (files || disk_.is_short_for(*completed.film));
  Turn turn(dispatcher_);
  if (shared_.stop) return true;
  if (waits) {
    ActiveJob* still = jobs_.find(completed.job);
    if (still == nullptr) return true;
    still->trouble =
        fmt::format("frame {} waits {} to be finished: {}", completed.frame,
                    files ? "for the job store" : "for room on the disk", done.error().message);
    still->touch();
    return false;
  }
  if (!done) {
    completed.failure = done.error().message;
    return false;
  }
  core::Unit all;
  all.frame = completed.frame;
  shared_.meters->finished(std::chrono::microseconds(std::max<int64_t>(wall_us() - begun_us, 0)));
  timelines_.note(id, {v1::TimelineStep::KIND_FINISH, {}, 0, all, begun_us, wall_us()});
  turn.tell(FinishDone{completed.job, completed.frame});
  return true;
}

}  // namespace hyades::coordinator
