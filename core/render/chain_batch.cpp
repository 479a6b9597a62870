#include "core/render/chain_batch.h"

#include <algorithm>
#include <cstddef>
#include <span>

#include "core/base/hash.h"

namespace hyades::core {
namespace {

constexpr uint64_t kPlaces = 0x706C'6163'6573ULL;  ///< "places": numbers that the chain has not

/// The shares of `region` whose first pixel lies in `tile`.
std::vector<PixelRect> shares_of(const PixelRect& tile, const PixelRect& region) {
  std::vector<PixelRect> shares;
  const auto down = [](int x) { return x / kChainShare * kChainShare; };
  for (int y = down(tile.y0); y < tile.y1; y += kChainShare) {
    for (int x = down(tile.x0); x < tile.x1; x += kChainShare) {
      const PixelRect share = intersection(region, {x, y, x + kChainShare, y + kChainShare});
      if (tile.contains({share.x0, share.y0, share.x0 + 1, share.y0 + 1})) shares.push_back(share);
    }
  }
  return shares;
}

class Collector final : public ChainSink {
 public:
  Collector(const SplatPlacer& placer, const ChainName& name, BatchSplats& splats,
            RenderCounters& counters, const ChainBatch::Watch& watch, uint64_t samples)
      : placer_(placer), splats_(splats), counters_(counters), watch_(watch), samples_(samples) {
    key_ = hash_combine(hash_combine(name.seed, name.frame), kPlaces);
    key_ = hash_combine(hash_combine(key_, static_cast<uint64_t>(name.share.x0)),
                        static_cast<uint64_t>(name.share.y0));
    key_ = hash_combine(key_, name.batch);
  }

  void deposit(const Splat& splat, std::span<const SplatPart> parts) override {
    if (!placer_.add(splat, parts, hash_combine(key_, index_++), splats_)) ++counters_.bad_samples;
  }

  bool goes_on(double done) override {
    told(static_cast<uint64_t>(done * static_cast<double>(samples_)));
    return watch_.stop == nullptr || !watch_.stop->load(std::memory_order_relaxed);
  }

  /// So many of its samples are done.
  void told(uint64_t samples) {
    if (watch_.samples_done != nullptr && samples > told_)
      watch_.samples_done->fetch_add(samples - told_, std::memory_order_relaxed);
    told_ = std::max(told_, samples);
  }

 private:
  const SplatPlacer& placer_;
  BatchSplats& splats_;
  RenderCounters& counters_;
  const ChainBatch::Watch& watch_;
  uint64_t samples_;  ///< of the tile's batch, that this chain stands for
  uint64_t told_ = 0;
  uint64_t key_ = 0;
  uint64_t index_ = 0;
};

}  // namespace

uint64_t pixels_of_chains(const PixelRect& crop, const PixelRect& region) {
  uint64_t pixels = 0;
  for (const PixelRect& share : shares_of(crop, region))
    pixels += static_cast<uint64_t>(share.area());
  return pixels;
}

bool ChainBatch::run(ChainName name, const PixelRect& tile, Workspace& work, BatchSplats& splats,
                     RenderCounters& counters, const Watch& watch) const {
  const std::vector<PixelRect> shares = shares_of(tile, scene_.window);
  const uint64_t samples = static_cast<uint64_t>(tile.area()) * name.samples;
  for (size_t i = 0; i < shares.size(); ++i) {
    name.share = shares[i];
    const uint64_t begin = samples * i / shares.size();
    const uint64_t end = samples * (i + 1) / shares.size();
    Collector collector(placer_, name, splats, counters, watch, end - begin);
    if (!metropolis_.run(scene_, film_, name, work, collector)) return false;
    collector.told(end - begin);
  }
  if (shares.empty() && watch.samples_done != nullptr)
    watch.samples_done->fetch_add(samples, std::memory_order_relaxed);
  return true;
}

}  // namespace hyades::core
