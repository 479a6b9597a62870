#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/media/make_medium.h"
#include "core/media/shares.h"
#include "tests/core/media/volumes.h"
#include "tests/support/means.h"
#include "tests/support/random.h"

namespace hyades::core {
namespace {

const Rgb kAbsorption(0.1F, 0.5F, 0.0F);
const Rgb kScattering(0.4F, 2.0F, 0.05F);

MediumPtr coloured(const Rgb& emission = Rgb(0.0F)) {
  return make_homogeneous(kAbsorption, kScattering, emission, Phase::henyey_greenstein(Rgb(0.0F)));
}

double extinction(int c) { return double{kAbsorption[c]} + double{kScattering[c]}; }

TEST(Homogeneous, TransmittanceIsBeersLaw) {
  const MediumPtr medium = coloured();
  for (const float t : {0.0F, 0.3F, 2.0F, 50.0F}) {
    const Rgb share = medium->transmittance({}, t, Vec4(0.5F));
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(double{share[c]}, std::exp(-extinction(c) * double{t}), 1e-6);
    }
  }
}

// Whatever the shares are, each channel's mean weight of passing is its transmittance, and the mean
// weight of scattering in the first half of the way is scattering / extinction of what is lost
// there. An error of 1 % is noticed with probability 0.99.
TEST(Homogeneous, FreeFlightIsUnbiasedInEveryChannel) {
  const MediumPtr medium = coloured();
  const float t_max = 1.5F;
  const std::array<Rgb, 3> shares = {Rgb(1.0F / 3.0F), Rgb(0.6F, 0.3F, 0.1F),
                                     Rgb(0.05F, 0.15F, 0.8F)};
  test::Promise promise{.tests = 18};
  for (size_t s = 0; s < shares.size(); ++s) {
    std::array<test::Moments, 3> passed;
    std::array<test::Moments, 3> near;
    test::Random random(31 + s);
    for (int n = 0; n < 6'000'000; ++n) {
      const MediumSample sample = medium->sample({}, t_max, shares[s], random4(random));
      for (int c = 0; c < 3; ++c) {
        const auto i = static_cast<size_t>(c);
        passed[i].add(sample.scattered ? 0.0 : double{sample.weight[c]});
        near[i].add(sample.scattered && sample.t < 0.5F * t_max ? double{sample.weight[c]} : 0.0);
      }
    }
    for (int c = 0; c < 3; ++c) {
      const auto i = static_cast<size_t>(c);
      const double sigma = extinction(c);
      EXPECT_TRUE(test::mean_is(passed[i], std::exp(-sigma * double{t_max}), promise)) << c;
      const double scattered = double{kScattering[c]} / sigma;
      EXPECT_TRUE(
          test::mean_is(near[i], scattered * -std::expm1(-sigma * 0.5 * double{t_max}), promise))
          << c;
    }
  }
}

TEST(Homogeneous, WeightsAreBoundedByTheSharesAndNeverUndefined) {
  // One channel is a thousand times as dense as another; the path carries both.
  const MediumPtr medium = make_homogeneous(Rgb(0.0F), Rgb(1000.0F, 1.0F, 0.0F), Rgb(0.0F),
                                            Phase::henyey_greenstein(Rgb(0.0F)));
  test::Random random(5);
  for (int n = 0; n < 100'000; ++n) {
    const Rgb shares = channel_shares({random.uniform(), random.uniform(), random.uniform()});
    for (const float t_max : {0.1F, 10.0F, 1e6F, kInfinity}) {
      const MediumSample sample = medium->sample({}, t_max, shares, random4(random));
      for (int c = 0; c < 3; ++c) {
        ASSERT_TRUE(std::isfinite(sample.weight[c]));
        ASSERT_LE(shares[c] * sample.weight[c], 1.0F + 1e-5F);
      }
    }
  }
}

TEST(Homogeneous, AMediumThatOnlyAbsorbsNeverScatters) {
  const MediumPtr medium = make_homogeneous(Rgb(0.5F, 1.0F, 2.0F), Rgb(0.0F), Rgb(0.0F),
                                            Phase::henyey_greenstein(Rgb(0.0F)));
  test::Random random(7);
  for (int n = 0; n < 1000; ++n) {
    const MediumSample sample = medium->sample({}, 2.0F, Rgb(1.0F / 3.0F), random4(random));
    ASSERT_FALSE(sample.scattered);
    ASSERT_NEAR(sample.weight.y, std::exp(-2.0F), 1e-6F);
  }
}

// (1 - exp(-sigma t)) / sigma, and t where nothing is lost.
TEST(Homogeneous, GlowsByTheLengthThatIsSeen) {
  const MediumPtr medium = make_homogeneous(Rgb(0.1F, 2.0F, 0.0F), Rgb(0.0F), Rgb(3.0F, 4.0F, 5.0F),
                                            Phase::henyey_greenstein(Rgb(0.0F)));
  const Rgb seen = medium->emitted({}, 2.0F, Vec4(0.5F));
  EXPECT_NEAR(seen.x, 3.0 * -std::expm1(-0.2) / 0.1, 1e-4);
  EXPECT_NEAR(seen.y, 4.0 * -std::expm1(-4.0) / 2.0, 1e-4);
  EXPECT_NEAR(seen.z, 10.0, 1e-4);
  EXPECT_NEAR(medium->emitted({}, kInfinity, Vec4(0.5F)).y, 2.0, 1e-5);
}

TEST(Shares, AChannelOfShareZeroIsNeverChosen) {
  for (const float pick : {0.0F, 0.3F, 0.99F, 0x1.fffffep-1F}) {
    EXPECT_EQ(choose_channel({0.0F, 1.0F, 0.0F}, pick).index, 1);
    EXPECT_NE(choose_channel({0.5F, 0.5F, 0.0F}, pick).index, 2);
  }
  EXPECT_EQ(channel_shares(Rgb(0.0F)), Rgb(1.0F / 3.0F));
}

}  // namespace
}  // namespace hyades::core
