#include "core/job/film_file.h"

#include <fmt/format.h>

#include "core/base/version.h"
#include "core/job/noise_threshold.h"

namespace hyades::core {

std::string film_file(const Job& job) {
  return job.name + (job.frames.last > job.frames.first ? ".####.film.exr" : ".film.exr");
}

FilmInfo film_info(const Job& job, int32_t frame, const std::vector<AssetRecord>& assets) {
  FilmInfo info;
  info.job_name = job.name;
  info.render_key = render_key(job, frame, assets);
  info.frame = frame;
  info.width = job.film.width;
  info.height = job.film.height;
  info.crop = render_window(job.film);
  info.samples = job.sampling.samples;
  info.aim = noise_threshold(job).aim;
  info.build = fmt::format("hyades {}, renderer {}", kVersion, kRendererRevision);
  return info;
}

}  // namespace hyades::core
