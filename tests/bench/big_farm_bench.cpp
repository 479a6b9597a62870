// The scheduler of a simulated farm (tests/coordinator/scheduler/big_world.h) of 10,000 workers
// with four threads each: how much of the threads' time counts, and what the scheduler takes of a
// processor. bench_big_farm [WORKERS [MINUTES]]: about so many minutes of work for so many.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "tests/coordinator/scheduler/big_world.h"

int main(int argc, char** argv) {
  using namespace hyades::coordinator;
  BigWorldOptions options;
  if (argc > 1) options.workers = std::strtoull(argv[1], nullptr, 10);
  const double minutes = argc > 2 ? std::strtod(argv[2], nullptr) : 30;
  // A frame is 2,040 tiles of 64 batches; machines are a little faster than one in the mean.
  const double frame_seconds = 2040.0 * 64 * options.batch_seconds / 1.1;
  const double frames = 60 * minutes * static_cast<double>(options.workers) * options.threads /
                        frame_seconds / static_cast<double>(options.jobs);
  options.frames = std::max(1, static_cast<int>(frames));
  try {
    const BigWorldReport r = BigWorld(options).run();
    const double percent = 100 / r.thread_seconds;
    std::printf(
        "%zu workers, %u threads each, %zu jobs of %d frames: %.0f s\n"
        "  counts %.2f %%  lost %.2f %%  waiting for scenes %.2f %% of the threads' time\n"
        "  %.0f units/s of %.2f s, %.0f scenes/s, %.1f pre-empted/min\n"
        "  %.0f events/s, %.2f us each: %.1f %% of a processor\n",
        options.workers, options.threads, options.jobs, options.frames, r.duration,
        percent * r.counted, percent * r.lost, percent * r.waiting_for_scene,
        static_cast<double>(r.units) / r.duration,
        (r.counted + r.lost) / static_cast<double>(r.units),
        static_cast<double>(r.scenes_loaded) / r.duration,
        static_cast<double>(r.preempted) / r.duration * 60,
        static_cast<double>(r.events) / r.duration,
        1e6 * r.cpu_seconds / static_cast<double>(r.events), 100 * r.cpu_seconds / r.duration);
  } catch (const std::string& wrong) {
    std::printf("%s\n", wrong.c_str());
    return 1;
  }
  return 0;
}
