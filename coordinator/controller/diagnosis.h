#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <grpcpp/support/status.h>

#include "coordinator/controller/worker_table.h"

namespace hyades::coordinator {

class DiskWatch;
class VideoMaker;
class WorkerSessions;

/// Why a job does or does not get on, in words. Thread-safe.
class Diagnosis {
 public:
  Diagnosis(Shared& shared, Dispatcher& dispatcher, JobTable& jobs, WorkerTable& workers,
            const WorkerSessions& sessions, const DiskWatch& disk, const VideoMaker& videos)
      : shared_(shared),
        dispatcher_(dispatcher),
        jobs_(jobs),
        workers_(workers),
        sessions_(sessions),
        disk_(disk),
        videos_(videos) {}

  /// May wait for the store; explain_open() answers for jobs that have not ended, and says no for
  /// others.
  grpc::Status explain(uint64_t job, v1::ExplainResponse& response) HYADES_EXCLUDES(state_lock);
  bool explain_open(uint64_t job, v1::ExplainResponse& response) HYADES_EXCLUDES(state_lock);

 private:
  // needs.cpp
  std::string unmet_needs(const StoredJob& job) const HYADES_REQUIRES(state_lock);
  std::vector<std::string> barred_workers() const HYADES_REQUIRES(state_lock);
  std::vector<std::string> where_units_are(JobId job) const HYADES_REQUIRES(state_lock);
  std::vector<std::string> still_units(JobId job) const HYADES_REQUIRES(state_lock);

  Shared& shared_;
  Dispatcher& dispatcher_;
  JobTable& jobs_;
  const WorkerTable& workers_;
  const WorkerSessions& sessions_;
  const DiskWatch& disk_;
  const VideoMaker& videos_;
};

}  // namespace hyades::coordinator
