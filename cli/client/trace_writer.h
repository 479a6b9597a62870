#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <ostream>
#include <string>

#include "farm/json_form.h"
#include "hyades/v1/jobs.pb.h"

namespace hyades::cli {

/// Writes what was done for a job as trace events, in the JSON that ui.perfetto.dev and Chrome's
/// tracing open: a process for each worker with its threads, one for the coordinator; a slice for
/// each unit, merge, finished frame and video; instants out of the job's log; samples per second.
/// Takes steps in the coordinator's order and writes as they come: what it keeps does not grow with
/// them. Names of workers are cut to 200 bytes, and of more than 20,000 workers the rest are one.
class TraceWriter {
 public:
  /// `job` as it is now.
  TraceWriter(std::ostream& out, const v1::Job& job);

  void take(const v1::TimelineStep& step);
  /// Lines come after all steps.
  void take(const v1::LogLine& line);
  /// Ends the document. `job` as it is in the end.
  void end(const v1::Job& job);

  /// Of all units that were taken. Exact once a frame has been finished whose units all came; until
  /// then the last batch of a pixel counts as a whole one.
  uint64_t samples() const { return samples_; }
  uint64_t units() const { return units_; }

 private:
  /// A process of the trace. Threads that are not told have lanes, as many as work at once.
  struct Process {
    int pid = 0;
    std::map<int, int64_t> ends;  ///< of the last slice, by thread
  };
  /// What has come of a frame: how large it is follows from it.
  struct Frame {
    int64_t pixels = 0;  ///< of tiles whose first batch came
    uint32_t batches = 0;
  };

  Process& worker(const std::string& name);
  int lane(Process& process, int first, int64_t begun, const char* name);
  int told_thread(Process& process, const v1::TimelineStep& step);
  void name_thread(const Process& process, int tid, const std::string& name);
  void learn_samples(const v1::TimelineStep& step);
  void write_step(const v1::TimelineStep& step);
  void write_slice(Process& process, int tid, const v1::TimelineStep& step, const std::string& name,
                   const char* category, farm::Json arguments);
  void count(int64_t ended_us, uint64_t samples);
  void write_rate(int64_t second, uint64_t samples);
  uint64_t samples_of(const v1::Unit& unit) const;
  void write(const farm::Json& event);
  void flush_held();

  std::ostream& out_;
  const uint64_t frame_samples_;  ///< of each frame
  const int64_t epoch_us_;        ///< times count from here
  bool first_ = true;
  Process coordinator_;
  std::map<std::string, Process> workers_;
  std::deque<v1::TimelineStep> held_;  ///< until the number of samples per pixel is known
  std::map<int32_t, Frame> frames_;    ///< that are not finished
  uint32_t samples_per_pixel_ = 0;     ///< 0: not known yet
  bool holding_ = true;
  int64_t second_ = -1;  ///< since epoch_us_, whose samples are being counted
  uint64_t in_second_ = 0;
  uint64_t samples_ = 0;
  uint64_t units_ = 0;
};

}  // namespace hyades::cli
