#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "core/base/rect.h"
#include "core/integrators/integrator.h"
#include "core/integrators/light_parts.h"

namespace hyades::core {

/// Which chain of a frame: the share of the film and the batch of samples whose mutations it makes.
struct ChainName {
  uint64_t seed = 0;
  uint32_t frame = 0;
  PixelRect share;  ///< its upper left corner names the chain, its area is its mutations per sample
  uint32_t batch = 0;
  uint32_t samples = 1;  ///< mutations per pixel of the share
};

/// What chains need to know of the film.
struct ChainFilm {
  float margin = 0.0F;      ///< how far a pixel's filter reaches beyond the window
  bool needs_time = false;  ///< whether the shutter is open for a while
};

/// What a chain tells while it runs.
class ChainSink {
 public:
  virtual ~ChainSink() = default;
  /// `parts`: those of its light, where it is told apart.
  virtual void deposit(const Splat& splat, std::span<const SplatPart> parts) = 0;
  /// Called now and then; `done`: the share of the chain's work so far, 0 to 1. False: it should
  /// end.
  virtual bool goes_on(double done) = 0;
};

/// Metropolis light transport in primary sample space (Kelemen et al. 2002): a Markov chain over
/// the random numbers of another integrator's samples, in proportion to the light they bring. Each
/// chain begins with one of its own independent samples, chosen in proportion to their light, and
/// counts with their mean (Veach and Guibas 1997, section 4: unbiased however few they are). The
/// size of small steps is adapted by a trial chain of its own before that begins, and frozen then:
/// no state that counts had a part in it. Both states count in every step, by the probability of
/// acceptance. Light that the camera meets directly is left to others (IntegratorDesc::min_events).
class Metropolis {
 public:
  explicit Metropolis(const IntegratorDesc& desc);

  /// Gives `sink` splats whose sum over a film's chains, divided by the number of their mutations,
  /// is the picture but for what the camera meets directly. False where the sink has ended it.
  bool run(const Scene& scene, const ChainFilm& film, const ChainName& name, Workspace& work,
           ChainSink& sink) const;

 private:
  std::unique_ptr<Integrator> inner_;
  IntegratorDesc settings_;
};

}  // namespace hyades::core
