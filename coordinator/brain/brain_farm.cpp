// What operators ask for.
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "coordinator/brain/brain.h"
#include "core/base/version.h"
#include "farm/wire.h"

namespace hyades::coordinator {
namespace {

/// Of an answer: twenty thousand workers with long names and many tags would make forty megabytes.
constexpr size_t kMostWorkerBytes = size_t{1} << 20U;
constexpr size_t kMostWorkTold = 16;
constexpr uint64_t kWorkersChores = 0;  // no job has this number

}  // namespace

void Brain::info(v1::InfoResponse& response) {
  const std::lock_guard lock(mutex_);
  response.set_protocol(farm::kProtocol);
  response.set_oldest_protocol(farm::kOldestProtocol);
  response.set_version(core::kVersion);
  response.set_incarnation(incarnation_);
  response.set_started_ms(started_ms_);
  for (const auto& [id, seat] : seats_) {
    if (!seat.joined) continue;
    response.set_workers(response.workers() + 1);
    response.set_threads(response.threads() + seat.hello.threads());
  }
  response.set_jobs(static_cast<uint32_t>(desks_.size()));
  response.set_grpc_address(grpc_address_);
  response.set_price_per_core_hour(options_.price.per_core_hour);
  response.set_currency(options_.price.currency);
  response.set_unguarded(unguarded_);
  response.set_trouble(disk_.reason());
  for (const auto& [id, desk] : desks_) {
    if (!desk->row_trouble.empty()) response.set_trouble(desk->row_trouble);
    if (!desk->trouble.empty()) response.set_trouble(desk->trouble);
  }
}

void Brain::listens_at(const std::string& address) {
  const std::lock_guard lock(mutex_);
  grpc_address_ = address;
}

/// What the units that are out with the worker belong to, the most first; with the lock.
std::vector<v1::WorkInHand> Brain::work_of(WorkerId worker) const {
  std::map<std::pair<JobId, int32_t>, uint32_t> counts;
  for (const UnitInHand& held : scheduler_.units_of(worker)) ++counts[{held.job, held.unit.frame}];
  std::vector<v1::WorkInHand> work;
  for (const auto& [what, units] : counts) {
    v1::WorkInHand& one = work.emplace_back();
    one.set_job(static_cast<uint64_t>(what.first));
    one.set_frame(what.second);
    one.set_units(units);
  }
  std::stable_sort(work.begin(), work.end(),
                   [](const auto& a, const auto& b) { return a.units() > b.units(); });
  if (work.size() > kMostWorkTold) work.resize(kMostWorkTold);
  return work;
}

void Brain::set_unguarded(const std::string& how) {
  const std::lock_guard lock(mutex_);
  unguarded_ = how;
}

v1::Worker Brain::describe(const Seat& seat) const {
  v1::Worker wire;
  wire.set_id(static_cast<uint64_t>(seat.id));
  wire.set_name(seat.hello.name());
  wire.set_host(seat.hello.host());
  wire.set_worker_class(seat.hello.worker_class());
  wire.set_build(seat.hello.build());
  wire.set_threads(seat.hello.threads());
  wire.set_state(seat.state);
  wire.set_reason(seat.reason);
  wire.set_leased(scheduler_.leased_units(seat.id));
  wire.set_units_done(seat.units_done);
  wire.set_units_failed(seat.units_failed);
  wire.set_samples_done(seat.samples_done);
  wire.set_joined_ms(seat.joined_ms);
  wire.set_heard_ms(seat.heard_ms);
  wire.set_memory_bytes(seat.memory);
  wire.set_memory_limit_bytes(seat.hello.memory_bytes());
  *wire.mutable_tags() = seat.hello.tags();
  for (v1::WorkInHand& work : work_of(seat.id)) *wire.add_work() = std::move(work);
  wire.set_cache_bytes(seat.cache);
  wire.set_cache_limit_bytes(seat.cache_limit);
  wire.set_cache_hits(seat.cache_hits);
  wire.set_cache_misses(seat.cache_misses);
  if (seat.joined) wire.set_samples_per_second(seat.speed.per_second());
  return wire;
}

void Brain::workers(const v1::WorkersRequest& request, v1::WorkersResponse& response) {
  const std::lock_guard lock(mutex_);
  size_t bytes = 0;
  for (auto seat = seats_.upper_bound(WorkerId{request.after()}); seat != seats_.end(); ++seat) {
    if (bytes > kMostWorkerBytes) {
      response.set_next_after(response.workers().rbegin()->id());
      return;
    }
    v1::Worker worker = describe(seat->second);
    bytes += worker.ByteSizeLong();
    *response.add_workers() = std::move(worker);
  }
}

/// By number or by name; with the lock. Null where `status` says why.
Brain::Seat* Brain::find_worker(const std::string& text, grpc::Status& status) {
  Seat* found = nullptr;
  for (auto& [id, seat] : seats_) {
    if (std::to_string(static_cast<uint64_t>(id)) == text) return &seat;
    if (seat.hello.name() != text) continue;
    if (found != nullptr) {
      status = {grpc::StatusCode::FAILED_PRECONDITION,
                "several workers are called '" + text + "': give the id"};
      return nullptr;
    }
    found = &seat;
  }
  if (found == nullptr) {
    status = {grpc::StatusCode::NOT_FOUND, "there is no worker '" + text + "'"};
  }
  return found;
}

grpc::Status Brain::drain_worker(const v1::WorkerRequest& request, v1::Worker& now) {
  return steer_worker(request, now, [&](Seat& seat) {
    v1::CoordinatorMessage message;
    message.mutable_drain()->set_reason(farm::wire_text(request.reason()));
    send(seat.id, std::move(message));
    if (seat.state == v1::WORKER_STATE_ACTIVE) seat.state = v1::WORKER_STATE_DRAINING;
    return tell(WorkerBarred{seat.id, true});
  });
}

/// With the lock. The scheduler is told by whoever knows more.
void Brain::set_quarantine(Seat& seat, const std::string& reason) {
  seat.state = v1::WORKER_STATE_QUARANTINED;
  seat.reason = reason;
  const std::string worker = seat.hello.worker_id();
  quarantines_[worker] = reason;
  store_quarantine([this, worker, reason] { return store_->quarantine({worker, reason}); });
}

void Brain::end_quarantine(Seat& seat) {
  seat.state = seat.joined ? v1::WORKER_STATE_ACTIVE : v1::WORKER_STATE_GONE;
  const std::string worker = seat.hello.worker_id();
  quarantines_.erase(worker);
  store_quarantine([this, worker] { return store_->end_quarantine(worker); });
}

void Brain::store_quarantine(std::function<core::Status()> what) {
  chores_.add(kWorkersChores, [what = std::move(what)] { return what().ok(); });
}

grpc::Status Brain::quarantine_worker(const v1::WorkerRequest& request, v1::Worker& now) {
  return steer_worker(request, now, [&](Seat& seat) {
    set_quarantine(seat, seat.reason);
    note_quarantine(seat);
    return tell(WorkerBarred{seat.id, true});
  });
}

grpc::Status Brain::release_worker(const v1::WorkerRequest& request, v1::Worker& now) {
  return steer_worker(request, now, [&](Seat& seat) {
    if (seat.state != v1::WORKER_STATE_QUARANTINED) return std::vector<Action>();
    end_quarantine(seat);
    return tell(WorkerBarred{seat.id, false});
  });
}

grpc::Status Brain::steer_worker(const v1::WorkerRequest& request, v1::Worker& now,
                                 const std::function<std::vector<Action>(Seat&)>& what) {
  std::vector<Action> later;
  {
    const std::lock_guard lock(mutex_);
    grpc::Status status;
    Seat* seat = find_worker(request.worker(), status);
    if (seat == nullptr) return status;
    seat->reason = farm::wire_text(request.reason());
    later = what(*seat);
    now = describe(*seat);
  }
  carry_out(later);
  return grpc::Status::OK;
}

}  // namespace hyades::coordinator
