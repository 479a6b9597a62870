#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/load_job.h"
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
  uint32_t samples = 0;
  uint64_t film_memory = 0;  ///< bytes; 0: what the machine is good for
  uint64_t texture_memory = core::TexelStore::default_budget();  ///< bytes
  std::vector<int> crop;
  std::string display;  ///< HOST:PORT of a viewer; empty: none
  int preview = 0;      ///< width in pixels; 0: the job as it is
  bool resume = false;
  bool quiet = false;
  bool film = false;
};

/// Exit status other than 0 where the arguments end the command.
std::optional<int> parse_render_options(int argc, char** argv, RenderOptions& options);

/// The job as the command line changes it; nothing (and a message) where that makes no sense.
std::optional<LoadedJob> load_for_render(const RenderOptions& options);

/// What is rendered of each frame. --crop is no part of the job: films of several crops belong to
/// one picture, and 'hyades merge' joins them.
core::PixelRect window_of(const RenderOptions& options, const core::Job& job);

}  // namespace hyades::cli
