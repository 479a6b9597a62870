#pragma once

#include <smmintrin.h>

#include <cstdint>

#include "core/samplers/sample_key.h"
#include "core/samplers/sampler.h"
#include "core/samplers/sobol_matrices.h"

namespace hyades::core {

/// Owen-scrambled Sobol points (Burley 2020, "Practical Hash-based Owen Scrambling"): dimensions in
/// groups of four; in each group the sample index is shuffled and each dimension scrambled by
/// nested uniform scrambling, seeded by a hash of pixel and group. In each group both pairs of
/// dimensions are (0, 2)-sequences in base 2, and any prefix of the samples is well spread. A group
/// is computed at once, in the four lanes of a register, and kept.
class SobolSampler final : public Sampler {
 public:
  void start(const SampleId& id) override {
    key_ = pixel_key(id);
    mirrored_index_ = mirror(id.sample);
    dimension_ = 0;
    group_ = kNoGroup;
  }

  void set_dimension(uint32_t dimension) override { dimension_ = dimension; }

  float next_1d() override {
    const uint32_t d = dimension_++;
    load(d >> 2);
    return values_[d & 3];
  }

  Vec2 next_2d() override {
    const uint32_t d = dimension_ + (dimension_ & 1);
    dimension_ = d + 2;
    load(d >> 2);
    return {values_[d & 3], values_[(d & 3) + 1]};
  }

  Vec4 next_4d() override {
    const uint32_t group = (dimension_ + 3) >> 2;
    dimension_ = 4 * group + 4;
    load(group);
    return {values_[0], values_[1], values_[2], values_[3]};
  }

 private:
  static constexpr uint32_t kNoGroup = ~0U;

  static uint32_t mirror(uint32_t x) {
    x = (x >> 16) | (x << 16);
    x = ((x >> 8) & 0x00FF00FFU) | ((x & 0x00FF00FFU) << 8);
    x = ((x >> 4) & 0x0F0F0F0FU) | ((x & 0x0F0F0F0FU) << 4);
    x = ((x >> 2) & 0x33333333U) | ((x & 0x33333333U) << 2);
    return ((x >> 1) & 0x55555555U) | ((x & 0x55555555U) << 1);
  }

  /// A permutation in which each bit depends on itself and lower ones only: on mirrored numbers
  /// that is Owen's nested scrambling (Laine and Karras 2011; constants by Vegdahl 2021, "Building
  /// a Better LK Hash").
  static uint32_t scramble(uint32_t x, uint32_t seed) {
    x ^= x * 0x3D20ADEAU;
    x += seed;
    x *= (seed >> 16) | 1U;
    x ^= x * 0x05526C56U;
    return x ^ (x * 0x53A22864U);
  }

  static __m128i scramble(__m128i x, __m128i seed) {
    const auto times = [](__m128i a, uint32_t b) {
      return _mm_mullo_epi32(a, _mm_set1_epi32(static_cast<int>(b)));
    };
    x = _mm_xor_si128(x, times(x, 0x3D20ADEAU));
    x = _mm_add_epi32(x, seed);
    x = _mm_mullo_epi32(x, _mm_or_si128(_mm_srli_epi32(seed, 16), _mm_set1_epi32(1)));
    x = _mm_xor_si128(x, times(x, 0x05526C56U));
    return _mm_xor_si128(x, times(x, 0x53A22864U));
  }

  /// The bits of each lane in reverse order: nibbles by table, then the bytes.
  static __m128i mirror(__m128i x) {
    const __m128i low = _mm_set1_epi8(0x0F);
    const __m128i table = _mm_setr_epi8(0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5, 13, 3, 11, 7, 15);
    const __m128i up = _mm_shuffle_epi8(_mm_slli_epi32(table, 4), _mm_and_si128(x, low));
    const __m128i down = _mm_shuffle_epi8(table, _mm_and_si128(_mm_srli_epi32(x, 4), low));
    const __m128i bytes = _mm_setr_epi8(3, 2, 1, 0, 7, 6, 5, 4, 11, 10, 9, 8, 15, 14, 13, 12);
    return _mm_shuffle_epi8(_mm_or_si128(up, down), bytes);
  }

  void load(uint32_t group) {
    if (group == group_) return;
    group_ = group;
    const uint64_t counter = key_ + 3 * uint64_t{group} * kGoldenGamma;
    const uint64_t index_seed = mix64(counter + kGoldenGamma);
    const uint64_t seeds01 = mix64(counter + 2 * kGoldenGamma);
    const uint64_t seeds23 = mix64(counter + 3 * kGoldenGamma);

    const uint32_t index = scramble(mirrored_index_, static_cast<uint32_t>(index_seed));
    __m128i digits = _mm_setzero_si128();
    for (uint32_t nibble = 0; nibble < 8; ++nibble) {
      const uint32_t* row = sobol::kNibbles.digits[nibble][index >> (4 * nibble) & 15U];
      digits = _mm_xor_si128(digits, _mm_load_si128(reinterpret_cast<const __m128i*>(row)));
    }
    const __m128i seeds =
        _mm_set_epi64x(static_cast<long long>(seeds23), static_cast<long long>(seeds01));
    // The 24 leading bits: exact in a float, and never 1.
    const __m128i bits = _mm_srli_epi32(mirror(scramble(digits, seeds)), 8);
    _mm_store_ps(values_, _mm_mul_ps(_mm_cvtepi32_ps(bits), _mm_set1_ps(0x1p-24F)));
  }

  alignas(16) float values_[4] = {};
  uint64_t key_ = 0;
  uint32_t mirrored_index_ = 0;
  uint32_t dimension_ = 0;
  uint32_t group_ = kNoGroup;
};

}  // namespace hyades::core
