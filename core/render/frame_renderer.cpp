#include "core/render/frame_renderer.h"

#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/base/fp_mode.h"
#include "core/render/chain_batch.h"
#include "core/samplers/sample_key.h"

namespace hyades::core {
namespace {

constexpr size_t kBadExamples = 8;
constexpr int kMaxDeposited = 16;
/// Keeps the numbers that place splats apart from those of samplers.
constexpr uint64_t kSplatNumbers = uint64_t{0x53504C41} << 32U;

FilterShape filter_shape(FilterKind kind) {
  switch (kind) {
    case FilterKind::box:
      return FilterShape::box;
    case FilterKind::triangle:
      return FilterShape::triangle;
    case FilterKind::gaussian:
      return FilterShape::gaussian;
    case FilterKind::mitchell:
      return FilterShape::mitchell;
    case FilterKind::blackman_harris:
      return FilterShape::blackman_harris;
    case FilterKind::center:
      return FilterShape::center;
  }
  return FilterShape::box;
}

bool is_usable(const Vec3& v) {
  // Every comparison is false for NaN.
  return std::abs(v.x) <= kMaxSample && std::abs(v.y) <= kMaxSample && std::abs(v.z) <= kMaxSample;
}

bool is_usable(const PixelSample& s) {
  return is_usable(s.radiance) && is_usable(s.albedo) && is_usable(s.normal);
}

bool is_finite(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace

std::optional<std::string> why_not_counted(const PixelSample& sample) {
  const std::pair<const char*, Vec3> values[] = {
      {"radiance", sample.radiance}, {"albedo", sample.albedo}, {"normal", sample.normal}};
  for (const auto& [name, value] : values) {
    if (is_usable(value)) continue;
    return is_finite(value) ? fmt::format("its {} is beyond {:.3g}", name, kMaxSample)
                            : fmt::format("its {} is not finite", name);
  }
  return std::nullopt;
}

std::string bad_sample_words() { return fmt::format("not finite or beyond {:.3g}", kMaxSample); }

void RenderCounters::add(const RenderCounters& other) {
  samples += other.samples;
  rays += other.rays;
  bounces += other.bounces;
  bad_samples += other.bad_samples;
  for (const BadSample& bad : other.examples) {
    if (examples.size() < kBadExamples) examples.push_back(bad);
  }
}

FrameRenderer::FrameRenderer(std::shared_ptr<const Scene> scene, const Job& job, int32_t frame,
                             const LayerSet& layers)
    : FrameRenderer(std::move(scene), job, frame, layers, make_integrator(job.integrator)) {
  if (job.integrator.type == "mlt" && job.integrator.max_depth > 0)
    metropolis_ = std::make_unique<Metropolis>(job.integrator);
}

FrameRenderer::FrameRenderer(std::shared_ptr<const Scene> scene, const Job& job, int32_t frame,
                             const LayerSet& layers, std::unique_ptr<Integrator> integrator)
    : scene_(std::move(scene)),
      integrator_(std::move(integrator)),
      filter_(make_pixel_filter(filter_shape(job.film.filter), job.film.filter_radius)),
      layout_(make_film_layout(layers)),
      sampling_(job.sampling),
      frame_(static_cast<uint32_t>(frame)),
      needs_time_(job.frames.shutter > 0.0F) {
  chain_film_ = {job.film.filter_radius, needs_time_};
  if (layers.splats) placer_.emplace(*filter_, job.film.filter_radius, scene_->window);
}

PixelSample FrameRenderer::sample_pixel(const Vec2i& pixel, uint32_t sample, Sampler& sampler,
                                        Workspace& work) const {
  sampler.start({sampling_.seed, frame_, pixel, sample});
  const FilterSample place = filter_->sample(sampler.next_2d());
  const Vec2 lens = sampler.next_2d();
  const float time = needs_time_ ? sampler.next_1d() : 0.0F;
  const Vec2 film = Vec2(pixel) + Vec2(0.5F) + place.offset;
  PixelSample out =
      integrator_->sample(*scene_, scene_->camera->generate(film, lens, time), sampler, work);
  out.radiance *= place.weight;
  out.alpha *= place.weight;
  out.albedo *= place.weight;
  out.normal *= place.weight;
  return out;
}

uint64_t FrameRenderer::splat_random(const Vec2i& pixel, uint32_t sample, size_t index) const {
  // Not of the sampler: a path may use any number of its dimensions.
  const uint64_t key = pixel_key({sampling_.seed, frame_, pixel, sample});
  return hash_combine(hash_combine(key, kSplatNumbers + sample), index);
}

void FrameRenderer::take_splats(const Vec2i& pixel, uint32_t sample, Workspace& work,
                                std::vector<PixelSplat>& into, RenderCounters& counters) const {
  for (size_t i = 0; placer_ && i < work.splats.size(); ++i) {
    const Splat& splat = work.splats[i];
    const bool somewhere = std::isfinite(splat.film.x) && std::isfinite(splat.film.y);
    const auto placed = placer_->place(splat, splat_random(pixel, sample, i));
    if (somewhere && !placed) continue;
    if (somewhere && add_splat(*placed, into)) continue;
    ++counters.bad_samples;
    if (counters.examples.size() < kBadExamples) counters.examples.push_back({pixel, sample});
  }
  work.splats.clear();
}

bool FrameRenderer::render_batch(const Unit& unit, uint32_t batch, Sampler& sampler,
                                 Workspace& work, BatchSums& sums, RenderCounters& counters,
                                 const std::atomic<bool>* stop,
                                 std::atomic<uint64_t>* samples_done) const {
  const uint32_t first = batch * kBatchSamples;
  const uint32_t count = samples_in_batch(batch, sampling_.samples);
  float* out = sums.values.data();
  sums.splats.clear();
  for (int y = unit.tile.y0; y < unit.tile.y1; ++y) {
    for (int x = unit.tile.x0; x < unit.tile.x1; ++x) {
      std::array<double, kMaxDeposited> sum{};
      float depth = kInfinity;
      for (uint32_t s = first; s < first + count; ++s) {
        // A path may take tens of milliseconds, so a pixel is too long to wait for.
        if (stop != nullptr && stop->load(std::memory_order_relaxed)) return false;
        const PixelSample sample = sample_pixel({x, y}, s, sampler, work);
        if (!is_usable(sample)) {
          ++counters.bad_samples;
          if (counters.examples.size() < kBadExamples) counters.examples.push_back({{x, y}, s});
          work.splats.clear();
          continue;
        }
        if (!work.splats.empty()) take_splats({x, y}, s, work, sums.splats, counters);
        for (int c = 0; c < 3; ++c) sum[static_cast<size_t>(c)] += double{sample.radiance[c]};
        sum[3] += double{sample.alpha};
        depth = sample.depth < depth ? sample.depth : depth;
        if (layout_.albedo >= 0) {
          for (int c = 0; c < 3; ++c)
            sum[static_cast<size_t>(layout_.albedo + c)] += double{sample.albedo[c]};
        }
        if (layout_.normal >= 0) {
          for (int c = 0; c < 3; ++c)
            sum[static_cast<size_t>(layout_.normal + c)] += double{sample.normal[c]};
        }
      }
      if (samples_done != nullptr) samples_done->fetch_add(count, std::memory_order_relaxed);
      for (int c = 0; c < layout_.deposited; ++c) {
        *out++ = c == layout_.depth ? depth : static_cast<float>(sum[static_cast<size_t>(c)]);
      }
    }
  }
  counters.samples += uint64_t{count} * static_cast<uint64_t>(unit.tile.area());
  return true;
}

bool FrameRenderer::run_chains(const Unit& unit, uint32_t batch, Workspace& work, BatchSums& sums,
                               RenderCounters& counters, const std::atomic<bool>* stop,
                               std::atomic<uint64_t>* samples_done) const {
  if (!metropolis_ || !placer_) return true;
  ChainName name;
  name.seed = sampling_.seed;
  name.frame = frame_;
  name.batch = batch;
  name.samples = samples_in_batch(batch, sampling_.samples);
  return ChainBatch(*metropolis_, *scene_, chain_film_, *placer_)
      .run(name, unit.tile, work, sums.splats, counters, {stop, samples_done});
}

RenderedUnit FrameRenderer::render(const Unit& unit, const std::atomic<bool>* stop,
                                   std::atomic<uint32_t>* batches_done,
                                   std::atomic<uint64_t>* samples_done) const {
  const FpMode fp_mode;
  RenderedUnit result{Film(layout_, unit.tile, scene_->window), {}, false};
  const auto sampler = make_sampler(
      sampling_.sampler == SamplerName::sobol ? SamplerKind::sobol : SamplerKind::independent);
  Workspace work;
  Workspace chain_work;
  BatchSums sums;
  sums.values.resize(static_cast<size_t>(unit.tile.area()) *
                     static_cast<size_t>(layout_.deposited));
  for (uint32_t b = unit.batches.first; b < unit.batches.end(); ++b) {
    if (!render_batch(unit, b, *sampler, work, sums, result.counters, stop,
                      metropolis_ ? nullptr : samples_done) ||
        !run_chains(unit, b, chain_work, sums, result.counters, stop, samples_done)) {
      result.stopped = true;
      break;
    }
    result.film.deposit(unit.tile, b, samples_in_batch(b, sampling_.samples), sums.values);
    if (layout_.layers.splats) result.film.deposit_splats(sums.splats);
    if (batches_done != nullptr) batches_done->fetch_add(1, std::memory_order_relaxed);
  }
  result.counters.rays = work.rays + chain_work.rays;
  result.counters.bounces = work.bounces + chain_work.bounces;
  return result;
}

PixelSample FrameRenderer::replay(const Vec2i& pixel, uint32_t sample, PathLog& log) const {
  const FpMode fp_mode;
  const auto sampler = make_sampler(
      sampling_.sampler == SamplerName::sobol ? SamplerKind::sobol : SamplerKind::independent);
  Workspace work;
  work.log = &log;
  const PixelSample result = sample_pixel(pixel, sample, *sampler, work);
  for (size_t i = 0; placer_ && i < work.splats.size(); ++i) {
    const Splat& splat = work.splats[i];
    const auto placed = placer_->place(splat, splat_random(pixel, sample, i));
    std::string line = fmt::format("splat {} at {:.3f}, {:.3f}: ", i, splat.film.x, splat.film.y);
    if (!std::isfinite(splat.film.x) || !std::isfinite(splat.film.y)) {
      line += "it is not counted";
    } else if (!placed) {
      line += "outside of what is rendered";
    } else {
      const auto& [r, g, b] = placed->value;
      const PixelRect& region = scene_->window;
      const auto width = static_cast<uint32_t>(region.width());
      line += fmt::format("{:.4g} {:.4g} {:.4g} for pixel {}, {}{}", r, g, b,
                          region.x0 + static_cast<int>(placed->pixel % width),
                          region.y0 + static_cast<int>(placed->pixel / width),
                          counts(*placed) ? "" : ", which is not counted");
    }
    log.lines.push_back(std::move(line));
  }
  return result;
}

}  // namespace hyades::core
