#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <unordered_set>
#include <vector>

#include "core/film/film.h"
#include "core/integrators/integrator.h"
#include "core/integrators/light_parts.h"
#include "core/integrators/metropolis.h"
#include "core/job/job.h"
#include "core/render/pixel_sums.h"
#include "core/render/render_counters.h"
#include "core/render/splat_placer.h"
#include "core/samplers/filter.h"
#include "core/scene/scene.h"

namespace hyades::core {

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
  /// A renderer with an integrator that no job names.
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
    BatchSplats splats;
    std::array<std::vector<IdCount>, kIdKinds> ids;  ///< pixels are those of the tile
    std::unordered_set<uint32_t> objects;            ///< that ids are of
  };

  TakenSample sample_pixel(const Vec2i& pixel, uint32_t sample, Sampler& sampler,
                           Workspace& work) const;
  bool render_batch(const Unit& unit, uint32_t batch, Sampler& sampler, Workspace& work,
                    BatchSums& sums, RenderCounters& counters, const std::atomic<bool>* stop,
                    std::atomic<uint64_t>* samples_done) const;
  void take_splats(const Vec2i& pixel, uint32_t sample, Workspace& work, BatchSplats& into,
                   RenderCounters& counters) const;
  void count_ids(const TakenSample& sample, uint32_t pixel, BatchSums& sums) const;
  void deposit_ids(BatchSums& sums, Film& film) const;
  bool run_chains(const Unit& unit, uint32_t batch, Workspace& work, BatchSums& sums,
                  RenderCounters& counters, const std::atomic<bool>* stop,
                  std::atomic<uint64_t>* samples_done) const;
  uint64_t splat_random(const Vec2i& pixel, uint32_t sample, size_t index) const;

  std::shared_ptr<const Scene> scene_;
  std::unique_ptr<Integrator> integrator_;
  std::unique_ptr<Metropolis> metropolis_;  ///< of mlt
  ChainFilm chain_film_;
  std::unique_ptr<PixelFilter> filter_;
  std::optional<SplatPlacer> placer_;  ///< of films with splats
  FilmLayout layout_;
  PartTable part_table_;
  SamplingDesc sampling_;
  uint32_t frame_ = 0;
  bool needs_time_ = false;
};

}  // namespace hyades::core
