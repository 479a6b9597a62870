// The scheduler of a simulated farm (tests/coordinator/scheduler/big_world.h) of 10,000 workers
// with four threads each: how much of the threads' time counts, and what the scheduler takes of a
// processor. bench_big_farm [WORKERS [MINUTES [SEED [JOBS [OWNERS]]]]]: about so many minutes of
// work.
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
  if (argc > 3) options.seed = std::strtoull(argv[3], nullptr, 10);
  if (argc > 4) options.jobs = std::strtoull(argv[4], nullptr, 10);
  if (argc > 5) options.owners = std::strtoull(argv[5], nullptr, 10);
  // A frame is 2,040 tiles of 64 batches; machines are a little faster than one in the mean.
  const double frame_seconds = 2040.0 * 64 * options.batch_seconds / 1.1;
  const double frames = 60 * minutes * static_cast<double>(options.workers) * options.threads /
                        frame_seconds / static_cast<double>(options.jobs);
  options.frames = std::max(1, static_cast<int>(frames));
  try {
    const BigWorldReport r = BigWorld(options).run();
    std::printf("%zu workers, %u threads each, %zu jobs of %d frames\n", options.workers,
                options.threads, options.jobs, options.frames);
    print(r);
  } catch (const std::string& wrong) {
    std::printf("%s\n", wrong.c_str());
    return 1;
  }
  return 0;
}
