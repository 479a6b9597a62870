// What operators ask for.
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "coordinator/controller/controller.h"
#include "core/base/version.h"
#include "farm/wire.h"

namespace hyades::coordinator {
namespace {

/// Of an answer: twenty thousand workers with long names and many tags would make forty megabytes.
constexpr size_t kMostWorkerBytes = size_t{1} << 20U;
constexpr size_t kMostWorkTold = 16;
constexpr uint64_t kWorkersKey = 0;  // no job has this number

}  // namespace

void Controller::info(v1::InfoResponse& response) {
  const std::lock_guard lock(mutex_);
  response.set_protocol(farm::kProtocol);
  response.set_oldest_protocol(farm::kOldestProtocol);
  response.set_version(core::kVersion);
  response.set_incarnation(incarnation_);
  response.set_started_ms(started_ms_);
  for (const auto& [id, session] : sessions_) {
    if (!session.joined) continue;
    response.set_workers(response.workers() + 1);
    response.set_threads(response.threads() + session.hello.threads());
  }
  response.set_jobs(static_cast<uint32_t>(jobs_.size()));
  response.set_grpc_address(grpc_address_);
  response.set_price_per_core_hour(options_.price.per_core_hour);
  response.set_currency(options_.price.currency);
  response.set_unguarded(unguarded_);
  response.set_trouble(disk_.reason());
  for (const auto& [id, active] : jobs_) {
    if (!active->row_trouble.empty()) response.set_trouble(active->row_trouble);
    if (!active->trouble.empty()) response.set_trouble(active->trouble);
  }
}

void Controller::listens_at(const std::string& address) {
  const std::lock_guard lock(mutex_);
  grpc_address_ = address;
}

/// What the units that are out with the worker belong to, the most first; with the lock.
std::vector<v1::WorkInHand> Controller::work_of(WorkerId worker) const {
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

void Controller::set_unguarded(const std::string& how) {
  const std::lock_guard lock(mutex_);
  unguarded_ = how;
}

v1::Worker Controller::describe(const WorkerSession& session) const {
  v1::Worker wire;
  wire.set_id(static_cast<uint64_t>(session.id));
  wire.set_name(session.hello.name());
  wire.set_host(session.hello.host());
  wire.set_worker_class(session.hello.worker_class());
  wire.set_build(session.hello.build());
  wire.set_threads(session.hello.threads());
  wire.set_state(session.state);
  wire.set_reason(session.reason);
  wire.set_leased(scheduler_.leased_units(session.id));
  wire.set_units_done(session.units_done);
  wire.set_units_failed(session.units_failed);
  wire.set_samples_done(session.samples_done);
  wire.set_joined_ms(session.joined_ms);
  wire.set_heard_ms(session.heard_ms);
  wire.set_memory_bytes(session.memory);
  wire.set_memory_limit_bytes(session.hello.memory_bytes());
  *wire.mutable_tags() = session.hello.tags();
  for (v1::WorkInHand& work : work_of(session.id)) *wire.add_work() = std::move(work);
  wire.set_cache_bytes(session.cache);
  wire.set_cache_limit_bytes(session.cache_limit);
  wire.set_cache_hits(session.cache_hits);
  wire.set_cache_misses(session.cache_misses);
  if (session.joined) wire.set_samples_per_second(session.speed.per_second());
  return wire;
}

void Controller::workers(const v1::WorkersRequest& request, v1::WorkersResponse& response) {
  const std::lock_guard lock(mutex_);
  size_t bytes = 0;
  for (auto session = sessions_.upper_bound(WorkerId{request.after()}); session != sessions_.end();
       ++session) {
    if (bytes > kMostWorkerBytes) {
      response.set_next_after(response.workers().rbegin()->id());
      return;
    }
    v1::Worker worker = describe(session->second);
    bytes += worker.ByteSizeLong();
    *response.add_workers() = std::move(worker);
  }
}

/// By number or by name; with the lock. Null where `status` says why.
Controller::WorkerSession* Controller::find_worker(const std::string& text, grpc::Status& status) {
  WorkerSession* found = nullptr;
  for (auto& [id, session] : sessions_) {
    if (std::to_string(static_cast<uint64_t>(id)) == text) return &session;
    if (session.hello.name() != text) continue;
    if (found != nullptr) {
      status = {grpc::StatusCode::FAILED_PRECONDITION,
                "several workers are called '" + text + "': give the id"};
      return nullptr;
    }
    found = &session;
  }
  if (found == nullptr) {
    status = {grpc::StatusCode::NOT_FOUND, "there is no worker '" + text + "'"};
  }
  return found;
}

grpc::Status Controller::drain_worker(const v1::WorkerRequest& request, v1::Worker& now) {
  return steer_worker(request, now, [&](WorkerSession& session) {
    v1::CoordinatorMessage message;
    message.mutable_drain()->set_reason(farm::wire_text(request.reason()));
    send(session.id, std::move(message));
    if (session.state == v1::WORKER_STATE_ACTIVE) session.state = v1::WORKER_STATE_DRAINING;
    return tell(WorkerBarred{session.id, true});
  });
}

/// With the lock. The scheduler is told by whoever knows more.
void Controller::set_quarantine(WorkerSession& session, const std::string& reason) {
  session.state = v1::WORKER_STATE_QUARANTINED;
  session.reason = reason;
  const std::string worker = session.hello.worker_id();
  quarantines_[worker] = reason;
  store_quarantine([this, worker, reason] { return store_->quarantine({worker, reason}); });
}

void Controller::end_quarantine(WorkerSession& session) {
  session.state = session.joined ? v1::WORKER_STATE_ACTIVE : v1::WORKER_STATE_GONE;
  const std::string worker = session.hello.worker_id();
  quarantines_.erase(worker);
  store_quarantine([this, worker] { return store_->end_quarantine(worker); });
}

void Controller::store_quarantine(std::function<core::Status()> what) {
  background_.add(kWorkersKey, [what = std::move(what)] { return what().ok(); });
}

grpc::Status Controller::quarantine_worker(const v1::WorkerRequest& request, v1::Worker& now) {
  return steer_worker(request, now, [&](WorkerSession& session) {
    set_quarantine(session, session.reason);
    note_quarantine(session);
    return tell(WorkerBarred{session.id, true});
  });
}

grpc::Status Controller::release_worker(const v1::WorkerRequest& request, v1::Worker& now) {
  return steer_worker(request, now, [&](WorkerSession& session) {
    if (session.state != v1::WORKER_STATE_QUARANTINED) return std::vector<Action>();
    end_quarantine(session);
    return tell(WorkerBarred{session.id, false});
  });
}

grpc::Status Controller::steer_worker(
    const v1::WorkerRequest& request, v1::Worker& now,
    const std::function<std::vector<Action>(WorkerSession&)>& what) {
  std::vector<Action> later;
  {
    const std::lock_guard lock(mutex_);
    grpc::Status status;
    WorkerSession* session = find_worker(request.worker(), status);
    if (session == nullptr) return status;
    session->reason = farm::wire_text(request.reason());
    later = what(*session);
    now = describe(*session);
  }
  carry_out(later);
  return grpc::Status::OK;
}

}  // namespace hyades::coordinator
