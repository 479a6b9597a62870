// What rendering took: for the jobs' accounts, and for those who look for what takes long.
#include <algorithm>
#include <utility>

#include "coordinator/controller/controller.h"
#include "coordinator/controller/not_there.h"
#include "coordinator/meters/meters.h"
#include "farm/wire.h"
#include "farm/wire_status.h"

namespace hyades::coordinator {
namespace {

constexpr uint32_t kMostSteps = 2000;

v1::TimelineStep to_wire(const TimedStep& step) {
  v1::TimelineStep wire;
  wire.set_number(step.number);
  wire.set_kind(step.kind);
  wire.set_worker(step.worker);
  wire.set_thread(step.thread);
  *wire.mutable_unit() = farm::to_wire(step.unit);
  wire.set_begun_us(step.begun_us);
  wire.set_ended_us(step.ended_us);
  return wire;
}

}  // namespace

/// A film has been merged, since `begun_us`: what it took counts now. With the lock.
void Controller::count_film(ActiveJob& active, const Merge& merge, int64_t begun_us) {
  const auto id = static_cast<uint64_t>(active.id);
  const auto found = active.films_under_way.find(merge.record);
  if (found != active.films_under_way.end()) {
    const FilmUnderWay film = std::move(found->second);
    active.films_under_way.erase(found);
    active.stored.core_ns += film.render_ns;
    meters_->result("accepted");
    meters_->made_durable(std::chrono::steady_clock::now() - film.came);
    if (const auto session = sessions_.find(film.worker); session != sessions_.end()) {
      ++session->second.units_done;
      session->second.samples_done += samples_of(active, merge.unit.tile, merge.unit.batches);
    }
    const auto took_us = static_cast<int64_t>(film.render_ns / 1000);
    timelines_.note(id, {v1::TimelineStep::KIND_RENDER, film.name, film.thread, merge.unit,
                         film.came_us - took_us, film.came_us});
  }
  const int64_t now_us = wall_us();
  meters_->merged(std::chrono::microseconds(std::max<int64_t>(now_us - begun_us, 0)));
  timelines_.note(id, {v1::TimelineStep::KIND_MERGE, {}, 0, merge.unit, begun_us, now_us});
}

grpc::Status Controller::timeline(const v1::ListTimelineRequest& request,
                                  v1::ListTimelineResponse& response) {
  const auto known = store_->state(request.job());
  if (!known) return farm::unavailable(known.error());
  if (!*known) return no_job(request.job());
  const uint32_t limit = request.limit() == 0 ? kMostSteps : std::min(request.limit(), kMostSteps);
  Timelines::Page page;
  {
    const std::lock_guard lock(mutex_);
    page = timelines_.page(request.job(), request.after(), limit);
  }
  for (const TimedStep& step : page.steps) *response.add_steps() = to_wire(step);
  response.set_more(page.more);
  response.set_dropped(page.dropped);
  return grpc::Status::OK;
}

}  // namespace hyades::coordinator
