#include "cli/load_job.h"

#include <cstdio>
#include <filesystem>

#include "cli/frame_range.h"
#include "cli/mesh_job.h"
#include "core/job/parse.h"

namespace hyades::cli {

using core::Diagnostics;

namespace {

bool is_mesh(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  return extension == ".obj" || extension == ".ply" || extension == ".OBJ" || extension == ".PLY";
}

}  // namespace

std::optional<LoadedJob> read_job_file(const std::string& path, Diagnostics& diagnostics) {
  const std::filesystem::path file(path);
  LoadedJob loaded;
  loaded.files =
      core::make_file_resolver(file.has_parent_path() ? file.parent_path().string() : ".");
  loaded.assets = std::make_unique<core::RecordingResolver>(*loaded.files);
  if (is_mesh(path)) {
    auto made = make_mesh_job(file.filename().string(), *loaded.assets);
    if (!made) {
      std::fprintf(stderr, "%s\n", made.error().message.c_str());
      return std::nullopt;
    }
    loaded.job = std::move(*made);
    return loaded;
  }
  auto text = loaded.files->open(file.filename().string());
  if (!text) {
    std::fprintf(stderr, "%s\n", text.error().message.c_str());
    return std::nullopt;
  }
  loaded.job =
      core::parse_job(std::string(text->chars(), text->size()), path, *loaded.assets, diagnostics);
  return loaded;
}

std::optional<LoadedJob> load_job(const std::string& path) {
  Diagnostics diagnostics;
  auto loaded = read_job_file(path, diagnostics);
  if (!diagnostics.empty()) {
    std::fprintf(stderr, "%s\n", diagnostics.to_string().c_str());
    return std::nullopt;
  }
  return loaded;
}

std::optional<std::vector<int32_t>> select_frames(const core::Job& job, const std::string& text) {
  const auto range = parse_frames(job.frames, text);
  if (!range) {
    std::fprintf(stderr, "%s\n", range.error().message.c_str());
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

}  // namespace hyades::cli
