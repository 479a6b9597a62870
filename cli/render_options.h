#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/film_size_option.h"
#include "cli/load_job.h"
#include "cli/part.h"
#include "core/base/parallel.h"
#include "core/base/rect.h"
#include "core/textures/texel_store.h"

namespace hyades::cli {

/// What the command line of `hyades render` says.
struct RenderOptions {
  std::string path;
  std::string frames;
  std::string folder = ".";
  SceneOptions scene;
  int threads = core::hardware_threads();
  SamplesOption samples;
  double time = 0;  ///< seconds that all frames shall take; 0: as long as their samples take
  std::optional<TileOption> tile;
  uint64_t film_memory = 0;  ///< bytes; 0: what the machine is good for
  uint64_t texture_memory = core::TexelStore::default_budget();  ///< bytes
  FilmSizeOption size;
  std::vector<int> crop;
  std::string display;     ///< HOST:PORT of a viewer; empty: none
  int preview = 0;         ///< width in pixels; 0: the job as it is
  bool resume = false;     ///< only with what an earlier run has kept of this very picture
  bool restart = false;    ///< without what an earlier run has kept
  bool overwrite = false;  ///< also files that the job has not made
  bool keep_work = true;   ///< films are kept until all is written, for a run that is interrupted
  bool quiet = false;
  bool json = false;  ///< tell programs of progress and files
  bool film = false;
  std::string film_file;  ///< where films go, #### for the frame; empty: the usual name

  /// Whether only films are written, for others render the rest.
  bool is_part() const { return tile.has_value() || samples.range.has_value(); }
};

/// Exit status other than 0 where the arguments end the command.
std::optional<int> parse_render_options(int argc, char** argv, RenderOptions& options);

/// The job as the command line changes it; nothing (and a message) where that makes no sense.
std::optional<LoadedJob> load_for_render(const RenderOptions& options);

/// What is rendered of each frame. --crop and --tile are no part of the job: films of several of
/// them belong to one picture, and 'hyades merge' joins them. For jobs of load_for_render().
core::PixelRect window_of(const RenderOptions& options, const core::Job& job);

/// Which batches are rendered; none: all of them.
core::BatchRange batches_of(const RenderOptions& options, const core::Job& job);

/// Where the films of a part go when nobody says so: "NAME.####.tile-2-of-3.samples-0-31.film.exr".
/// Empty where it is no part.
std::string film_file_of(const RenderOptions& options, const core::Job& job);

/// The name below .hyades of the run's kept films: the job's; of a part one of its own, for others
/// may be rendered beside it into the same folder.
std::string kept_name(const RenderOptions& options, const core::Job& job);

}  // namespace hyades::cli
