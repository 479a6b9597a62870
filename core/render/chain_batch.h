#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "core/integrators/metropolis.h"
#include "core/render/render_counters.h"
#include "core/render/splat_placer.h"

namespace hyades::core {

/// The share of the film whose mutations one chain makes: a square of pixels of the full frame's
/// grid, however tiles are cut.
inline constexpr int kChainShare = 64;

/// How many pixels the chains of `crop`, a part of `region`, stand for: as many as it has where its
/// edges are multiples of kChainShare or the region's. Elsewhere the crop alone is that many times
/// as bright, over its pixels, until it is merged with what is beside it.
uint64_t pixels_of_chains(const PixelRect& crop, const PixelRect& region);

/// The Markov chains of one batch of a tile: those whose share of the region has its first pixel in
/// the tile. A tile whose sides are multiples of kChainShare has all of its own chains.
class ChainBatch {
 public:
  struct Watch {
    const std::atomic<bool>* stop = nullptr;
    std::atomic<uint64_t>* samples_done = nullptr;
  };

  /// All outlive the batch.
  ChainBatch(const Metropolis& metropolis, const Scene& scene, const ChainFilm& film,
             const SplatPlacer& placer)
      : metropolis_(metropolis), scene_(scene), film_(film), placer_(placer) {}

  /// Runs them. `name`: seed, frame, batch and samples; the share is filled in. Splats go to
  /// `splats`. False where it was stopped.
  bool run(ChainName name, const PixelRect& tile, Workspace& work, BatchSplats& splats,
           RenderCounters& counters, const Watch& watch) const;

 private:
  const Metropolis& metropolis_;
  const Scene& scene_;
  const ChainFilm& film_;
  const SplatPlacer& placer_;
};

}  // namespace hyades::core
