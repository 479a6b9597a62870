#pragma once

#include <functional>
#include <string>
#include <vector>

#include <grpcpp/support/status.h>

#include "coordinator/controller/worker_table.h"
#include "hyades/v1/farm.pb.h"

namespace hyades::coordinator {

class DiskWatch;

/// What operators want to know of the farm, and want done with its workers. Thread-safe.
class FarmControl {
 public:
  FarmControl(Shared& shared, Dispatcher& dispatcher, JobTable& jobs, WorkerTable& workers,
              const DiskWatch& disk)
      : shared_(shared), dispatcher_(dispatcher), jobs_(jobs), workers_(workers), disk_(disk) {}

  void info(v1::InfoResponse& response) HYADES_EXCLUDES(state_lock);
  /// What info() tells as the address of gRPC.
  void listens_at(const std::string& address) HYADES_EXCLUDES(state_lock);
  /// How strangers may listen or act, for info(); empty: they may not.
  void set_unguarded(const std::string& how) HYADES_EXCLUDES(state_lock);
  /// As many as fit.
  void workers(const v1::WorkersRequest& request, v1::WorkersResponse& response)
      HYADES_EXCLUDES(state_lock);
  grpc::Status drain_worker(const v1::WorkerRequest& request, v1::Worker& now)
      HYADES_EXCLUDES(state_lock);
  grpc::Status quarantine_worker(const v1::WorkerRequest& request, v1::Worker& now)
      HYADES_EXCLUDES(state_lock);
  grpc::Status release_worker(const v1::WorkerRequest& request, v1::Worker& now)
      HYADES_EXCLUDES(state_lock);

 private:
  v1::Worker describe(const WorkerSession& session) const HYADES_REQUIRES(state_lock);
  std::vector<v1::WorkInHand> work_of(WorkerId worker) const HYADES_REQUIRES(state_lock);
  grpc::Status steer(const v1::WorkerRequest& request, v1::Worker& now,
                     const std::function<void(WorkerSession&, Turn&)>& what)
      HYADES_EXCLUDES(state_lock);

  Shared& shared_;
  Dispatcher& dispatcher_;
  JobTable& jobs_;
  WorkerTable& workers_;
  const DiskWatch& disk_;
  std::string grpc_address_ HYADES_GUARDED_BY(state_lock);
  std::string unguarded_ HYADES_GUARDED_BY(state_lock);
};

}  // namespace hyades::coordinator
