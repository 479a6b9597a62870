#pragma once

#include <functional>
#include <string>
#include <vector>

#include <grpcpp/support/status.h>

#include "coordinator/controller/job_records.h"
#include "coordinator/controller/worker_table.h"
#include "hyades/v1/farm.pb.h"

namespace hyades::coordinator {

class DiskWatch;

/// Gets what became of something that was to be done with a worker: a status, and the worker as it
/// is now.
using WorkerReply = std::function<void(const grpc::Status&, const v1::Worker&)>;

/// What operators want to know of the farm, and want done with its workers. Thread-safe.
class FarmControl {
 public:
  FarmControl(ControllerContext& context, Dispatcher& dispatcher, JobTable& jobs,
              WorkerTable& workers, JobRecords& records, const DiskWatch& disk)
      : context_(context),
        dispatcher_(dispatcher),
        jobs_(jobs),
        workers_(workers),
        records_(records),
        disk_(disk) {}

  /// What the farm is, how large, and what troubles it.
  void info(v1::InfoResponse& response) HYADES_EXCLUDES(state_lock);
  /// Sets the address of gRPC that info() tells.
  void listens_at(const std::string& address) HYADES_EXCLUDES(state_lock);
  /// Sets how strangers may listen or act, which info() tells; empty: they may not.
  void set_unguarded(const std::string& how) HYADES_EXCLUDES(state_lock);
  /// Workers in the order of their ids, those after the one that the request names, as many as fit.
  void workers(const v1::WorkersRequest& request, v1::WorkersResponse& response)
      HYADES_EXCLUDES(state_lock);
  // Each calls `then` once, perhaps by another thread: when what is kept over restarts is stored,
  // or after half a second with UNAVAILABLE. NOT_FOUND, or FAILED_PRECONDITION where several
  // workers have the name.

  /// Asks the worker to deliver what it has and leave; it gets no more units.
  void drain_worker(const v1::WorkerRequest& request, const WorkerReply& then)
      HYADES_EXCLUDES(state_lock);
  /// The worker gets no more units, over restarts too, until it is released.
  void quarantine_worker(const v1::WorkerRequest& request, const WorkerReply& then)
      HYADES_EXCLUDES(state_lock);
  /// Ends the worker's quarantine: it gets units again, unless it is to leave.
  void release_worker(const v1::WorkerRequest& request, const WorkerReply& then)
      HYADES_EXCLUDES(state_lock);

 private:
  v1::Worker describe(const WorkerSession& session) const HYADES_REQUIRES(state_lock);
  std::vector<v1::WorkInHand> work_of(WorkerId worker) const HYADES_REQUIRES(state_lock);
  /// Does `what` with a worker, for a reason; it says whether something is on its way to the store.
  using Steer = std::function<bool(WorkerSession&, const std::string& reason, Turn&)>;
  void steer(const v1::WorkerRequest& request, const WorkerReply& then, const Steer& what)
      HYADES_EXCLUDES(state_lock);

  ControllerContext& context_;
  Dispatcher& dispatcher_;
  JobTable& jobs_;
  WorkerTable& workers_;
  JobRecords& records_;
  const DiskWatch& disk_;
  std::string grpc_address_ HYADES_GUARDED_BY(state_lock);
  std::string unguarded_ HYADES_GUARDED_BY(state_lock);
};

}  // namespace hyades::coordinator
