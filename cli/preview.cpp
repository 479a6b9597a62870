#include "cli/preview.h"

#include <algorithm>
#include <cstdint>

#include "core/job/noise_threshold.h"

namespace hyades::cli {

void make_preview(core::Job& job, int width) {
  core::FilmDesc& film = job.film;
  const int64_t height = (int64_t{film.height} * width + film.width / 2) / film.width;
  film.height = static_cast<int32_t>(std::clamp<int64_t>(height, 1, 65536));
  film.width = width;
  film.crop.reset();
  job.sampling.samples = kPreviewSamples;
  job.sampling.noise = 0.0F;
  job.keep_films = false;

  core::OutputDesc preview;
  if (const core::OutputDesc* shown = core::display_output(job)) preview.tone_map = shown->tone_map;
  preview.exposure = core::shown_exposure(job);
  const char* const marks = job.frames.first == job.frames.last ? "" : ".####";
  preview.file = job.name + marks + ".preview.png";
  preview.denoise = "true";
  job.outputs = {preview};
  job.videos.clear();
}

}  // namespace hyades::cli
