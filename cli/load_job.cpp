#include "cli/load_job.h"

#include <cstdio>
#include <filesystem>

#include "cli/frame_range.h"
#include "cli/mesh_job.h"
#include "core/job/parse.h"

namespace hyades::cli {

using core::Diagnostics;

namespace {

/// What `path` is called from `folder` on.
std::string reference_from(const std::string& path, const std::string& folder) {
  if (path.empty()) return path;
  const auto normal = [](const std::filesystem::path& p) {
    return std::filesystem::absolute(p).lexically_normal();
  };
  const std::filesystem::path from = normal(folder.empty() ? "." : folder + "/");
  return normal(path).lexically_relative(from).string();
}

std::string folder_of(const std::string& path) {
  const std::filesystem::path file(path);
  return file.has_parent_path() ? file.parent_path().string() : ".";
}

}  // namespace

bool is_mesh(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  return extension == ".obj" || extension == ".ply" || extension == ".OBJ" || extension == ".PLY";
}

core::Result<std::string> text_of_mesh_job(const std::string& mesh, const std::string& media,
                                           const std::string& folder) {
  const auto assets = core::make_file_resolver(folder);
  return mesh_job_text({reference_from(mesh, folder), reference_from(media, folder)}, *assets);
}

std::optional<LoadedJob> read_job_file(const std::string& path, Diagnostics& diagnostics,
                                       const std::string& media) {
  LoadedJob loaded;
  const std::string folder = folder_of(path);
  loaded.files = core::make_file_resolver(folder);
  loaded.assets = std::make_unique<core::RecordingResolver>(*loaded.files);
  std::string text;
  if (is_mesh(path)) {
    auto made = text_of_mesh_job(path, media, folder);
    if (!made) {
      std::fprintf(stderr, "%s\n", made.error().message.c_str());
      return std::nullopt;
    }
    text = *made;
  } else if (!media.empty()) {
    std::fprintf(stderr, "%s: --media is for meshes (.obj, .ply); a job names its media itself\n",
                 path.c_str());
    return std::nullopt;
  } else {
    const auto bytes = loaded.files->open(std::filesystem::path(path).filename().string());
    if (!bytes) {
      std::fprintf(stderr, "%s\n", bytes.error().message.c_str());
      return std::nullopt;
    }
    text.assign(bytes->chars(), bytes->size());
  }
  loaded.job = core::parse_job(text, path, *loaded.assets, diagnostics);
  return loaded;
}

std::optional<LoadedJob> load_job(const std::string& path, const std::string& media) {
  Diagnostics diagnostics;
  auto loaded = read_job_file(path, diagnostics, media);
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

bool is_in_range(const core::Job& job, int32_t frame) {
  if (frame >= job.frames.first && frame <= job.frames.last) return true;
  std::fprintf(stderr, "--frame %d: expected a frame within the job's range %d-%d\n", frame,
               job.frames.first, job.frames.last);
  return false;
}

}  // namespace hyades::cli
