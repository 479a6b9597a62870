#include "cli/render_options.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string_view>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/address_option.h"
#include "cli/command_line.h"
#include "cli/duration_option.h"
#include "cli/film_size_option.h"
#include "cli/frame_range.h"
#include "cli/number_range.h"
#include "cli/whole_numbers.h"
#include "cli/written_file.h"
#include "core/job/film_file.h"
#include "core/job/noise_threshold.h"
#include "core/job/output_path.h"

namespace hyades::cli {
namespace {

constexpr uint32_t kPreviewSamples = 32;

/// A check for options of CLI11 out of what parses their text.
template <auto Parse>
std::string is_right(const std::string& text) {
  const auto parsed = Parse(text);
  return parsed ? std::string() : parsed.error().message;
}

/// The words of the command line, with "--film" and a file .exr behind it as one: the file may be
/// left out, and the job may follow.
std::vector<std::string> joined_film(int argc, char** argv) {
  std::vector<std::string> words(argv, argv + argc);
  for (size_t i = 1; i + 1 < words.size(); ++i) {
    if (words[i] != "--film" || core::file_extension(words[i + 1]) != ".exr") continue;
    words[i] += "=" + words[i + 1];
    words.erase(words.begin() + static_cast<std::ptrdiff_t>(i) + 1);
  }
  return words;
}

core::PixelRect crop_of(const RenderOptions& options, const core::Job& job) {
  const core::PixelRect whole = core::render_window(job.film);
  if (options.crop.empty()) return whole;
  return intersection(whole, {options.crop[0], options.crop[1], options.crop[2], options.crop[3]});
}

/// Whether an edge of `part` lies within tiles of `whole` that are judged by their noise.
bool cuts_judged_tiles(const core::PixelRect& part, const core::PixelRect& whole) {
  const auto cuts = [](int32_t edge, int32_t first, int32_t last) {
    return edge != first && edge != last && edge % core::kJudgedTile != 0;
  };
  return cuts(part.x0, whole.x0, whole.x1) || cuts(part.x1, whole.x0, whole.x1) ||
         cuts(part.y0, whole.y0, whole.y1) || cuts(part.y1, whole.y0, whole.y1);
}

/// Makes small pictures of `job`: `width` pixels wide, of the whole frame, with few samples,
/// denoised; one PNG, NAME.preview.png (NAME.####.preview.png where there are several frames),
/// shown as the job's first output that is no EXR.
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

/// ".tile-2-of-3.samples-0-31"
std::string part_text(const RenderOptions& options) {
  std::string text;
  if (options.tile) {
    text += fmt::format(".tile-{}-of-{}", options.tile->index, options.tile->count);
  }
  if (const auto& range = options.samples.range) {
    text += fmt::format(".samples-{}-{}", range->first, range->last);
  }
  return text;
}

/// Options as they are written.
struct Words {
  std::string samples;
  std::string tile;
  std::optional<int64_t> preview;
};

void declare_what(CLI::App& app, RenderOptions& options, Words& words) {
  app.add_option("job", options.path, job_words())->required();
  app.add_option("--frames", options.frames,
                 "frames to render: 7, 1-10 or 1-10x2 (default: all; at most a million)")
      ->check(no_frames_error)
      ->type_name("RANGE");
  auto* samples =
      app.add_option(
             "--samples", words.samples,
             "samples per pixel (default: the job's); 0-31, or 0-31/256: only these of them, "
             "whole batches of 16, which writes only films")
          ->check(is_right<parse_samples>)
          ->type_name("N");
  add_duration(app, "--time", options.time,
               "as many samples per pixel as all frames can have in about this time (90s, 10m, "
               "2h), however many the job says",
               1)
      ->excludes(samples);
  app.add_option("--tile", words.tile, "2/3: only this part of each frame, which writes only films")
      ->check(is_right<parse_tile>)
      ->type_name("I/N");
  declare_film_size(app, options.size);
  add_whole_numbers(app, "--crop", options.crop, "X0,Y0,X1,Y1", "render only these pixels");
  // Not a plain flag: CLI11 2.4 sets those that have a default and were not given, and counts them.
  app.add_flag_function(
         "--preview{320}", [&words](int64_t width) { words.preview = width; },
         "render a small denoised picture of the first frame (or --frames) with 32 samples, "
         "NAME.preview.png; --preview=N makes it N pixels wide, 16 to 8192")
      ->type_name("[=N]");
}

void declare_resources(CLI::App& app, RenderOptions& options) {
  app.add_option("--threads", options.threads, "rendering threads")
      ->check(in_range(1, 1024))
      ->capture_default_str();
  app.add_option("--film-memory", options.film_memory,
                 "most memory that films may take, such as 8G; jobs of larger ones are refused "
                 "(default: half of what is here)")
      ->transform(CLI::AsSizeValue(false));
  app.add_option(
         "--texture-memory", options.texture_memory,
         "most memory for the pixels of textures, such as 2G; others lie in files of TMPDIR "
         "(default: a quarter of what is here)")
      ->transform(CLI::AsSizeValue(false));
}

void declare_results(CLI::App& app, RenderOptions& options) {
  app.add_option("--display", options.display,
                 "HOST:PORT of the viewer tev: shows the picture there while it is rendered, with "
                 "all its layers (tev listens on 127.0.0.1:14158)")
      ->check(address_error);
  declare_output_folder(app, options.folder);
  app.add_flag(
         "--film{*}", options.film_file,
         "also write each frame's film, for 'hyades merge' and 'hyades finish': to "
         "NAME.film.exr below --output, as keep_films in the job does, or to the file of --film "
         "FILE.exr, wherever --output is (#### for the frame)")
      ->check([](const std::string& file) {
        return file == "*" || core::file_extension(file) == ".exr"
                   ? std::string()
                   : file + ": expected a file .exr";
      });
  auto* resume = app.add_flag(
      "--resume", options.resume,
      "go on with what an interrupted run has kept, as is done anyway; where that is of another "
      "picture render nothing, though its frames are finished");
  app.add_flag("--restart", options.restart,
               "render from the beginning, whatever an interrupted run has kept")
      ->excludes(resume);
  app.add_flag("!--no-resume", options.keep_work,
               "keep nothing for a run that is interrupted: where the disk has no room for films "
               "(with --restart also where an earlier run has kept some)")
      ->excludes(resume);
  app.add_flag("--overwrite", options.overwrite,
               "replace files that are there, whoever made them (default: those of this job that "
               "have no more samples or pixels in them)");
  app.add_flag("-q,--quiet", options.quiet, "show no progress");
  app.add_flag("--json", options.json,
               "for programs: print progress and what is written, a JSON object a line");
}

}  // namespace

std::optional<int> parse_render_options(int argc, char** argv, RenderOptions& options) {
  CLI::App app("Renders a job, or a scene or mesh of another tool, on this machine.",
               "hyades render");
  Words words;
  declare_what(app, options, words);
  declare_resources(app, options);
  declare_results(app, options);
  declare_class_option(app, options.scene);
  declare_scene_options(app, options.scene);
  app.footer(
      "examples:\n"
      "  hyades render jobs/quickstart/job.yaml\n"
      "  hyades render jobs/perlin-sphere/job.yaml --frames 1-24 --output out\n"
      "  hyades render jobs/atlas/job.yaml --preview\n"
      "  hyades render jobs/atlas/job.yaml --time 20m\n"
      "  hyades render jobs/cornell/job.yaml --display 127.0.0.1:14158\n"
      "  hyades render robot.glb --samples 64\n"
      "  hyades render bottles.obj --media media.json\n"
      "  hyades render spiral.lua --set count=200\n"
      "  hyades render film.blend --frames 1-24 --output out\n"
      "  hyades render job.yaml --frames 7 --tile 2/3 --samples 0-127 --film part.exr\n"
      "Ctrl-C stops; the same command goes on with what is done, to the same bits, also after a "
      "crash.\n"
      "exit status: 0 done, 1 something failed, 2 the job or the arguments are wrong, 130 "
      "interrupted");
  auto arguments = joined_film(argc, argv);
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  if (const auto status =
          parse_command_line(app, static_cast<int>(pointers.size()), pointers.data(), kBadInput)) {
    return status;
  }
  if (words.preview) {
    if (*words.preview < 16 || *words.preview > 8192) {
      std::fprintf(stderr, "--preview: expected 16 to 8192 pixels\n");
      return kBadInput;
    }
    options.preview = static_cast<int>(*words.preview);
  }
  if (!words.samples.empty()) options.samples = *parse_samples(words.samples);
  if (!words.tile.empty()) options.tile = *parse_tile(words.tile);
  options.film = !options.film_file.empty();
  if (options.film_file == "*") options.film_file.clear();
  options.quiet |= options.json;
  return std::nullopt;
}

std::optional<LoadedJob> load_for_render(const RenderOptions& options) {
  SceneOptions scene = options.scene;
  scene.frames = options.frames;
  auto loaded = load_job(options.path, scene);
  if (!loaded) return std::nullopt;
  core::Job& job = loaded->job;
  resize_film(options.size, job.film);
  if (options.preview > 0) make_preview(job, options.preview);
  if (options.samples.of > 0) job.sampling.samples = options.samples.of;
  if (!options.crop.empty()) {
    const core::PixelRect crop{options.crop[0], options.crop[1], options.crop[2], options.crop[3]};
    const core::PixelRect whole = core::render_window(job.film);
    if (crop.empty() || !whole.contains(crop)) {
      std::fprintf(stderr,
                   "--crop: expected X0,Y0,X1,Y1 within what the job renders, %d,%d,%d,%d\n",
                   whole.x0, whole.y0, whole.x1, whole.y1);
      return std::nullopt;
    }
  }
  const auto complain = [](const std::string& message) {
    std::fprintf(stderr, "%s\n", message.c_str());
    return std::nullopt;
  };
  if (options.is_part() && options.preview > 0) {
    return complain("--preview: expected no --tile and no --samples of a range beside it");
  }
  if (options.time > 0 && (options.is_part() || options.preview > 0)) {
    return complain("--time: expected no --tile and no --preview beside it");
  }
  if (options.tile) {
    const core::PixelRect whole = crop_of(options, job);
    const auto tile = tile_of(whole, *options.tile);
    if (!tile) return complain(tile.error().message);
    if (core::noise_threshold(job).adaptive() && cuts_judged_tiles(*tile, whole)) {
      return complain(fmt::format(
          "--tile {}/{}: expected fewer parts, for the job stops at a noise: its tiles of {} x {} "
          "pixels are judged whole",
          options.tile->index, options.tile->count, core::kJudgedTile, core::kJudgedTile));
    }
  }
  if (options.samples.range) {
    const auto batches = batches_of(*options.samples.range, job.sampling.samples);
    if (!batches) return complain(batches.error().message);
    if (core::noise_threshold(job).adaptive()) {
      return complain(
          "--samples: expected how many, not which: the job stops at a noise, which cannot be told "
          "of some samples alone");
    }
  }
  return loaded;
}

core::PixelRect window_of(const RenderOptions& options, const core::Job& job) {
  const core::PixelRect crop = crop_of(options, job);
  return options.tile ? tile_of(crop, *options.tile).value() : crop;
}

core::BatchRange batches_of(const RenderOptions& options, const core::Job& job) {
  if (!options.samples.range) return {};
  return batches_of(*options.samples.range, job.sampling.samples).value();
}

std::string film_file_of(const RenderOptions& options, const core::Job& job) {
  if (!options.film_file.empty() || !options.is_part()) return options.film_file;
  constexpr std::string_view kEnd = ".film.exr";
  std::string file = core::film_file(job);
  file.insert(file.size() - kEnd.size(), part_text(options));
  return (std::filesystem::path(options.folder) / file).string();
}

std::string kept_name(const RenderOptions& options, const core::Job& job) {
  // It writes other files, and must not cost what is kept of the job's own.
  if (options.preview > 0) return job.name + ".preview";
  // Nor must a part of the picture that somebody looks at.
  if (!options.is_part() && options.crop.empty()) return job.name;
  const std::string crop =
      options.crop.empty() ? "" : fmt::format(".crop-{}", fmt::join(options.crop, "-"));
  return job.name + ".frames-" + (options.frames.empty() ? "all" : options.frames) + crop +
         part_text(options);
}

}  // namespace hyades::cli
