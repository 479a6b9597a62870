#include "cli/join_films.h"

#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "core/base/printable.h"
#include "core/base/text.h"
#include "core/film/coverage_gaps.h"
#include "core/film/noise.h"
#include "core/film/unit.h"

namespace hyades::cli {
namespace {

/// A film that was joined already, to say which one a later one collides with.
struct Joined {
  std::string path;
  core::Coverage coverage;
};

/// Which of the earlier films holds something that `film` holds too; the first one for all other
/// reasons, since all earlier ones agree with it.
const std::string& opponent(const std::vector<Joined>& earlier, const core::Film& film) {
  for (const Joined& joined : earlier) {
    for (const core::CoverageBox& box : film.coverage().boxes()) {
      if (joined.coverage.overlap(box)) return joined.path;
    }
  }
  return earlier.front().path;
}

}  // namespace

core::Result<core::FilmFile> join_films(
    const std::vector<std::string>& paths,
    const std::function<core::Status(const core::FilmInfo&)>& fits) {
  const auto read = [&](const std::string& path) {
    core::Result<core::FilmFile> film = core::read_film_exr(path);
    if (!film || !fits) return film;
    const core::Status may = fits(film->info);
    return may ? std::move(film) : core::Result<core::FilmFile>(may.error().in(path));
  };
  core::Result<core::FilmFile> whole = read(paths.front());
  if (!whole) return whole;
  std::vector<Joined> joined = {{paths.front(), whole->film.coverage()}};
  for (size_t i = 1; i < paths.size(); ++i) {
    const std::string& path = paths[i];
    const core::Result<core::FilmFile> next = read(path);
    if (!next) return next.error();
    if (next->info.job_name != whole->info.job_name) {
      return core::Error{fmt::format("{} is a film of the job '{}', {} of '{}'", path,
                                     core::printable(next->info.job_name), paths.front(),
                                     core::printable(whole->info.job_name))};
    }
    if (const core::Status merged = core::merge_film_files(*whole, *next); !merged) {
      return core::Error{path + " does not fit " + opponent(joined, next->film) + ": " +
                         merged.error().message};
    }
    joined.push_back({path, next->film.coverage()});
  }
  return whole;
}

std::string share_held(const core::FilmFile& file) {
  if (file.info.aim.noise > 0) {
    const double each = file.film.all_samples() / static_cast<double>(file.info.crop.area());
    return fmt::format("{:.1f} of at most {} samples per pixel", each, file.info.samples);
  }
  const double all = static_cast<double>(file.info.crop.area()) *
                     static_cast<double>(core::batch_count(file.info.samples));
  const double held = all > 0.0 ? static_cast<double>(file.film.coverage().volume()) / all : 0.0;
  const double percent = static_cast<double>(static_cast<int>(held * 1000.0)) / 10.0;
  return fmt::format("{} % of {} samples per pixel", percent, file.info.samples);
}

std::string what_is_missing(const core::FilmFile& file) {
  const core::NoiseThreshold threshold =
      core::make_noise_threshold(file.info.aim, file.info.samples);
  if (threshold.adaptive()) {
    const std::vector<core::PixelRect> tiles =
        core::unfinished_tiles(file.film, file.info.crop, file.info.samples, threshold);
    if (tiles.empty()) return {};
    const core::PixelRect& first = tiles.front();
    return fmt::format("samples of {}, the first at pixels x {} to {}, y {} to {}",
                       core::counted(tiles.size(), "tile"), first.x0, first.x1 - 1, first.y0,
                       first.y1 - 1);
  }
  const auto gaps =
      core::gaps(file.film.coverage(), file.info.crop, core::batch_count(file.info.samples));
  return gaps.empty() ? std::string() : core::describe_gaps(gaps, file.info.samples);
}

}  // namespace hyades::cli
