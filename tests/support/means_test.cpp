#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/means.h"
#include "tests/support/random.h"

namespace hyades::test {
namespace {

Moments uniform_sample(int count, double low, double high, uint64_t seed) {
  Random random(seed);
  Moments moments;
  for (int i = 0; i < count; ++i) moments.add(low + (high - low) * random.uniform_double());
  return moments;
}

TEST(Moments, MergeEqualsOneStream) {
  Random random(3);
  Moments all;
  Moments first;
  Moments second;
  for (int i = 0; i < 1000; ++i) {
    const double x = random.uniform_double();
    all.add(x);
    (i < 300 ? first : second).add(x);
  }
  first.merge(second);
  EXPECT_EQ(first.count(), all.count());
  EXPECT_NEAR(first.mean(), all.mean(), 1e-13);
  EXPECT_NEAR(first.variance(), all.variance(), 1e-13);
  EXPECT_NEAR(all.variance(), 1.0 / 12.0, 0.01);
}

TEST(MeanTest, AcceptsTheRightMeanAndRejectsAnErrorOfOnePercent) {
  const Moments sample = uniform_sample(200000, 0.0, 1.0, 1);
  EXPECT_TRUE(mean_is(sample, 0.5));
  EXPECT_FALSE(mean_is(sample, 0.505));
  EXPECT_FALSE(mean_is(sample, 0.495));
}

TEST(MeanTest, TooFewSamplesFailAsUnderpowered) {
  const auto result = mean_is(uniform_sample(1000, 0.0, 1.0, 2), 0.5);
  ASSERT_FALSE(result);
  EXPECT_NE(std::string(result.message()).find("underpowered"), std::string::npos);
  EXPECT_FALSE(mean_is(Moments(), 0.5));
}

TEST(MeanTest, PowerIsWhatRequiredSamplesSays) {
  // Samples with a mean 2 % too high, as many as asked for: detected in about 95 of 100 repeats.
  const int64_t count = required_samples(1.0 / std::sqrt(12.0), 0.01, 0.05, 0.95);
  int detected = 0;
  int false_alarms = 0;
  for (int i = 0; i < 400; ++i) {
    const Moments sample = uniform_sample(static_cast<int>(count), 0.01, 1.01, 100 + i);
    detected += t_test(sample, 0.5) < 0.05 ? 1 : 0;
    false_alarms += t_test(sample, 0.51) < 0.05 ? 1 : 0;
  }
  EXPECT_NEAR(detected / 400.0, 0.95, 0.04);
  EXPECT_NEAR(false_alarms / 400.0, 0.05, 0.04);
}

TEST(MeanTest, SampleWithoutVarianceMustBeExact) {
  Moments constant;
  for (int i = 0; i < 10; ++i) constant.add(2.0);
  EXPECT_TRUE(mean_is(constant, 2.0));
  EXPECT_FALSE(mean_is(constant, 2.001));
}

TEST(MeanTest, TwoSamplesAgreeOrNot) {
  const Moments a = uniform_sample(200000, 0.0, 1.0, 5);
  EXPECT_TRUE(means_agree(a, uniform_sample(200000, 0.0, 1.0, 6)));
  EXPECT_FALSE(means_agree(a, uniform_sample(200000, 0.01, 1.01, 7)));
  EXPECT_FALSE(means_agree(a, uniform_sample(500, 0.0, 1.0, 8)));  // underpowered
}

TEST(MeanTest, SidakKeepsTheJointSignificance) {
  EXPECT_NEAR(sidak(0.01, 1), 0.01, 1e-15);
  EXPECT_NEAR(1.0 - std::pow(1.0 - sidak(0.01, 37), 37), 0.01, 1e-12);
  EXPECT_NEAR(z_test(1.959964, 1.0), 0.05, 1e-6);
  EXPECT_EQ(z_test(0.1, 0.0), 0.0);
}

}  // namespace
}  // namespace hyades::test
