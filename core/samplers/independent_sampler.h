#pragma once

#include <cstdint>

#include "core/samplers/sample_key.h"
#include "core/samplers/sampler.h"

namespace hyades::core {

/// Independent uniform numbers: a hash per (sample, dimension).
class IndependentSampler final : public Sampler {
 public:
  void start(const SampleId& id) override {
    key_ = hash_combine(pixel_key(id), id.sample);
    dimension_ = 0;
  }
  void set_dimension(uint32_t dimension) override { dimension_ = dimension; }
  float next_1d() override { return at(dimension_++); }
  Vec2 next_2d() override {
    const uint32_t even = dimension_ + (dimension_ & 1);
    dimension_ = even + 2;
    return {at(even), at(even + 1)};
  }
  Vec4 next_4d() override {
    const uint32_t first = (dimension_ + 3) & ~3U;
    dimension_ = first + 4;
    return {at(first), at(first + 1), at(first + 2), at(first + 3)};
  }

 private:
  float at(uint32_t dimension) const {
    return static_cast<float>(mix64(key_ + kGoldenGamma * (dimension + uint64_t{1})) >> 40) *
           0x1p-24F;
  }

  uint64_t key_ = 0;
  uint32_t dimension_ = 0;
};

}  // namespace hyades::core
