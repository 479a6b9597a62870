#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "cli/load_job.h"
#include "coordinator/film_store/film_records.h"
#include "coordinator/local/frame_work.h"
#include "core/base/mutex.h"
#include "core/film/film_exr.h"
#include "core/film/film_info.h"
#include "core/finish/display_transform.h"
#include "core/render/frame_renderer.h"
#include "core/scene/scene_cache.h"

namespace hyades::cli {

/// What rendering a run of frames has taken so far, and which samples went wrong.
struct RunTotals {
  core::RenderCounters counters;
  struct Bad {
    int32_t frame = 0;
    core::BadSample sample;
  };
  std::vector<Bad> bad;        ///< the first few
  std::vector<int32_t> black;  ///< frames that no light has reached
  std::vector<int32_t> dim;    ///< others in whose pictures hardly anything can be seen
};

/// The frames of a job for LocalRun: builds scenes, renders units, writes outputs.
class JobFrames : public coordinator::FrameSource, public coordinator::FrameSink {
 public:
  struct Options {
    std::string folder;        ///< where outputs go
    bool write_films = false;  ///< also NAME.####.film.exr
    std::string film_file;     ///< instead of that place, #### for the frame; empty: that one
    bool only_films = false;   ///< no outputs: what is rendered is a part
    core::PixelRect window;    ///< what is rendered of each frame
    bool trust_outputs =
        false;  ///< whether output files that are there were made with the job's settings
    uint64_t texture_memory = core::TexelStore::default_budget();  ///< bytes, for TexelStore
  };

  JobFrames(LoadedJob& loaded, Options options);

  /// An error where the frames' films and an output of the job would be the same file.
  core::Status check_film_names() const;

  /// An error where a link would lead outputs of `frames`, or videos of them, out of their folder;
  /// and, but for `overwrite`, where some are there that another job has made, or another program.
  core::Status check_outputs(const std::vector<int32_t>& frames, bool overwrite) const;

  /// An error where outputs of `frames` are there with more samples or pixels than would be made
  /// now.
  core::Status check_not_lessened(const std::vector<int32_t>& frames) const;

  /// Opens the colour configuration, which write_outputs() needs.
  core::Status load_display();

  /// Loads the files that all frames share, and the colour configuration. The error names every one
  /// that is broken.
  core::Status load_files();

  /// Loads the scene of the frame that will be asked for first, so that what is wrong with it is
  /// known before anything is written. prepare() gives it out. Returns its warnings.
  core::Result<std::vector<std::string>> load_first(int32_t frame);

  /// Seconds by the clock that a sample of the frame takes where `threads` threads render, measured
  /// for about `seconds`.
  core::Result<double> seconds_per_sample(int32_t frame, int threads, double seconds);

  core::Result<std::shared_ptr<const coordinator::FrameWork>> prepare(int32_t frame) override;
  core::Status finish(int32_t frame, const core::Film& film) override;
  bool outputs_exist(int32_t frame) override;

  /// Whether a film is one of this job as it stands here, whatever the job is called.
  core::Status check_picture(const core::FilmInfo& info) const;

  /// Writes the outputs (and the film) of a frame of a film that others may have rendered. An error
  /// where the film is not of this job as it is.
  core::Status write_outputs_of(const core::FilmFile& file);

  /// Everything that `frame` writes, in the job's order; with or without what is there for videos
  /// only.
  std::vector<std::string> output_paths(int32_t frame, bool for_videos = true) const;

  /// Names the pixels and layers of a frame: films of another key are never mixed in. Thread-safe.
  coordinator::FrameKey frame_key(int32_t frame);

  /// Removes what a killed process was writing before `before` of the outputs of `frames` and the
  /// videos.
  void remove_leftovers(const std::vector<int32_t>& frames,
                        std::filesystem::file_time_type before) const;

  /// What is rendered of each frame.
  const core::PixelRect& window() const { return options_.window; }

  RunTotals totals() const;

 private:
  class Work;
  std::vector<std::string> all_paths(const std::vector<int32_t>& frames) const;
  core::Status write_pictures(const core::FilmInfo& info, const core::Film& film);
  core::FilmInfo film_info(int32_t frame) const;
  /// `path` as seen from the outputs' folder: it begins with ".." where it lies elsewhere.
  std::string below_folder(const std::string& path) const;
  std::string film_path(int32_t frame) const;
  std::vector<std::filesystem::path> video_paths() const;
  void note(int32_t frame, const core::RenderCounters& counters);
  void note_darkness(int32_t frame, const core::Film& film);

  LoadedJob& loaded_;
  Options options_;
  core::LayerSet layers_;
  const std::vector<core::AssetRecord>
      assets_;  ///< all files of the job, as they were when it was read
  core::SceneCache cache_;
  std::shared_ptr<const core::DisplayTransform> display_;  ///< of job.color, once files are loaded
  int32_t first_frame_ = 0;
  /// Of first_frame_, until a frame is prepared: from then on only the thread that prepares has it.
  std::shared_ptr<const core::Scene> first_scene_;
  core::Mutex keys_mutex_;
  std::map<int32_t, coordinator::FrameKey> keys_
      HYADES_GUARDED_BY(keys_mutex_);  ///< of some frames
  mutable core::Mutex totals_mutex_;
  RunTotals totals_ HYADES_GUARDED_BY(totals_mutex_);
};

}  // namespace hyades::cli
