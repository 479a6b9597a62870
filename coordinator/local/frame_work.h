#pragma once

#include <atomic>
#include <cstdint>
#include <memory>

#include "core/base/result.h"
#include "core/film/film.h"
#include "core/film/unit.h"

namespace hyades::coordinator {

/// One frame, ready to be rendered. The room below this knows no light: whoever owns the renderer
/// implements it.
class FrameWork {
 public:
  virtual ~FrameWork() = default;

  /// The film of exactly this unit: window = its tile, coverage = its batches. A pure function of
  /// the unit, called by many threads at once. When `stop` becomes true it returns soon (within a
  /// sample) with anything; an error otherwise is the unit's fault and counts as a failed
  /// attempt.
  virtual core::Result<core::Film> render(const core::Unit& unit,
                                          const std::atomic<bool>& stop) const = 0;
};

/// Where frames come from.
class FrameSource {
 public:
  virtual ~FrameSource() = default;

  /// Loads the frame's scene. Called by one thread, for one frame after the other, while others
  /// render.
  virtual core::Result<std::shared_ptr<const FrameWork>> prepare(int32_t frame) = 0;
};

/// Where frames go to.
class FrameSink {
 public:
  virtual ~FrameSink() = default;

  /// Writes the outputs of a complete frame, atomically and durably. Called by one thread, for one
  /// frame after the other, while others render; after a resume also for frames that were never
  /// prepared. An error is tried again twice.
  virtual core::Status finish(int32_t frame, const core::Film& film) = 0;

  /// Whether the outputs of a frame are there that an earlier run finished; if not, it is rendered
  /// again. Called before anything else.
  virtual bool outputs_exist(int32_t frame) = 0;
};

/// Who looks at films while they grow. Both functions are called by threads that others wait for:
/// they return soon, and keep nothing of the film.
class FilmAudience {
 public:
  virtual ~FilmAudience() = default;

  /// A unit of `tile` has been merged into the frame's film. What an earlier run left in a film is
  /// in it at the first call.
  virtual void grown(int32_t frame, const core::Film& film, const core::PixelRect& tile) = 0;

  /// Nothing more comes to the frame's film. Called again where its outputs could not be written
  /// at first.
  virtual void complete(int32_t frame, const core::Film& film) = 0;
};

}  // namespace hyades::coordinator
