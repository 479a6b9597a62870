#include "core/job/noise_threshold.h"

#include "core/job/output_path.h"

namespace hyades::core {

const OutputDesc* display_output(const Job& job) {
  for (const OutputDesc& output : job.outputs) {
    if (file_extension(output.file) != ".exr") return &output;
  }
  return nullptr;
}

float shown_exposure(const Job& job) {
  if (const OutputDesc* shown = display_output(job)) return shown->exposure;
  return job.outputs.empty() ? 0.0F : job.outputs.front().exposure;
}

NoiseThreshold noise_threshold(const Job& job) {
  const SamplingDesc& sampling = job.sampling;
  const NoiseAim aim{sampling.noise, shown_exposure(job), sampling.min_samples};
  NoiseThreshold threshold = make_noise_threshold(aim, sampling.samples);
  if (!threshold.adaptive()) threshold.aim = {0.0F, aim.exposure, 0};
  return threshold;
}

}  // namespace hyades::core
