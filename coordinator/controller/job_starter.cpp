#include "coordinator/controller/job_starter.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/controller/job_films.h"
#include "coordinator/controller/worker_link.h"
#include "farm/wire.h"

namespace hyades::coordinator {
namespace {

/// Films of a progressive job that may be in memory together, and frames that may be.
constexpr uint64_t kProgressiveBytes = uint64_t{2} << 30U;
constexpr uint64_t kMostAtOnce = 256;
/// How many frames of a job may be in work together: no more than half of `film_memory` holds, or
/// one.
uint32_t frames_at_once(const ActiveJob& active, uint64_t film_memory) HYADES_REQUIRES(state_lock) {
  const uint64_t film = std::max<uint64_t>(active.film_bytes, 1);
  const uint64_t wanted = options_of(active.stored).frame_order() == v1::FRAME_ORDER_PROGRESSIVE
                              ? std::clamp<uint64_t>(kProgressiveBytes / film, 3, kMostAtOnce)
                              : JobPlan{}.frames_in_flight;
  return static_cast<uint32_t>(std::clamp<uint64_t>(film_memory / 2 / film, 1, wanted));
}

/// What workers are told of the job; takes its spec.
grpc::ByteBuffer brief_of(ActiveJob& active) {
  v1::CoordinatorMessage told;
  v1::JobBrief& brief = *told.mutable_job();
  brief.set_job(static_cast<uint64_t>(active.id));
  brief.mutable_spec()->Swap(&active.spec);
  brief.set_key(farm::to_wire(active.key));
  return bytes_of(told);
}

/// What became of a frame that is over, by its state and its units. Of a film whose tiles are
/// judged only itself could tell that it is complete; one that has all tiles is taken for that.
FrameEnd end_of(const ActiveJob& active, const std::vector<AcceptedUnit>& units,
                v1::FrameState state) HYADES_REQUIRES(state_lock) {
  if (state == v1::FRAME_STATE_DONE) return FrameEnd::finished;
  uint64_t volume = 0;
  uint64_t begun = 0;  // pixels
  for (const auto& [unit, digest, worker_class] : units) {
    const auto pixels = static_cast<uint64_t>(unit.tile.area());
    volume += pixels * unit.batches.count;
    begun += unit.batches.first == 0 ? pixels : 0;
  }
  const auto all = static_cast<uint64_t>(active.region.area());
  const bool complete = active.threshold.adaptive()
                            ? begun == all
                            : volume == all * core::batch_count(active.samples);
  return complete ? FrameEnd::unwritten : FrameEnd::failed;
}

/// What the scheduler is told of the job.
JobPlan plan_of(const ActiveJob& active, int32_t tile_size, uint64_t film_memory)
    HYADES_REQUIRES(state_lock) {
  const v1::Job options = options_of(active.stored);
  JobPlan plan;
  plan.frames = active.numbers;
  plan.region = active.region;
  plan.tile_size = tile_size;
  plan.batches = core::batch_count(active.samples);
  plan.rounds = active.threshold.rounds;
  plan.priority = active.stored.priority;
  plan.owner = active.stored.owner;
  plan.max_workers = options.max_workers();
  plan.max_attempts = options.max_attempts();
  plan.redundancy = options.redundancy();
  plan.needs = active.needs;
  if (options.frame_order() == v1::FRAME_ORDER_PROGRESSIVE) plan.order = FrameOrder::progressive;
  plan.whole_frames = active.layout.layers.splats;
  plan.film_bytes = active.film_bytes;
  plan.frames_in_flight = frames_at_once(active, film_memory);
  return plan;
}

}  // namespace

/// What of the films in a job's log counts.
void JobStarter::restore_films(ActiveJob& active, const LogContents& contents,
                               RestoredJob& restored) {
  for (const std::string& problem : contents.problems) {
    jobs_.note(active, v1::LOG_LEVEL_WARNING, std::nullopt, {}, "films: " + problem);
  }
  restored.disputed = contents.disputed;
  if (contents.disputed) {
    jobs_.note(
        active, v1::LOG_LEVEL_WARNING, std::nullopt, {},
        "workers had rendered a unit differently when the coordinator stopped: frames that are not "
        "done are rendered again from their beginning");
  }
  for (const auto& [number, units] : contents.units) {
    FrameNote& frame = active.frames[number];
    // The row may be of outputs that were made while a film was suspect: the log has the last
    // word.
    if (frame.state == v1::FRAME_STATE_DONE && contents.disputed) {
      frame.state = v1::FRAME_STATE_WAITING;
      active.samples_done -= std::exchange(frame.samples_done, 0);
      --active.stored.frames_done;
      std::erase(restored.finished, number);
    }
    if (frame.state != v1::FRAME_STATE_WAITING) {
      active.film_store->forget(number, end_of(active, units, frame.state));
      continue;
    }
    frame.state = v1::FRAME_STATE_RENDERING;
    active.in_work.insert(number);
    frame.worker_class = units.front().worker_class;
    for (const AcceptedUnit& unit : units) {
      frame.samples_done += core::samples_in(unit.unit.tile, unit.unit.batches, active.samples);
      restored.accepted.push_back(unit);
    }
    active.samples_done += frame.samples_done;
    // It stays on the disk until the scheduler has room for it.
    restored.set_aside.push_back(number);
  }
  for (const auto& [frame, finished] : contents.finished) {
    if (active.frames[frame].state != v1::FRAME_STATE_DONE) active.film_store->reopen(frame);
  }
}

core::Status JobStarter::start(std::unique_ptr<ActiveJob> owned, RestoredJob restored) {
  JobAdded added;
  if (core::Status done = prepare(*owned, std::move(restored), added); !done) return done;
  Turn turn(dispatcher_);
  const bool paused = owned->stored.state == StoredState::paused;
  jobs_.add(std::move(owned));
  turn.tell(added);
  if (paused) turn.tell(JobPaused{added.job});
  return {};
}

/// Looks which films are there, and says in `added` what the scheduler is to know.
core::Status JobStarter::prepare(ActiveJob& active, RestoredJob restored, JobAdded& added) {
  const NotSharedYet alone;
  int32_t tile_size = tile_size_of(active);
  const auto films = context_.films->contains(active.stored.id);
  if (!films) return films.error();
  if (*films) {
    active.film_store = films_.make(active, true);
    auto contents = active.film_store->open();
    if (!contents) return contents.error();
    if (contents->cut.tile_size > 0) tile_size = contents->cut.tile_size;
    restore_films(active, *contents, restored);
    if (auto started = active.film_store->start(tile_size); !started) return started;
  }
  active.brief = brief_of(active);
  added.job = active.id;
  added.plan = plan_of(active, tile_size, context_.options.film_memory);
  added.plan.redundancy_seed = context_.proofs.secret_number(active.id);
  added.restored = std::move(restored);
  return {};
}

}  // namespace hyades::coordinator
