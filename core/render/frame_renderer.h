#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/film/film.h"
#include "core/film/fixed128.h"
#include "core/integrators/integrator.h"
#include "core/job/job.h"
#include "core/render/splat_placer.h"
#include "core/samplers/filter.h"
#include "core/scene/scene.h"

namespace hyades::core {

/// The largest magnitude of a sample's radiance (times its filter weight), albedo and normal that
/// counts, about 3.4e10: sums of batches stay well within what a film can hold.
inline constexpr float kMaxSample = kMaxDeposit / static_cast<float>(2 * kBatchSamples);

/// Why `sample` does not count, in words that fit behind "this sample is not counted: "; nothing
/// where it does.
std::optional<std::string> why_not_counted(const PixelSample& sample);

/// What is wrong with samples that do not count, in words that fit behind "they are ": "not finite
/// or beyond 3.44e+10".
std::string bad_sample_words();

/// A sample that does not count, for it is not finite or beyond kMaxSample: left out of the film
/// (as if it were black), reported so that it can be replayed.
struct BadSample {
  Vec2i pixel{0, 0};
  uint32_t sample = 0;
};

/// What rendering a unit took.
struct RenderCounters {
  uint64_t samples = 0;  ///< of whole batches, bad ones too
  uint64_t rays = 0;
  uint64_t bounces = 0;
  uint64_t bad_samples = 0;         ///< and single splats that do not count
  std::vector<BadSample> examples;  ///< the first few bad ones

  void add(const RenderCounters& other);
};

struct RenderedUnit {
  Film film;
  RenderCounters counters;
  bool stopped = false;  ///< the stop flag was seen: the film holds only the first whole batches
};

/// The front door of the renderer: a frame's scene and settings in, films out. render() is a pure
/// function of the unit (invariant 1), so any thread may call it in any order.
class FrameRenderer {
 public:
  FrameRenderer(std::shared_ptr<const Scene> scene, const Job& job, int32_t frame,
                const LayerSet& layers);
  /// The same with an integrator that no job names.
  FrameRenderer(std::shared_ptr<const Scene> scene, const Job& job, int32_t frame,
                const LayerSet& layers, std::unique_ptr<Integrator> integrator);

  /// Renders `unit` on the calling thread. `stop` is looked at before every sample;
  /// `batches_done` and `samples_done` (after every pixel of a batch) count along, for whoever
  /// watches.
  RenderedUnit render(const Unit& unit, const std::atomic<bool>* stop = nullptr,
                      std::atomic<uint32_t>* batches_done = nullptr,
                      std::atomic<uint64_t>* samples_done = nullptr) const;

  /// One sample of one pixel; `log` gets the path in words, and what it splats where.
  PixelSample replay(const Vec2i& pixel, uint32_t sample, PathLog& log) const;

  const Scene& scene() const { return *scene_; }
  const FilmLayout& layout() const { return layout_; }

 private:
  /// What a batch brings.
  struct BatchSums {
    std::vector<float> values;  ///< as Film::deposit takes them
    std::vector<PixelSplat> splats;
  };

  PixelSample sample_pixel(const Vec2i& pixel, uint32_t sample, Sampler& sampler,
                           Workspace& work) const;
  bool render_batch(const Unit& unit, uint32_t batch, Sampler& sampler, Workspace& work,
                    BatchSums& sums, RenderCounters& counters, const std::atomic<bool>* stop,
                    std::atomic<uint64_t>* samples_done) const;
  void take_splats(const Vec2i& pixel, uint32_t sample, Workspace& work,
                   std::vector<PixelSplat>& into, RenderCounters& counters) const;
  uint64_t splat_random(const Vec2i& pixel, uint32_t sample, size_t index) const;

  std::shared_ptr<const Scene> scene_;
  std::unique_ptr<Integrator> integrator_;
  std::unique_ptr<PixelFilter> filter_;
  std::optional<SplatPlacer> placer_;  ///< of films with splats
  FilmLayout layout_;
  SamplingDesc sampling_;
  uint32_t frame_ = 0;
  bool needs_time_ = false;
};

}  // namespace hyades::core
