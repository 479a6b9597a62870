#include "cli/merge_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <string>
#include <vector>

#include "cli/command_line.h"
#include "core/film/film_exr.h"
#include "core/film/unit.h"

namespace hyades::cli {
namespace {

constexpr int kRefused = 2;

struct Options {
  std::vector<std::string> inputs;
  std::string output;
  bool quiet = false;
};

/// A film that was joined already, to say which one a later one collides with.
struct Joined {
  std::string path;
  core::Coverage coverage;
};

void declare(CLI::App& app, Options& options) {
  app.add_option("films", options.inputs, "film EXRs of the same frame of the same job")
      ->required();
  app.add_option("-o,--output", options.output, "where to write the joined film")->required();
  app.add_flag("-q,--quiet", options.quiet, "say nothing where all goes well");
  app.footer(
      "Example: two machines render half of the samples each, a third one joins them:\n"
      "  hyades merge north.0007.exr south.0007.exr -o film.0007.exr\n\n"
      "Films that were merged in any order, or by way of other films, are the same to the last "
      "bit. Refused are films of different render keys, frames, sizes, crops, sample counts or "
      "classes of machines, and films that hold the same samples.\n\n"
      "Exit status: 0 fine, 2 wrong arguments, or films that cannot be read or do not fit.");
}

int fail(const std::string& message) {
  std::fprintf(stderr, "hyades merge: %s\n", message.c_str());
  return kRefused;
}

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

/// "frame 7 of fog: 3 films, 62.5 % of 256 samples per pixel".
std::string describe(const core::FilmFile& file, size_t count) {
  const double all = static_cast<double>(file.info.crop.area()) *
                     static_cast<double>(core::batch_count(file.info.samples));
  const double held = all > 0.0 ? static_cast<double>(file.film.coverage().volume()) / all : 0.0;
  // Rounded down, so that only a complete film is called one.
  const double percent = static_cast<double>(static_cast<int>(held * 1000.0)) / 10.0;
  return fmt::format("frame {} of {}: {} film{}, {} % of {} samples per pixel", file.info.frame,
                     file.info.job_name, count, count == 1 ? "" : "s", percent, file.info.samples);
}

int merge(const Options& options) {
  core::Result<core::FilmFile> whole = core::read_film_exr(options.inputs.front());
  if (!whole) return fail(whole.error().message);
  std::vector<Joined> joined = {{options.inputs.front(), whole->film.coverage()}};
  for (size_t i = 1; i < options.inputs.size(); ++i) {
    const std::string& path = options.inputs[i];
    const core::Result<core::FilmFile> next = core::read_film_exr(path);
    if (!next) return fail(next.error().message);
    if (const core::Status merged = core::merge_film_files(*whole, *next); !merged) {
      return fail(path + " does not fit " + opponent(joined, next->film) + ": " +
                  merged.error().message);
    }
    joined.push_back({path, next->film.coverage()});
  }
  if (const core::Status written = core::write_film_exr(options.output, *whole); !written) {
    return fail(written.error().message);
  }
  if (!options.quiet) {
    std::printf("%s: %s\n", options.output.c_str(), describe(*whole, joined.size()).c_str());
  }
  return 0;
}

}  // namespace

int merge_command(int argc, char** argv) {
  CLI::App app("joins films of the same frame into one", "hyades merge");
  Options options;
  declare(app, options);
  if (const auto status = parse_command_line(app, argc, argv, kRefused)) return *status;
  return merge(options);
}

}  // namespace hyades::cli
