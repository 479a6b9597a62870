#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace hyades::coordinator {

/// How far a run is, at one moment.
struct Progress {
  uint32_t frames = 0;  ///< in all
  uint32_t frames_done = 0;
  uint32_t frames_failed = 0;
  uint32_t frames_finishing = 0;  ///< rendered, and their outputs are being made
  std::vector<int32_t> frames_in_flight;
  uint64_t samples = 0;       ///< of all frames that have not failed; an estimate where tiles stop
                              ///< at a noise
  uint64_t samples_done = 0;  ///< of these, including those of finished frames
  uint64_t units_done = 0;    ///< in this run
  double elapsed = 0;         ///< seconds since start()
  double samples_per_second = 0;
  double seconds_left = -1;  ///< -1: cannot be told yet
  double noise = -1;         ///< of the newest film, see picture_noise(); -1: not known
  double noise_aim = 0;      ///< at which tiles have samples enough; 0: they get all
  int32_t noise_frame = 0;   ///< which frame that is
  std::string trouble;  ///< why nothing happens at the moment: "paused"; empty where something does
};

/// How long a frame took, from the first thread that had a unit of it until it was written.
struct FrameTime {
  int32_t frame = 0;
  double seconds = 0;
};

/// Why a frame has no picture.
struct FrameFailure {
  int32_t frame = 0;
  std::string reason;
};

/// How a run ended.
struct LocalOutcome {
  bool complete = false;  ///< every frame is finished or has failed
  uint32_t frames_done = 0;
  std::vector<FrameFailure> failures;
  std::string error;  ///< what stopped the run, if it was neither its end nor stop()
};

}  // namespace hyades::coordinator
