#include "core/samplers/sampler.h"

#include "core/samplers/independent_sampler.h"
#include "core/samplers/sobol_sampler.h"

namespace hyades::core {

std::unique_ptr<Sampler> make_sampler(SamplerKind kind) {
  if (kind == SamplerKind::independent) return std::make_unique<IndependentSampler>();
  return std::make_unique<SobolSampler>();
}

}  // namespace hyades::core
