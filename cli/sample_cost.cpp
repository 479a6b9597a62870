#include "cli/sample_cost.h"

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include "core/base/hash.h"
#include "core/base/machine.h"
#include "core/film/black.h"

namespace hyades::cli {

SampleCost measure_sample_cost(const core::FrameRenderer& renderer, const core::PixelRect& window,
                               int32_t frame, int threads, double seconds, double most) {
  using Clock = std::chrono::steady_clock;
  constexpr int kPatch = 4;
  const auto begin = Clock::now();
  const auto so_far = [begin] {
    return std::chrono::duration<double>(Clock::now() - begin).count();
  };
  std::atomic<uint64_t> patches{0}, samples{0};
  std::atomic<double> core_seconds{0};
  std::atomic<bool> lit{false};
  const auto measure = [&] {
    const double cpu_begin = core::thread_seconds();
    do {
      const uint64_t h = core::mix64(++patches);
      const int x = window.x0 + static_cast<int>(h % static_cast<uint64_t>(window.width()));
      const int y =
          window.y0 + static_cast<int>((h >> 32) % static_cast<uint64_t>(window.height()));
      const core::PixelRect patch = intersection(window, {x, y, x + kPatch, y + kPatch});
      const core::RenderedUnit unit = renderer.render({frame, patch, {0, 1}});
      samples += unit.counters.samples;
      if (!core::is_black(unit.film)) lit = true;
      // By its own processor time: where others use the machine too few patches would be tried.
    } while (core::thread_seconds() - cpu_begin < seconds && so_far() < most);
    core_seconds += core::thread_seconds() - cpu_begin;
  };
  std::vector<std::thread> others;
  for (int i = 1; i < threads; ++i) others.emplace_back(measure);
  measure();
  for (std::thread& other : others) other.join();
  const auto all = static_cast<double>(samples);
  return {core_seconds / all, so_far() / all, lit};
}

}  // namespace hyades::cli
