#pragma once

#include <csignal>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "farm/channel.h"
#include "worker/clouds/cloud.h"

namespace hyades::worker {

struct WorkerOptions {
  farm::Peer coordinator;
  int threads = 1;
  uint64_t memory = 0;      ///< bytes for scenes and all else of the rendering child; 0: no limit
  std::string cache;        ///< folder for files_folder(), ids and tokens; made if it is missing
  uint64_t cache_size = 0;  ///< bytes; 0: no limit
  /// Bytes of textures that a quarter of the memory does not hold, in a file; none: four times
  /// `memory`. Never more than half of what is free on that disk.
  std::optional<uint64_t> texture_disk;
  std::string name;  ///< for people
  std::vector<std::string> tags;
  double grace = 2.0;        ///< seconds from SIGTERM to the end
  double hang_limit = 60;    ///< seconds without a new sample of a unit; 0: for ever (UnitClock)
  double unit_limit = 3600;  ///< seconds for one unit; 0: no limit (UnitClock)
  double idle_limit = 0;     ///< seconds without work after which it ends; 0: never
  int told_status = 0;       ///< exit status where a signal or the cloud ended it, not lack of work
  std::string sandbox = "auto";  ///< of the rendering child: auto, require or off
  std::optional<Cloud> cloud;    ///< whose notices of pre-emption to watch for
  std::string cloud_endpoint;    ///< instead of the cloud's own metadata service; empty: that one
  std::string renderer;          ///< path of hyades-worker-render
};

/// Where in the cache the files of jobs are: all of it that the rendering child may open.
inline std::string files_folder(const WorkerOptions& options) { return options.cache + "/files"; }

/// Works for a coordinator until `signals` is not 0, it is drained, or it was idle for long enough.
/// Returns the process' exit status: 0 when it was drained or idle, `told_status` when a signal or
/// the cloud ended it, 1 where it cannot work here, 2 where an option or its file is wrong, or the
/// coordinator does not want it (token, version).
int run_worker(const WorkerOptions& options, const volatile std::sig_atomic_t& signals);

}  // namespace hyades::worker
