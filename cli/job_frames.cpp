#include "cli/job_frames.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "cli/own_files.h"
#include "cli/sample_cost.h"
#include "core/base/folder_links.h"
#include "core/base/hash.h"
#include "core/base/leftovers.h"
#include "core/base/printable.h"
#include "core/film/black.h"
#include "core/film/film_exr.h"
#include "core/finish/frame_outputs.h"
#include "core/finish/picture.h"
#include "core/job/film_file.h"
#include "core/job/layers.h"
#include "core/job/output_path.h"
#include "core/job/render_key.h"
#include "core/render/class_probe.h"
#include "core/scene/build_scene.h"
#include "core/scene/scene_files.h"

namespace hyades::cli {
namespace {

constexpr size_t kBadExamples = 5;

/// So many frames' keys are remembered: more than are in flight.
constexpr size_t kKeysKept = 16;

/// This machine's class in which the job is rendered. Empty where Embree does not run and is
/// wanted: then there is no film either.
std::string class_for(const core::Job& job) {
  const auto measured = core::this_class(job.render.render_class);
  return measured ? *measured : std::string();
}

}  // namespace

/// A loaded frame.
class JobFrames::Work : public coordinator::FrameWork {
 public:
  Work(JobFrames& owner, int32_t frame, std::shared_ptr<const core::Scene> scene)
      : owner_(owner),
        frame_(frame),
        renderer_(std::move(scene), owner.loaded_.job, frame, owner.layers_) {}

  core::Result<core::Film> render(const core::Unit& unit,
                                  const std::atomic<bool>& stop) const override {
    core::RenderedUnit done = renderer_.render(unit, &stop);
    owner_.note(frame_, done.counters);
    return std::move(done.film);
  }

 private:
  JobFrames& owner_;
  int32_t frame_;
  core::FrameRenderer renderer_;
};

JobFrames::JobFrames(LoadedJob& loaded, Options options)
    : loaded_(loaded),
      options_(std::move(options)),
      layers_(core::needed_layers(loaded.job)),
      assets_(loaded.assets->records()),
      cache_(*loaded.assets, std::make_shared<core::TexelStore>(options_.texture_memory)) {}

core::Status JobFrames::check_film_names() const {
  if (!options_.write_films) return {};
  const std::string film =
      options_.film_file.empty() ? core::film_file(loaded_.job) : below_folder(options_.film_file);
  for (const core::OutputDesc& output : loaded_.job.outputs) {
    if (!core::same_output_path(output.file, film) &&
        !core::nested_output_paths(output.file, film)) {
      continue;
    }
    const std::string message = fmt::format(
        "file is '{}', where --film writes the film, expected another name", output.file);
    return core::Error{core::Diagnostic{output.where, message}.to_string()};
  }
  return {};
}

/// Everything that a run of `frames` writes.
std::vector<std::string> JobFrames::all_paths(const std::vector<int32_t>& frames) const {
  std::vector<std::string> paths;
  for (const int32_t frame : frames) {
    for (std::string& path : output_paths(frame)) paths.push_back(std::move(path));
  }
  if (!options_.only_films) {
    for (const std::filesystem::path& video : video_paths()) paths.push_back(video.string());
  }
  return paths;
}

core::Status JobFrames::check_outputs(const std::vector<int32_t>& frames, bool overwrite) const {
  const std::vector<std::string> paths = all_paths(frames);
  core::FolderLinks links(options_.folder);
  for (const std::string& path : paths) {
    if (auto stays = links.check(path); !stays) return stays;
  }
  return overwrite ? core::Status{} : check_own_files(paths, loaded_.job.name);
}

core::Status JobFrames::check_not_lessened(const std::vector<int32_t>& frames) const {
  return cli::check_not_lessened(all_paths(frames),
                                 {loaded_.job.sampling.samples, options_.window.area()});
}

std::string JobFrames::below_folder(const std::string& path) const {
  const auto plain = [](const std::string& given) {
    return std::filesystem::absolute(given).lexically_normal();
  };
  return plain(path).lexically_relative(plain(options_.folder + "/")).string();
}

core::Status JobFrames::load_display() {
  if (const auto& color = loaded_.job.color) {
    // The job of a .blend lies in a folder of its own.
    const std::string file = loaded_.blend ? loaded_.blend->path() : loaded_.job.file;
    const auto folder = std::filesystem::path(file).parent_path();
    auto display = core::open_display_transform((folder / color->config).string(), *color);
    if (!display)
      return core::Error{core::Diagnostic{color->where, display.error().message}.to_string()};
    display_ = std::move(*display);
  }
  return {};
}

core::Status JobFrames::load_files() {
  if (auto display = load_display(); !display) return display;
  if (auto loaded = core::load_files(loaded_.job, std::nullopt, cache_); !loaded) {
    return loaded.error();
  }
  return {};
}

core::Result<std::vector<std::string>> JobFrames::load_first(int32_t frame) {
  auto scene = core::build_scene(loaded_.job, frame, cache_);
  if (!scene) return scene.error();
  first_frame_ = frame;
  first_scene_ = std::move(*scene);
  return first_scene_->warnings;
}

core::Result<double> JobFrames::seconds_per_sample(int32_t frame, int threads, double seconds) {
  auto scene = first_scene_ != nullptr && frame == first_frame_
                   ? core::Result<std::shared_ptr<const core::Scene>>(first_scene_)
                   : core::build_scene(loaded_.job, frame, cache_);
  if (!scene) return scene.error();
  const core::FrameRenderer renderer(*scene, loaded_.job, frame, layers_);
  return measure_sample_cost(renderer, options_.window, frame, threads, seconds, seconds).seconds;
}

core::Result<std::shared_ptr<const coordinator::FrameWork>> JobFrames::prepare(int32_t frame) {
  const auto first = std::exchange(first_scene_, nullptr);
  auto scene = first != nullptr && frame == first_frame_
                   ? core::Result<std::shared_ptr<const core::Scene>>(first)
                   : core::build_scene(loaded_.job, frame, cache_);
  if (!scene) return scene.error();
  return std::shared_ptr<const coordinator::FrameWork>(
      std::make_shared<Work>(*this, frame, *scene));
}

void JobFrames::note_darkness(int32_t frame, const core::Film& film) {
  // Of white: in eight bits six of 255.
  constexpr double kHardlyAnything = 0.002;
  const bool black = core::is_black(film);
  if (!black) {
    float exposure = 0.0F;
    for (const core::OutputDesc& output : loaded_.job.outputs) {
      exposure = std::max(exposure, output.exposure);
    }
    if (!core::is_dimmer_than(film, kHardlyAnything * std::exp2(-double{exposure}))) return;
  }
  const core::MutexLock lock(totals_mutex_);
  (black ? totals_.black : totals_.dim).push_back(frame);
}

core::Status JobFrames::finish(int32_t frame, const core::Film& film) {
  const core::FilmInfo info = film_info(frame);
  note_darkness(frame, film);
  if (auto written = write_pictures(info, film); !written) return written;
  if (!options_.write_films) return {};
  return core::write_film_exr(film_path(frame), {info, film});
}

core::Status JobFrames::check_picture(const core::FilmInfo& info) const {
  if (core::render_key(loaded_.job, info.frame, assets_) == info.render_key) return {};
  if (info.job_name != loaded_.job.name) {
    return core::Error{
        fmt::format("frame {}: its films are of another picture: of the job '{}', not of '{}'",
                    info.frame, core::printable(info.job_name), loaded_.job.name)};
  }
  core::Job other = loaded_.job;
  core::RenderClass& which = other.render.render_class;
  which =
      which == core::RenderClass::native ? core::RenderClass::portable : core::RenderClass::native;
  if (core::render_key(other, info.frame, assets_) == info.render_key) {
    const std::string& name = core::kRenderClassNames[static_cast<size_t>(which)];
    return core::Error{
        fmt::format("frame {}: its films were rendered in the class {}; --class {} takes them",
                    info.frame, name, name)};
  }
  return core::Error{fmt::format(
      "frame {}: its films are of another picture: what decides the pixels of {} is not what it "
      "was (or another version of Hyades rendered them)",
      info.frame, loaded_.job.file)};
}

core::Status JobFrames::write_outputs_of(const core::FilmFile& file) {
  const int32_t frame = file.info.frame;
  if (auto ours = check_picture(file.info); !ours) return ours;
  if (auto written = write_pictures(file.info, file.film); !written) return written;
  if (!options_.write_films) return {};
  return core::write_film_exr(film_path(frame), file);
}

/// The job's outputs, and the folders that they and the film lie in.
core::Status JobFrames::write_pictures(const core::FilmInfo& info, const core::Film& film) {
  if (options_.write_films) {
    const auto folder = std::filesystem::path(film_path(info.frame)).parent_path();
    std::error_code failed;
    if (!folder.empty()) std::filesystem::create_directories(folder, failed);
    if (failed) return core::Error{folder.string() + ": cannot be made: " + failed.message()};
  }
  if (options_.only_films) return {};
  const auto written =
      core::write_outputs(loaded_.job.outputs, options_.folder, info, film, display_.get());
  if (!written) return written.error();
  return {};
}

bool JobFrames::outputs_exist(int32_t frame) {
  if (!options_.trust_outputs) return false;
  const std::vector<std::string> paths = output_paths(frame);
  return std::all_of(paths.begin(), paths.end(),
                     [](const std::string& p) { return std::filesystem::exists(p); });
}

std::vector<std::string> JobFrames::output_paths(int32_t frame, bool for_videos) const {
  const auto& videos = loaded_.job.videos;
  std::vector<std::string> paths;
  for (const core::OutputDesc& output : loaded_.job.outputs) {
    const bool for_video = std::any_of(videos.begin(), videos.end(), [&](const auto& video) {
      return video.pictures == output.file;
    });
    if (options_.only_films || (for_video && !for_videos)) continue;
    paths.push_back(core::output_path(output, options_.folder, frame));
  }
  if (options_.write_films) paths.push_back(film_path(frame));
  return paths;
}

std::vector<std::filesystem::path> JobFrames::video_paths() const {
  std::vector<std::filesystem::path> paths;
  for (const core::VideoDesc& video : loaded_.job.videos) {
    paths.push_back(std::filesystem::path(options_.folder) / video.file);
  }
  return paths;
}

void JobFrames::remove_leftovers(const std::vector<int32_t>& frames,
                                 std::filesystem::file_time_type before) const {
  // By folder: the leftovers in it, of any target. Mostly none, and then a long range of frames is
  // walked for its folders only, if these bear frame numbers.
  std::map<std::filesystem::path, std::vector<core::Leftover>> leftovers;
  bool any = false;
  const auto look_into = [&](const std::filesystem::path& folder) {
    const auto [entry, fresh] = leftovers.try_emplace(folder);
    if (fresh) entry->second = core::find_leftovers(folder.string(), before);
    any = any || !entry->second.empty();
  };
  const auto& outputs = loaded_.job.outputs;
  const bool numbered_folders = std::any_of(outputs.begin(), outputs.end(), [](const auto& o) {
    return std::filesystem::path(o.file).parent_path().string().find('#') != std::string::npos;
  });
  for (size_t i = 0; i < (numbered_folders ? frames.size() : std::min<size_t>(frames.size(), 1));
       ++i) {
    for (const std::string& path : output_paths(frames[i])) {
      look_into(std::filesystem::path(path).parent_path());
    }
  }
  const auto videos = video_paths();
  for (const std::filesystem::path& video : videos) look_into(video.parent_path());
  if (!any) return;
  const auto remove_those_of = [&](const std::filesystem::path& target) {
    const std::string name = target.filename().string().substr(0, core::kNameInTemporary);
    for (const core::Leftover& leftover : leftovers[target.parent_path()]) {
      std::error_code ignored;
      if (leftover.target == name) std::filesystem::remove(leftover.path, ignored);
    }
  };
  for (const int32_t frame : frames) {
    for (const std::string& path : output_paths(frame)) remove_those_of(path);
  }
  for (const std::filesystem::path& video : videos) remove_those_of(video);
}

std::string JobFrames::film_path(int32_t frame) const {
  if (!options_.film_file.empty()) return core::output_path(options_.film_file, frame);
  core::OutputDesc film;
  film.file = core::film_file(loaded_.job);
  return core::output_path(film, options_.folder, frame);
}

core::FilmInfo JobFrames::film_info(int32_t frame) const {
  core::FilmInfo info = core::film_info(loaded_.job, frame, assets_);
  info.worker_class = class_for(loaded_.job);
  return info;
}

coordinator::FrameKey JobFrames::frame_key(int32_t frame) {
  const core::MutexLock lock(keys_mutex_);
  if (const auto known = keys_.find(frame); known != keys_.end()) return known->second;
  const coordinator::FrameKey key =
      // Another machine (or build) may give other bits: its films are not continued here.
      core::sha256(fmt::format("{} {} {}", class_for(loaded_.job),
                               core::render_key(loaded_.job, frame, assets_),
                               core::layers_text(layers_)));
  if (keys_.size() >= kKeysKept) keys_.erase(keys_.begin());
  keys_.emplace(frame, key);
  return key;
}

void JobFrames::note(int32_t frame, const core::RenderCounters& counters) {
  const core::MutexLock lock(totals_mutex_);
  totals_.counters.add(counters);
  for (const core::BadSample& bad : counters.examples) {
    if (totals_.bad.size() < kBadExamples) totals_.bad.push_back({frame, bad});
  }
}

RunTotals JobFrames::totals() const {
  const core::MutexLock lock(totals_mutex_);
  return totals_;
}

}  // namespace hyades::cli
