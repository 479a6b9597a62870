#include "core/job/noise_threshold.h"

namespace hyades::core {

NoiseThreshold noise_threshold(const Job& job) {
  const OutputDesc* shown = display_output(job.outputs);
  return make_noise_threshold(job.sampling.noise, shown == nullptr ? 0.0F : shown->exposure,
                              job.sampling.min_samples, job.sampling.samples);
}

}  // namespace hyades::core
