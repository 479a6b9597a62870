#include "core/integrators/metropolis.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/elementary.h"
#include "core/base/hash.h"
#include "core/integrators/primary_sampler.h"

namespace hyades::core {
namespace {

constexpr uint64_t kTrial = 0x7472'6961'6CULL;      ///< "trial", so that it shares no numbers
constexpr uint64_t kChoice = 0x63'686F'6963'65ULL;  ///< "choice"
constexpr uint64_t kMutations = 0x6D'7574'6174'65ULL;

constexpr uint64_t kBetweenQuestions = 16;  ///< samples between two looks whether to go on

constexpr float kFirstSigma = 0.02F;
constexpr float kLeastSigma = 1e-4F;
constexpr float kMostSigma = 0.25F;
constexpr float kAcceptance = 0.35F;  ///< of small steps, what the trial aims at

/// A sample of the inner integrator and the light it brings.
struct State {
  std::vector<Splat> light;
  std::vector<SplatPart> parts;  ///< of it, where it is told apart
  double brightness = 0.0;       ///< of all of it
  double weight = 0.0;           ///< expected number of steps that it has counted for so far
};

class Chain {
 public:
  Chain(const Integrator& inner, const IntegratorDesc& settings, const Scene& scene,
        const ChainFilm& film, const ChainName& name, Workspace& work, ChainSink& sink)
      : inner_(inner),
        settings_(settings),
        scene_(scene),
        film_(film),
        work_(work),
        sink_(sink),
        corner_(Vec2(static_cast<float>(scene.window.x0), static_cast<float>(scene.window.y0)) -
                film.margin),
        size_(Vec2(static_cast<float>(scene.window.width()),
                   static_cast<float>(scene.window.height())) +
              2.0F * film.margin),
        steps_(static_cast<uint64_t>(name.share.area()) * name.samples) {
    key_ = hash_combine(hash_combine(name.seed, name.frame),
                        hash_combine(static_cast<uint64_t>(static_cast<uint32_t>(name.share.x0)),
                                     static_cast<uint64_t>(static_cast<uint32_t>(name.share.y0))));
    key_ = hash_combine(key_, name.batch);
    candidates_ = std::clamp<uint64_t>(steps_ / 16, 64, 65536);
  }

  bool run() {
    const float sigma = adapted_sigma();
    const auto start = begin(key_, candidates_);
    if (stopped_) return false;
    if (!start) return true;  // all samples were black: so is the estimate
    PrimarySampler sampler(start->key);
    NumberStream choices(hash_combine(key_, kMutations));
    State now;
    State next;
    evaluate(sampler, now);
    for (uint64_t step = 0; step < steps_; ++step) {
      if (stopped()) return false;
      sampler.mutate(choices.next() < settings_.large_step, sigma);
      evaluate(sampler, next);
      const double accept = std::min(1.0, next.brightness / now.brightness);
      now.weight += 1.0 - accept;
      next.weight = accept;
      if (static_cast<double>(choices.next()) < accept) {
        count(now, start->mean);
        std::swap(now, next);
        sampler.accept();
      } else {
        count(next, start->mean);
        sampler.reject();
      }
    }
    count(now, start->mean);
    return true;
  }

 private:
  struct Start {
    uint64_t key = 0;   ///< of the sampler whose first state it is
    double mean = 0.0;  ///< brightness of all candidates
  };

  /// One of `count` independent samples, in proportion to its brightness.
  std::optional<Start> begin(uint64_t key, uint64_t count) {
    std::vector<double> sums;
    sums.reserve(count);
    double sum = 0.0;
    State state;
    for (uint64_t i = 0; i < count && !stopped(); ++i) {
      PrimarySampler sampler(hash_combine(key, i));
      evaluate(sampler, state);
      sums.push_back(sum += state.brightness);
    }
    if (!(sum > 0.0)) return std::nullopt;
    const double place = static_cast<double>(NumberStream(hash_combine(key, kChoice)).next()) * sum;
    const auto chosen = std::upper_bound(sums.begin(), sums.end(), place);
    // Never a black one, also where rounding brings `place` to the end.
    auto index = static_cast<uint64_t>(std::min(chosen, sums.end() - 1) - sums.begin());
    while (index > 0 && sums[index] == sums[index - 1]) --index;
    return Start{hash_combine(key, index), sum / static_cast<double>(count)};
  }

  /// The size of small steps that are accepted about as often as wanted (Robbins and Monro 1951).
  float adapted_sigma() {
    const uint64_t key = hash_combine(key_, kTrial);
    const auto start = begin(key, std::max<uint64_t>(candidates_ / 4, 32));
    if (!start) return kFirstSigma;
    PrimarySampler sampler(start->key);
    State now;
    State next;
    evaluate(sampler, now);
    NumberStream choices(hash_combine(key, kMutations));
    float log_sigma = log(kFirstSigma);
    const uint64_t steps = candidates_ / 4;
    float small_steps = 0.0F;
    for (uint64_t step = 0; step < steps && !stopped(); ++step) {
      const bool large = choices.next() < settings_.large_step;
      sampler.mutate(large, exp(log_sigma));
      evaluate(sampler, next);
      const auto accept = static_cast<float>(std::min(1.0, next.brightness / now.brightness));
      if (!large) {
        small_steps += 1.0F;
        log_sigma += (accept - kAcceptance) * 2.0F / std::sqrt(small_steps);
        log_sigma = std::clamp(log_sigma, log(kLeastSigma), log(kMostSigma));
      }
      if (choices.next() < accept) {
        std::swap(now, next);
        sampler.accept();
      } else {
        sampler.reject();
      }
    }
    return exp(log_sigma);
  }

  /// Whether the sink has ended the chain; asked before every sample.
  bool stopped() {
    const uint64_t all = steps_ + candidates_ + candidates_ / 2;
    if (++evaluated_ % kBetweenQuestions == 0) {
      stopped_ =
          !sink_.goes_on(std::min(1.0, static_cast<double>(evaluated_) / static_cast<double>(all)));
    }
    return stopped_;
  }

  void evaluate(PrimarySampler& sampler, State& state) {
    sampler.start({});
    const Vec2 place = corner_ + sampler.next_2d() * size_;
    const Vec2 lens = sampler.next_2d();
    const float time = film_.needs_time ? sampler.next_1d() : 0.0F;
    work_.splats.clear();
    if (work_.parts != nullptr) work_.parts->clear();
    const PixelSample sample =
        inner_.sample(scene_, scene_.camera->generate(place, lens, time), sampler, work_);
    state.light.clear();
    state.parts.clear();
    state.weight = 0.0;
    // Film positions are uniform over the film, pixels are means over their filters.
    if (!is_black(sample.radiance))
      state.light.push_back({place, sample.radiance * (size_.x * size_.y)});
    state.light.insert(state.light.end(), work_.splats.begin(), work_.splats.end());
    if (work_.parts != nullptr) take_parts(state);
    work_.splats.clear();
    state.brightness = 0.0;
    for (const Splat& splat : state.light)
      state.brightness += static_cast<double>(splat.value.x + splat.value.y + splat.value.z);
    // Not finite: a place where the chain must not go.
    if (!(state.brightness > 0.0) || !std::isfinite(state.brightness)) {
      state.brightness = 0.0;
      state.light.clear();
    }
  }

  /// The parts of what `state` has found: those of the camera path's own light, where there is
  /// some, come first.
  void take_parts(State& state) const {
    const size_t own = state.light.size() - work_.splats.size();
    if (own > 0) {
      const std::vector<Rgb>& sums = work_.parts->sums();
      for (uint32_t part = 0; part < sums.size(); ++part) {
        if (!is_black(sums[part])) state.parts.push_back({part, sums[part] * (size_.x * size_.y)});
      }
      state.light[0].parts = static_cast<uint32_t>(state.parts.size());
    }
    const auto before = static_cast<uint32_t>(state.parts.size());
    const std::vector<SplatPart>& parts = work_.parts->splat_parts();
    state.parts.insert(state.parts.end(), parts.begin(), parts.end());
    for (size_t i = own; i < state.light.size(); ++i) state.light[i].first_part += before;
  }

  void count(const State& state, double mean) {
    if (!(state.weight > 0.0) || !(state.brightness > 0.0)) return;
    const auto scale = static_cast<float>(mean * state.weight / state.brightness);
    for (const Splat& splat : state.light) {
      scaled_.assign(state.parts.begin() + splat.first_part,
                     state.parts.begin() + splat.first_part + splat.parts);
      for (SplatPart& part : scaled_) part.value *= scale;
      sink_.deposit({splat.film, splat.value * scale}, scaled_);
    }
  }

  const Integrator& inner_;
  const IntegratorDesc& settings_;
  const Scene& scene_;
  const ChainFilm& film_;
  Workspace& work_;
  ChainSink& sink_;
  std::vector<SplatPart> scaled_;
  Vec2 corner_;  ///< of the film with its margin
  Vec2 size_;
  uint64_t steps_;
  uint64_t candidates_ = 0;
  uint64_t key_ = 0;
  uint64_t evaluated_ = 0;
  bool stopped_ = false;
};

}  // namespace

Metropolis::Metropolis(const IntegratorDesc& desc) : settings_(desc) {
  IntegratorDesc inner = desc;
  inner.type = desc.over;
  inner.min_events = 1;
  inner_ = make_integrator(inner);
}

bool Metropolis::run(const Scene& scene, const ChainFilm& film, const ChainName& name,
                     Workspace& work, ChainSink& sink) const {
  return Chain(*inner_, settings_, scene, film, name, work, sink).run();
}

}  // namespace hyades::core
