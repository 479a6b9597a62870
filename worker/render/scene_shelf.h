#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "core/base/descriptor.h"
#include "core/base/mutex.h"
#include "core/base/result.h"
#include "core/film/layout.h"
#include "core/job/job.h"
#include "core/render/frame_renderer.h"
#include "core/scene/scene_cache.h"
#include "farm/content_store.h"
#include "farm/manifest_resolver.h"
#include "hyades/v1/common.pb.h"

namespace hyades::worker {

/// A frame of a job, ready to be rendered.
struct ShelvedFrame {
  core::FrameRenderer renderer;
  core::PixelRect window;  ///< the pixels that the job renders
  uint32_t samples = 0;    ///< per pixel
  std::string document;    ///< the job's document, for messages
};

/// For the texels that a quarter of the memory does not hold: an empty file, open to read and
/// write, and how long it may get. Where it is none, there is no room but the memory.
struct TexelFile {
  core::Descriptor file;
  uint64_t most = 0;  ///< bytes
};

/// Jobs and the scenes of their frames, in memory within a budget. Frames of a job share their
/// geometry and images. Files come out of the content store through the job's manifest, and from
/// nowhere else.
class SceneShelf {
 public:
  /// `memory` in bytes, of the whole process: what was not used for longest goes when more is in
  /// use than that; 0: no limit.
  SceneShelf(farm::ContentStore& store, uint64_t memory, TexelFile texels)
      : store_(store), memory_(memory), texels_(make_texel_store(memory, std::move(texels))) {}

  void add_job(uint64_t job, hyades::v1::JobSpec spec) HYADES_EXCLUDES(mutex_);
  void forget_job(uint64_t job) HYADES_EXCLUDES(mutex_);

  /// The names of files that were found damaged since the last call.
  std::set<std::string> take_damaged() { return store_.take_damaged(); }

  /// The frame, if it is loaded.
  std::shared_ptr<const ShelvedFrame> find(uint64_t job, int32_t frame) HYADES_EXCLUDES(mutex_);

  /// Loads a frame, and its job before its first frame. One thread at a time. Errors: what is wrong
  /// with the job, or why the scene cannot be built.
  core::Result<std::shared_ptr<const ShelvedFrame>> load(uint64_t job, int32_t frame)
      HYADES_EXCLUDES(mutex_);

 private:
  struct LoadedFrame {
    std::shared_ptr<const ShelvedFrame> frame;
    uint64_t used = 0;  ///< when, in uses of the shelf
  };
  struct LoadedJob {
    core::Job job;
    core::LayerSet layers;
    std::unique_ptr<farm::ManifestResolver> files;
    std::unique_ptr<core::SceneCache> cache;
  };
  struct ShelvedJob {
    hyades::v1::JobSpec spec;
    std::shared_ptr<LoadedJob> loaded;  ///< the loading thread's
    std::map<int32_t, LoadedFrame> frames;
    uint64_t used = 0;
  };

  static std::shared_ptr<core::TexelStore> make_texel_store(uint64_t memory, TexelFile texels);
  core::Result<std::shared_ptr<LoadedJob>> read(const hyades::v1::JobSpec& spec) const;
  bool drop_one_locked(uint64_t but_job, size_t frames_kept) HYADES_REQUIRES(mutex_);
  void make_room(uint64_t job) HYADES_EXCLUDES(mutex_);

  farm::ContentStore& store_;
  const uint64_t memory_;
  const std::shared_ptr<core::TexelStore> texels_;  ///< of all jobs together
  core::Mutex mutex_;
  std::map<uint64_t, ShelvedJob> jobs_ HYADES_GUARDED_BY(mutex_);
  uint64_t uses_ HYADES_GUARDED_BY(mutex_) = 0;
};

}  // namespace hyades::worker
