#pragma once

#include <cstdint>
#include <set>
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
  Diagnosis(ControllerContext& context, Dispatcher& dispatcher, JobTable& jobs,
            WorkerTable& workers, const WorkerSessions& sessions, const DiskWatch& disk,
            const VideoMaker& videos)
      : context_(context),
        dispatcher_(dispatcher),
        jobs_(jobs),
        workers_(workers),
        sessions_(sessions),
        disk_(disk),
        videos_(videos) {}

  /// Why the job gets on or does not. NOT_FOUND; UNAVAILABLE where the store does not answer. May
  /// wait for the store.
  grpc::Status explain(uint64_t job, v1::ExplainResponse& response) HYADES_EXCLUDES(state_lock);
  /// explain() without waiting: false, and nothing is told, where the job has ended or is none.
  bool explain_open(uint64_t job, v1::ExplainResponse& response) HYADES_EXCLUDES(state_lock);
  /// Finds out, of all jobs that wait, whether anybody who is there may render them
  /// (ActiveJob::obstacle); to be called from time to time.
  void note_obstacles() HYADES_REQUIRES(state_lock);

 private:
  class Reasons;
  template <class Frames>
  static void explain_black(const Frames& frames, Reasons& reasons);
  void explain_state(const ActiveJob& active, Reasons& reasons) const HYADES_REQUIRES(state_lock);
  bool explain_workers(const ActiveJob& active, bool anybody, Reasons& reasons) const
      HYADES_REQUIRES(state_lock);
  bool explain_frames(const ActiveJob& active, const std::set<std::string>& classes,
                      Reasons& reasons) const HYADES_REQUIRES(state_lock);
  bool explain_units(const ActiveJob& active, bool anybody, Reasons& reasons) const
      HYADES_REQUIRES(state_lock);
  void explain_noise(const ActiveJob& active, Reasons& reasons) const HYADES_REQUIRES(state_lock);
  void explain_rivals(const ActiveJob& active, Reasons& reasons) const HYADES_REQUIRES(state_lock);
  // diagnosis_needs.cpp
  bool anybody() const HYADES_REQUIRES(state_lock);
  std::string unmet_needs(const JobNeeds& job) const HYADES_REQUIRES(state_lock);
  std::vector<std::string> barred_workers() const HYADES_REQUIRES(state_lock);
  std::vector<std::string> where_units_are(JobId job) const HYADES_REQUIRES(state_lock);
  std::vector<std::string> still_units(JobId job) const HYADES_REQUIRES(state_lock);

  ControllerContext& context_;
  Dispatcher& dispatcher_;
  JobTable& jobs_;
  const WorkerTable& workers_;
  const WorkerSessions& sessions_;
  const DiskWatch& disk_;
  const VideoMaker& videos_;
};

}  // namespace hyades::coordinator
