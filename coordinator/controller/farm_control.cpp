#include "coordinator/controller/farm_control.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "coordinator/controller/disk_watch.h"
#include "core/base/version.h"
#include "farm/wire.h"

namespace hyades::coordinator {
namespace {

/// Bytes of an answer: 20,000 workers with long names and many tags would make forty megabytes.
constexpr size_t kMostWorkerBytes = size_t{1} << 20U;
constexpr size_t kMostWorkListed = 16;  ///< of one worker

}  // namespace

void FarmControl::info(v1::InfoResponse& response) {
  const StateLock lock(context_.mutex);
  response.set_protocol(farm::kProtocol);
  response.set_oldest_protocol(farm::kOldestProtocol);
  response.set_version(core::kVersion);
  response.set_incarnation(context_.incarnation);
  response.set_started_ms(context_.started_ms);
  for (const auto& [id, session] : workers_.all()) {
    if (!session.joined) continue;
    response.set_workers(response.workers() + 1);
    response.set_threads(response.threads() + session.hello.threads());
  }
  response.set_jobs(static_cast<uint32_t>(jobs_.all().size()));
  response.set_grpc_address(grpc_address_);
  response.set_price_per_core_hour(context_.options.price.per_core_hour);
  response.set_currency(context_.options.price.currency);
  response.set_unguarded(unguarded_);
  response.set_trouble(disk_.reason());
  for (const auto& [id, active] : jobs_.all()) {
    if (!active->row_trouble.empty()) response.set_trouble(active->row_trouble);
    if (!active->trouble.empty()) response.set_trouble(active->trouble);
  }
}

void FarmControl::listens_at(const std::string& address) {
  const StateLock lock(context_.mutex);
  grpc_address_ = address;
}

/// What the units that are out with the worker belong to, the most first.
std::vector<v1::WorkInHand> FarmControl::work_of(WorkerId worker) const {
  std::map<std::pair<JobId, int32_t>, uint32_t> counts;
  for (const UnitInHand& held : dispatcher_.scheduler().units_of(worker))
    ++counts[{held.job, held.unit.frame}];
  std::vector<v1::WorkInHand> work;
  for (const auto& [what, units] : counts) {
    v1::WorkInHand& one = work.emplace_back();
    one.set_job(static_cast<uint64_t>(what.first));
    one.set_frame(what.second);
    one.set_units(units);
  }
  std::stable_sort(work.begin(), work.end(),
                   [](const auto& a, const auto& b) { return a.units() > b.units(); });
  if (work.size() > kMostWorkListed) work.resize(kMostWorkListed);
  return work;
}

void FarmControl::set_unguarded(const std::string& how) {
  const StateLock lock(context_.mutex);
  unguarded_ = how;
}

v1::Worker FarmControl::describe(const WorkerSession& session) const {
  v1::Worker wire;
  wire.set_id(static_cast<uint64_t>(session.id));
  wire.set_name(session.hello.name());
  wire.set_host(session.hello.host());
  wire.set_worker_class(session.hello.worker_class());
  wire.set_portable_class(session.hello.portable_class());
  wire.set_build(session.hello.build());
  wire.set_threads(session.hello.threads());
  wire.set_state(session.state);
  wire.set_reason(session.reason);
  wire.set_leased(dispatcher_.scheduler().leased_units(session.id));
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
  // Of an idle one it is how fast it was once.
  if (session.joined && wire.leased() > 0) {
    wire.set_samples_per_second(session.speed.per_second());
  }
  return wire;
}

void FarmControl::workers(const v1::WorkersRequest& request, v1::WorkersResponse& response) {
  const StateLock lock(context_.mutex);
  size_t bytes = 0;
  for (auto session = workers_.all().upper_bound(WorkerId{request.after()});
       session != workers_.all().end(); ++session) {
    if (bytes > kMostWorkerBytes) {
      response.set_next_after(response.workers().rbegin()->id());
      return;
    }
    v1::Worker worker = describe(session->second);
    bytes += worker.ByteSizeLong();
    *response.add_workers() = std::move(worker);
  }
}

void FarmControl::drain_worker(const v1::WorkerRequest& request, const WorkerReply& then) {
  steer(request, then,
        [&](WorkerSession& session, const std::string& reason, Turn& turn)
            HYADES_REQUIRES(state_lock) {
              session.drained = reason;
              // While it is in quarantine that is why it gets nothing.
              if (session.state != v1::WORKER_STATE_QUARANTINED) session.reason = reason;
              workers_.send_drain(session, turn);
              return false;
            });
}

void FarmControl::quarantine_worker(const v1::WorkerRequest& request, const WorkerReply& then) {
  steer(request, then,
        [&](WorkerSession& session, const std::string& reason, Turn& turn)
            HYADES_REQUIRES(state_lock) {
              workers_.set_quarantine(session, reason);
              turn.tell(WorkerBarred{session.id, true});
              return true;
            });
}

void FarmControl::release_worker(const v1::WorkerRequest& request, const WorkerReply& then) {
  steer(request, then,
        [&](WorkerSession& session, const std::string& reason, Turn& turn)
            HYADES_REQUIRES(state_lock) {
              if (session.state != v1::WORKER_STATE_QUARANTINED) return false;
              workers_.end_quarantine(session, reason, turn);
              return true;
            });
}

void FarmControl::steer(const v1::WorkerRequest& request, const WorkerReply& then,
                        const Steer& what) {
  grpc::Status status;
  v1::Worker now;
  bool waits = false;
  {
    Turn turn(dispatcher_);
    if (WorkerSession* session = workers_.find(request.worker(), status)) {
      waits = what(*session, farm::wire_text(request.reason()), turn);
      now = describe(*session);
    }
    if (waits) {
      records_.when_done(
          ControllerContext::kWorkersKey,
          [then, now](const grpc::Status& stored, const v1::Job&) { then(stored, now); });
    }
  }
  if (context_.stop) records_.answer_late({});
  if (!waits) then(status, now);
}

}  // namespace hyades::coordinator
