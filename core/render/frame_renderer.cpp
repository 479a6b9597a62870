#include "core/render/frame_renderer.h"

#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "core/base/fp_mode.h"
#include "core/render/chain_batch.h"
#include "core/samplers/sample_key.h"

namespace hyades::core {
namespace {

constexpr size_t kBadExamples = 8;
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

/// Where light of the scene goes that a film tells apart.
PartTable part_table(const FilmLayout& layout, const Scene& scene) {
  PartTable table;
  table.components = layout.component_parts;
  table.count = layout.part_count();
  table.rest = layout.group_part(kRestGroup);
  for (const std::string& group : scene.light_groups)
    table.lights.push_back(layout.group_part(group.empty() ? kRestGroup : group));
  for (const auto& [medium, group] : scene.medium_groups)
    table.media.emplace_back(medium, layout.group_part(group));
  return table;
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
      filter_(make_pixel_filter(filter_shape(job.film.filter.type), job.film.filter.radius)),
      layout_(make_film_layout(layers)),
      part_table_(part_table(layout_, *scene_)),
      sampling_(job.sampling),
      frame_(static_cast<uint32_t>(frame)),
      needs_time_(job.frames.shutter > 0.0F) {
  chain_film_ = {job.film.filter.radius, needs_time_};
  if (layers.splats) placer_.emplace(*filter_, job.film.filter.radius, scene_->window);
}

TakenSample FrameRenderer::sample_pixel(const Vec2i& pixel, uint32_t sample, Sampler& sampler,
                                        Workspace& work) const {
  sampler.start({sampling_.seed, frame_, pixel, sample});
  if (work.parts != nullptr) work.parts->clear();
  const FilterSample place = filter_->sample(sampler.next_2d());
  const Vec2 lens = sampler.next_2d();
  const float time = needs_time_ ? sampler.next_1d() : 0.0F;
  const Vec2 film = Vec2(pixel) + Vec2(0.5F) + place.offset;
  TakenSample taken{{}, place.weight, time, scene_->camera->generate(film, lens, time)};
  PixelSample& out = taken.seen;
  out = integrator_->sample(*scene_, taken.ray, sampler, work);
  out.radiance *= place.weight;
  out.alpha *= place.weight;
  out.albedo *= place.weight;
  out.normal *= place.weight;
  return taken;
}

uint64_t FrameRenderer::splat_random(const Vec2i& pixel, uint32_t sample, size_t index) const {
  // Not of the sampler: a path may use any number of its dimensions.
  const uint64_t key = pixel_key({sampling_.seed, frame_, pixel, sample});
  return hash_combine(hash_combine(key, kSplatNumbers + sample), index);
}

void FrameRenderer::take_splats(const Vec2i& pixel, uint32_t sample, Workspace& work,
                                BatchSplats& into, RenderCounters& counters) const {
  std::span<const SplatPart> parts;
  if (work.parts != nullptr) parts = work.parts->splat_parts();
  for (size_t i = 0; placer_ && i < work.splats.size(); ++i) {
    const Splat& splat = work.splats[i];
    const bool somewhere = std::isfinite(splat.film.x) && std::isfinite(splat.film.y);
    if (somewhere && placer_->add(splat, parts.subspan(splat.first_part, splat.parts),
                                  splat_random(pixel, sample, i), into)) {
      continue;
    }
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
  for (std::vector<IdCount>& ids : sums.ids) ids.clear();
  sums.objects.clear();
  PixelSums pixel(layout_, *scene_);
  uint32_t index = 0;
  for (int y = unit.tile.y0; y < unit.tile.y1; ++y) {
    for (int x = unit.tile.x0; x < unit.tile.x1; ++x) {
      pixel.clear();
      for (uint32_t s = first; s < first + count; ++s) {
        // A path may take tens of milliseconds, so a pixel is too long to wait for.
        if (stop != nullptr && stop->load(std::memory_order_relaxed)) return false;
        const TakenSample sample = sample_pixel({x, y}, s, sampler, work);
        if (!is_usable(sample.seen)) {
          ++counters.bad_samples;
          if (counters.examples.size() < kBadExamples) counters.examples.push_back({{x, y}, s});
          work.splats.clear();
          continue;
        }
        if (!work.splats.empty()) take_splats({x, y}, s, work, sums.splats, counters);
        pixel.add(sample, work.parts != nullptr ? std::span<const Rgb>(work.parts->sums())
                                                : std::span<const Rgb>());
        if (layout_.layers.has_ids()) count_ids(sample, index, sums);
      }
      if (samples_done != nullptr) samples_done->fetch_add(count, std::memory_order_relaxed);
      out = pixel.write(out);
      ++index;
    }
  }
  counters.samples += uint64_t{count} * static_cast<uint64_t>(unit.tile.area());
  return true;
}

void FrameRenderer::count_ids(const TakenSample& sample, uint32_t pixel, BatchSums& sums) const {
  // Where a filter is negative its samples take away: they say nothing of what covers the pixel.
  if (!(sample.weight > 0.0F)) return;
  const uint32_t object = sample.seen.object;
  const bool met = object != PixelSample::kNoObject;
  if (met) sums.objects.insert(object);
  for (size_t kind = 0; kind < kIdKinds; ++kind) {
    if (!layout_.layers.ids[kind]) continue;
    const uint32_t id = met ? scene_->objects[object].ids[kind] : IdLayer::kNothing;
    std::vector<IdCount>& ids = sums.ids[kind];
    if (!ids.empty() && ids.back().pixel == pixel && ids.back().id == id) {
      ++ids.back().count;
    } else {
      ids.push_back({pixel, id, 1});
    }
  }
}

void FrameRenderer::deposit_ids(BatchSums& sums, Film& film) const {
  for (const IdKind kind : {IdKind::object, IdKind::material}) {
    const auto k = static_cast<size_t>(kind);
    if (!layout_.layers.ids[k]) continue;
    IdLayer& ids = film.mutable_ids(kind);
    ids.deposit(std::move(sums.ids[k]));
    for (const uint32_t index : sums.objects) {
      const SceneObject& object = scene_->objects[index];
      ids.name(object.ids[k], kind == IdKind::object ? object.name : object.material_name);
    }
  }
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
  LightParts parts(part_table_);
  if (part_table_.count > 0) work.parts = chain_work.parts = &parts;
  BatchSums sums;
  sums.splats.parts.resize(part_table_.count);
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
    if (layout_.layers.splats) {
      result.film.deposit_splats(std::move(sums.splats.beauty));
      for (size_t i = 0; i < part_table_.count; ++i)
        result.film.deposit_splats(i, std::move(sums.splats.parts[i]));
    }
    if (layout_.layers.has_ids()) deposit_ids(sums, result.film);
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
  const PixelSample result = sample_pixel(pixel, sample, *sampler, work).seen;
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
