#include "core/render/render_frame.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <thread>
#include <vector>

#include "core/base/hash.h"
#include "core/base/mutex.h"

namespace hyades::core {
namespace {

std::vector<Unit> plan(const PixelRect& window, uint32_t samples, int32_t frame,
                       const RenderFrameOptions& options) {
  std::vector<Unit> units;
  const uint32_t batches = batch_count(samples);
  for (uint32_t first = 0; first < batches; first += options.batches_per_unit) {
    const BatchRange range{first, std::min(options.batches_per_unit, batches - first)};
    for (int y = window.y0; y < window.y1; y += options.tile_size) {
      for (int x = window.x0; x < window.x1; x += options.tile_size) {
        units.push_back({frame,
                         intersection(window, {x, y, x + options.tile_size, y + options.tile_size}),
                         range});
      }
    }
  }
  if (options.shuffle) {
    std::sort(units.begin(), units.end(), [](const Unit& a, const Unit& b) {
      const auto key = [](const Unit& u) {
        return hash_combine(
            hash_combine(static_cast<uint64_t>(u.tile.x0), static_cast<uint64_t>(u.tile.y0)),
            u.batches.first);
      };
      return key(a) < key(b);
    });
  }
  return units;
}

}  // namespace

RenderedFrame render_frame(const FrameRenderer& renderer, const PixelRect& window, uint32_t samples,
                           int32_t frame, const RenderFrameOptions& options) {
  const std::vector<Unit> units = plan(window, samples, frame, options);
  RenderedFrame result{Film(renderer.layout(), window), {}};
  Mutex mutex;
  size_t done = 0;
  std::atomic<size_t> next{0};
  const auto work = [&] {
    for (size_t i = next++; i < units.size(); i = next++) {
      const RenderedUnit unit = renderer.render(units[i]);
      const MutexLock lock(mutex);
      // Units of one plan cannot overlap, so a refusal would be a bug in plan() itself.
      if (!result.film.merge(unit.film)) std::abort();
      result.counters.add(unit.counters);
      ++done;
      if (options.progress) {
        options.progress(static_cast<double>(done) / static_cast<double>(units.size()));
      }
    }
  };
  std::vector<std::thread> threads;
  for (int i = 1; i < options.threads; ++i) threads.emplace_back(work);
  work();
  for (std::thread& thread : threads) thread.join();
  return result;
}

}  // namespace hyades::core
