// What the worker does because time has passed: heartbeats, leases that run out, films sent again.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <map>
#include <utility>

#include "core/base/text.h"
#include "worker/state_machine.h"

namespace hyades::worker {
namespace {

/// Heartbeats; older ones renew nothing any more.
constexpr size_t kMostUnanswered = 10'000;

}  // namespace

void StateMachine::tick(TimePoint now, bool flowing) {
  fence(now);
  clock_.tick(now);
  end_overdue();
  end_hang();
  end_rests(now);
  if (!welcomed_) return;
  if (now - last_heartbeat_ >= heartbeat_every_ && flowing) {
    heartbeat(now);
    last_heartbeat_ = now;
  }
  for (auto& [token, item] : items_) {
    if (!item.send_again || *item.send_again > now) continue;
    item.send_again.reset();
    if (item.state == Item::State::kept) send_result(item);
  }
  top_up();
}

/// No answer for as long as a lease lasts (the network may be cut without a sign), or asleep:
/// whatever is not rendered yet was given to others by now.
void StateMachine::fence(TimePoint now) {
  if (!renewed_ || now - *renewed_ <= lease_time_) return;
  size_t dropped = 0;
  for (auto it = items_.begin(); it != items_.end();) {
    const auto item = it++;
    if (item->second.state == Item::State::kept) continue;
    stop_rendering(item);
    drop(item);
    ++dropped;
  }
  renewed_.reset();
  if (dropped > 0) {
    ports_.note(
        farm::LogLevel::warning,
        "out of contact for longer than a lease: " + core::counted(dropped, "unit") + " given up",
        {});
  }
}

void StateMachine::heartbeat(TimePoint now) {
  v1::WorkerMessage message;
  v1::Heartbeat& beat = *message.mutable_heartbeat();
  beat.set_number(++heartbeats_);
  unanswered_.emplace(heartbeats_, now);
  if (unanswered_.size() > kMostUnanswered) unanswered_.erase(unanswered_.begin());
  std::map<std::pair<uint64_t, uint64_t>, v1::LeaseProgress> leases;
  for (const auto& [token, item] : items_) {
    const v1::LeaseId& lease = item.leased.lease();
    v1::LeaseProgress& progress = leases[{lease.incarnation(), lease.number()}];
    *progress.mutable_lease() = lease;
    progress.set_samples_done(progress.samples_done() + item.samples_done);
    progress.set_stage(std::max(progress.stage(), stage_of(item)));
  }
  for (auto& [id, progress] : leases) *beat.add_leases() = std::move(progress);
  beat.set_memory_bytes(renderer_memory_);
  beat.set_cache_bytes(cache_.bytes);
  beat.set_cache_limit_bytes(cache_.limit_bytes);
  beat.set_cache_hits(cache_.hits);
  beat.set_cache_misses(cache_.misses);
  ports_.send(std::move(message));
}

v1::LeaseProgress::Stage StateMachine::stage_of(const Item& item) {
  switch (item.state) {
    case Item::State::fetching:
      return v1::LeaseProgress::STAGE_FETCHING;
    case Item::State::waiting:
      return v1::LeaseProgress::STAGE_WAITING;
    case Item::State::rendering:
      if (!item.begun) return v1::LeaseProgress::STAGE_WAITING;
      return item.loading ? v1::LeaseProgress::STAGE_LOADING : v1::LeaseProgress::STAGE_RENDERING;
    case Item::State::kept:
      return v1::LeaseProgress::STAGE_FILM;
  }
  return v1::LeaseProgress::STAGE_UNSPECIFIED;
}

void StateMachine::echoed(uint64_t number) {
  const auto sent = unanswered_.find(number);
  if (sent == unanswered_.end()) return;
  renewed_ = renewed_ ? std::max(*renewed_, sent->second) : sent->second;
  unanswered_.erase(unanswered_.begin(), std::next(sent));
}

}  // namespace hyades::worker
