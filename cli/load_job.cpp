#include "cli/load_job.h"

#include <cstdint>
#include <cstdio>
#include <utility>

#include "cli/command_line.h"
#include "cli/frame_range.h"
#include "cli/number_range.h"
#include "core/job/parse.h"

namespace hyades::cli {

using core::Diagnostics;

std::optional<LoadedJob> read_job_file(const std::string& path, Diagnostics& diagnostics,
                                       const SceneOptions& scene) {
  LoadedJob loaded;
  if (is_blend_file(path)) {
    auto made = BlendJob::make(path, scene.frames);
    if (!made) {
      print_error(made.error(), path);
      return std::nullopt;
    }
    loaded.blend = std::move(*made);
  }
  auto files =
      core::JobFiles::open(loaded.blend ? loaded.blend->path() : path, job_file_options(scene));
  if (!files) {
    print_error(files.error(), path);
    return std::nullopt;
  }
  loaded.files = std::move(*files);
  core::AssetResolver& door = loaded.files->files();
  const auto text = door.open(loaded.files->document());
  if (!text) {
    print_error(text.error(), path);
    return std::nullopt;
  }
  loaded.assets = std::make_unique<core::RecordingResolver>(door);
  loaded.job = core::parse_job({text->chars(), text->size()}, path, *loaded.assets, diagnostics);
  if (scene.render_class) loaded.job.render.render_class = *scene.render_class;
  print_notes(loaded.files->notes());
  return loaded;
}

std::optional<LoadedJob> load_job(const std::string& path, const SceneOptions& scene) {
  Diagnostics diagnostics;
  auto loaded = read_job_file(path, diagnostics, scene);
  if (!diagnostics.empty()) {
    std::fputs(diagnostics.to_string().c_str(), stderr);
    return std::nullopt;
  }
  return loaded;
}

std::optional<std::vector<int32_t>> select_frames(const core::Job& job, const std::string& text) {
  const auto range = parse_frames(job.frames, text);
  if (!range) {
    print_error(range.error());
    return std::nullopt;
  }
  const int64_t count = frame_count(range->first, range->last, range->step);
  if (count > kMostFrames) {
    std::fprintf(stderr,
                 "%lld frames, expected at most %lld in one run: choose some with --frames\n",
                 static_cast<long long>(count), static_cast<long long>(kMostFrames));
    return std::nullopt;
  }
  std::vector<int32_t> frames;
  for (int64_t f = range->first; f <= range->last; f += range->step) {
    frames.push_back(static_cast<int32_t>(f));
  }
  return frames;
}

bool is_in_range(const core::Job& job, int32_t frame) {
  if (frame >= job.frames.first && frame <= job.frames.last) return true;
  std::fprintf(stderr, "--frame %d: expected a frame within the job's range %d-%d\n", frame,
               job.frames.first, job.frames.last);
  return false;
}

}  // namespace hyades::cli
