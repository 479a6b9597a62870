#include "core/base/distribution.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/base/hash.h"

namespace hyades::core {
namespace {

constexpr float kBelowOne = 0x1.fffffep-1F;

float random_unit(uint64_t i, uint64_t stream) {
  return static_cast<float>(hash_combine(i, stream) >> 40) * 0x1p-24F;
}

// Exhausting the 2^24 numbers that a sampler can give is feasible: no statistics needed.
TEST(Distribution1D, EveryEntryComesExactlyAsOftenAsItsProbabilitySays) {
  const std::vector<float> weights = {0.0F, 3.0F, 1e-12F, 0.0F, 7.5F, 0.25F, 0.0F};
  const Distribution1D d(weights);
  EXPECT_EQ(d.size(), weights.size());
  EXPECT_NEAR(d.total(), 10.75, 1e-6);
  std::vector<uint32_t> counts(weights.size());
  for (uint32_t i = 0; i < (1U << 24); ++i) {
    const auto choice = d.sample(static_cast<float>(i) * 0x1p-24F);
    ++counts[choice.index];
    ASSERT_TRUE(choice.u >= 0.0F && choice.u < 1.0F);
  }
  for (uint32_t i = 0; i < weights.size(); ++i) {
    EXPECT_EQ(static_cast<float>(counts[i]) * 0x1p-24F, d.probability(i));
    EXPECT_NEAR(d.probability(i), weights[i] / 10.75F, 1e-6F);
    EXPECT_EQ(counts[i] > 0, weights[i] > 0.0F) << i;
  }
}

TEST(Distribution1D, NeverReturnsAnEntryWithoutWeight) {
  for (uint64_t trial = 0; trial < 200; ++trial) {
    std::vector<float> weights(1 + trial);
    for (size_t i = 0; i < weights.size(); ++i) {
      const float w = random_unit(i, trial);
      weights[i] = w < 0.6F ? 0.0F : std::pow(10.0F, 40.0F * (w - 0.8F));
    }
    weights[trial / 2] = 1.0F;
    const Distribution1D d(weights);
    for (uint64_t i = 0; i < 200; ++i) {
      const auto choice = d.sample(i == 0   ? 0.0F
                                   : i == 1 ? kBelowOne
                                            : random_unit(i, trial + 1000));
      ASSERT_GT(weights[choice.index], 0.0F);
      ASSERT_EQ(choice.probability, d.probability(choice.index));
      ASSERT_GT(choice.probability, 0.0F);
    }
  }
}

TEST(Distribution1D, LeftoverOfTheNumberIsUniformAndInverts) {
  const Distribution1D d(std::vector<float>{1.0F, 2.0F, 0.0F, 5.0F});
  double sum = 0.0;
  for (uint64_t i = 0; i < 100'000; ++i) {
    const float u = (static_cast<float>(i) + 0.5F) / 100'000.0F;
    const auto choice = d.sample(u);
    sum += choice.u;
    EXPECT_NEAR(d.invert(choice.index, choice.u), u, 2e-7F);
  }
  EXPECT_NEAR(sum / 100'000, 0.5, 1e-3);
}

TEST(Distribution1D, OddWeightsCountAsZeroAndAllZeroIsEmpty) {
  const float inf = std::numeric_limits<float>::infinity();
  const Distribution1D d(
      std::vector<float>{-1.0F, std::numeric_limits<float>::quiet_NaN(), inf, 2.0F});
  EXPECT_EQ(d.sample(0.0F).index, 3U);
  EXPECT_EQ(d.probability(3), 1.0F);
  const Distribution1D none(std::vector<float>{0.0F, 0.0F});
  EXPECT_TRUE(none.empty());
  EXPECT_EQ(none.sample(0.5F).probability, 0.0F);
  EXPECT_TRUE(Distribution1D().empty());
  EXPECT_EQ(Distribution1D().sample(0.5F).probability, 0.0F);
}

TEST(Distribution1D, AMillionEntriesAllHaveAChance) {
  std::vector<float> weights(1'000'000, 1e-6F);
  weights[77] = 1e6F;
  const Distribution1D d(weights);
  double sum = 0.0;
  for (uint32_t i = 0; i < d.size(); ++i) {
    ASSERT_GT(d.probability(i), 0.0F);
    sum += d.probability(i);
  }
  EXPECT_EQ(sum, 1.0);
  EXPECT_GT(d.probability(77), 0.9F);
}

std::vector<float> image(uint32_t width, uint32_t height) {
  std::vector<float> weights(size_t{width} * height);
  for (size_t i = 0; i < weights.size(); ++i) {
    const float w = random_unit(i, 42);
    weights[i] = w < 0.3F ? 0.0F : w * w * w;
  }
  for (uint32_t x = 0; x < width; ++x) weights[size_t{height / 2} * width + x] = 0.0F;
  return weights;
}

// Power: about 300 cells expect some 3,000 of 2^20 points each, a 2 % standard deviation; a density
// wrong by a factor 1 + 0.04 sin over the cells moves chi-squared by 2^20 * 0.04^2 / 2 = 840, 34 of
// its sigmas. A wrong constant factor is found by the integral in the next test.
TEST(Distribution2D, SamplesFollowTheDensity) {
  const uint32_t width = 31;
  const uint32_t height = 17;
  const std::vector<float> weights = image(width, height);
  const Distribution2D d(weights, width, height);
  std::vector<int> counts(weights.size());
  double area = 0.0;
  constexpr int kPoints = 1 << 20;
  for (int i = 0; i < kPoints; ++i) {
    const auto p = d.sample({random_unit(i, 1), random_unit(i, 2)});
    ASSERT_TRUE(p.at.x >= 0.0F && p.at.x < 1.0F && p.at.y >= 0.0F && p.at.y < 1.0F);
    ASSERT_GT(weights[p.y * width + p.x], 0.0F);
    ASSERT_EQ(p.pdf, d.pdf(p.at));
    ++counts[p.y * width + p.x];
    area += 1.0 / p.pdf;
  }
  double covered = 0.0;
  double sum = 0.0;
  double chi2 = 0.0;
  int cells = 0;
  for (const float w : weights) sum += w;
  for (size_t i = 0; i < weights.size(); ++i) {
    if (weights[i] == 0.0F) continue;
    covered += 1.0 / static_cast<double>(weights.size());
    const double expected = kPoints * weights[i] / sum;
    chi2 += (counts[i] - expected) * (counts[i] - expected) / expected;
    ++cells;
  }
  EXPECT_LT(std::fabs(chi2 - cells) / std::sqrt(2.0 * cells), 4.0);
  EXPECT_NEAR(area / kPoints, covered, 0.02 * covered);
  EXPECT_NEAR(d.mean(), sum / static_cast<double>(weights.size()), 1e-6);
}

TEST(Distribution2D, DensityIntegratesToOneAndInverts) {
  const Distribution2D d(image(64, 32), 64, 32);
  double integral = 0.0;
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 64; ++x) {
      integral += d.pdf({(x + 0.5F) / 64, (y + 0.5F) / 32}) / (64.0 * 32.0);
    }
  }
  EXPECT_NEAR(integral, 1.0, 1e-6);
  for (uint64_t i = 0; i < 10'000; ++i) {
    const Vec2 u(random_unit(i, 5), random_unit(i, 6));
    const Vec2 back = d.invert(d.sample(u).at);
    EXPECT_NEAR(back.x, u.x, 1e-5F);
    EXPECT_NEAR(back.y, u.y, 1e-5F);
  }
}

TEST(Distribution2D, EdgesAndEmptiness) {
  const Distribution2D d(std::vector<float>{1.0F, 2.0F, 3.0F, 4.0F}, 2, 2);
  EXPECT_EQ(d.pdf({1.0F, 0.5F}), 0.0F);
  EXPECT_EQ(d.pdf({-0.1F, 0.5F}), 0.0F);
  EXPECT_NEAR(d.pdf({0.99F, 0.99F}), 1.6F, 1e-5F);
  const auto last = d.sample({kBelowOne, kBelowOne});
  EXPECT_TRUE(last.x == 1 && last.y == 1 && last.at.x < 1.0F && last.at.y < 1.0F);
  const Distribution2D none(std::vector<float>(4, 0.0F), 2, 2);
  EXPECT_TRUE(none.empty());
  EXPECT_EQ(none.pdf({0.5F, 0.5F}), 0.0F);
  EXPECT_EQ(none.sample({0.5F, 0.5F}).pdf, 0.0F);
  EXPECT_EQ(none.mean(), 0.0);
}

}  // namespace
}  // namespace hyades::core
