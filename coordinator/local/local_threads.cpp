// What the threads of a run do.
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "coordinator/local/local_run.h"
#include "core/base/fp_mode.h"

namespace hyades::coordinator {
namespace {

/// Renders a unit and makes sure that the film is that unit's. What is thrown is its failure.
core::Result<core::Film> render_unit(const FrameWork& work, const core::Unit& unit,
                                     const std::atomic<bool>& stop) {
  try {
    auto film = work.render(unit, stop);
    if (!film || stop) return film;
    const core::CoverageBox box{unit.tile, unit.batches};
    const uint64_t volume = static_cast<uint64_t>(unit.tile.area()) * unit.batches.count;
    if (film->window() != unit.tile || film->coverage().volume() != volume ||
        !film->coverage().contains(box)) {
      return core::Error{"the renderer gave a film of something else"};
    }
    return film;
  } catch (const std::exception& e) {
    return core::Error{e.what()};
  }
}

std::string describe(const core::Unit& unit) {
  return fmt::format("pixels x {} to {}, y {} to {}, batches {} to {}", unit.tile.x0,
                     unit.tile.x1 - 1, unit.tile.y0, unit.tile.y1 - 1, unit.batches.first,
                     unit.batches.end() - 1);
}

}  // namespace

void LocalRun::render_loop(int thread) {
  const core::FpMode mode;
  while (const std::optional<Task> task = next_task(thread)) {
    const TimePoint begin = std::chrono::steady_clock::now();
    const core::Unit unit = to_render(task->unit);
    auto film = render_unit(*task->work, unit, stop_);
    if (stop_) break;
    if (film) {
      deliver(thread, *task, std::move(*film), std::chrono::steady_clock::now() - begin);
    } else {
      carry_out(tell(UnitFailed{WorkerId{static_cast<uint64_t>(thread)}, task->lease, kJob,
                                task->unit, film.error().message + " (" + describe(unit) + ")"}));
    }
  }
  const core::MutexLock lock(mutex_);
  if (--rendering_ == 0) film_store_.drain();
}

std::optional<LocalRun::Task> LocalRun::next_task(int thread) {
  const core::MutexLock lock(mutex_);
  TaskQueue& queue = *task_queues_[static_cast<size_t>(thread)];
  if (!ending_ && queue.tasks.empty()) {
    // Asking can only lead to leases and frames to load, which tell_locked() deals with.
    tell_locked(WorkRequested{WorkerId{static_cast<uint64_t>(thread)}, 1});
    while (!ending_ && queue.tasks.empty()) queue.wake.wait(mutex_);
  }
  if (ending_) return std::nullopt;
  Task task = std::move(queue.tasks.front());
  queue.tasks.pop_front();
  return task;
}

void LocalRun::deliver(int thread, const Task& task, core::Film film, Duration render_time) {
  std::optional<Persist> persist;
  {
    const core::MutexLock lock(mutex_);
    for (const DeferredAction& action :
         tell_locked(ResultArrived{WorkerId{static_cast<uint64_t>(thread)}, task.lease, kJob,
                                   task.unit, Digest{}, render_time})) {
      // Or it is rejected, because the frame has failed meanwhile.
      if (const auto* said = std::get_if<Persist>(&action)) persist = *said;
    }
    if (persist) count_locked(task.unit, true);
  }
  if (!persist) return;
  film_store_.append_rendered(persist->id, std::get<UnitRecord>(persist->record), std::move(film));
}

void LocalRun::load_loop() {
  const core::FpMode mode;
  for (;;) {
    int32_t frame = 0;
    {
      const core::MutexLock lock(mutex_);
      while (!ending_ && to_load_.empty()) load_wake_.wait(mutex_);
      if (ending_) return;
      frame = to_load_.front();
      to_load_.pop_front();
    }
    core::Result<std::shared_ptr<const FrameWork>> work = core::Error{};
    try {
      work = source_.prepare(frame);
    } catch (const std::exception& e) {
      work = core::Error{e.what()};
    }
    if (stop_) return;
    if (work) {
      std::vector<DeferredAction> actions;
      {
        const core::MutexLock lock(mutex_);
        works_[frame] = std::move(*work);
        actions = tell_locked(FrameOpened{kJob, frame});
      }
      carry_out(actions);
    } else {
      carry_out(tell(FrameRefused{kJob, frame, work.error().message}));
    }
  }
}

void LocalRun::finish_loop() {
  const core::FpMode mode;
  for (;;) {
    Completed completed;
    {
      const core::MutexLock lock(mutex_);
      while (!ending_ && to_finish_.empty()) finish_wake_.wait(mutex_);
      if (ending_) return;
      completed = std::move(to_finish_.front());
      to_finish_.pop_front();
    }
    core::Status finished;
    try {
      finished = sink_.finish(completed.frame, *completed.film);
    } catch (const std::exception& e) {
      finished = core::Error{e.what()};
    }
    if (finished) {
      carry_out(tell(FinishDone{kJob, completed.frame}));
    } else {
      carry_out(tell(FinishFailed{kJob, completed.frame, finished.error().message}));
    }
  }
}

}  // namespace hyades::coordinator
