// Media that vary in space: unbiased in every channel, whatever the bounds that tracking is given
// (T9, T10).

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/media/shares.h"
#include "tests/core/media/volumes.h"
#include "tests/support/means.h"

namespace hyades::core {
namespace {

const Coefficients kThinSmoke{{0.05F, 0.1F, 0.0F}, {0.2F, 0.3F, 0.1F}, {1.0F, 0.5F, 2.0F}};

/// Absorbs nothing in one channel, scatters nothing in another.
const Coefficients kGaps{{0.3F, 0.0F, 0.0F}, {0.0F, 0.4F, 0.1F}, Rgb(0.0F)};

Phase even() { return Phase::henyey_greenstein(Rgb(0.0F)); }

double extinction(const Coefficients& c, int channel) {
  return double{c.absorption[channel]} + double{c.scattering[channel]};
}

struct Bound {
  Vec3i cells;
  float slack;
};
constexpr int kBoundCount = 4;
const std::array<Bound, kBoundCount> kBounds = {
    {{Vec3i(1), 1.0F}, {Vec3i(3, 7, 4), 1.0F}, {Vec3i(30), 2.0F}, {Vec3i(5), 10.0F}}};

/// A way through the middle of a random grid of 20 voxels a side, in the grid's own space.
Ray slanting() { return {Vec3(-2.0F, 3.0F, 5.0F), glm::normalize(Vec3(1.0F, 0.45F, 0.3F))}; }

using Three = std::array<test::Moments, 3>;

void add(Three& to, const Rgb& value) {
  for (size_t c = 0; c < 3; ++c) to[c].add(double{value[static_cast<int>(c)]});
}

TEST(Varying, TransmittanceIsUnbiasedWhateverTheBoundsAre) {
  const auto field = make_grid_density(random_grid(20, 3));
  test::Promise promise{.tests = 6 * kBoundCount, .relative_error = 0.02};
  const double passed = density_along(*field, slanting(), 10.0);
  ASSERT_GT(passed, 2.0);
  for (const Coefficients& coefficients : {kThinSmoke, kGaps}) {
    for (const Bound& bound : kBounds) {
      const MediumPtr medium = make_varying(volume_of(field, bound.cells, bound.slack),
                                            FieldPlace({Mat4(1.0F)}), coefficients, even());
      Three shares;
      test::Random random(7);
      for (int n = 0; n < 120'000; ++n)
        add(shares, medium->transmittance(slanting(), 10.0F, random4(random)));
      for (int c = 0; c < 3; ++c) {
        EXPECT_TRUE(test::mean_is(shares[static_cast<size_t>(c)],
                                  std::exp(-extinction(coefficients, c) * passed), promise))
            << "cells " << bound.cells.x << ", slack " << bound.slack << ", channel " << c;
      }
    }
  }
}

// Per channel: the weight of what passes, and of what scatters in the first half of the way.
TEST(Varying, FreeFlightIsUnbiasedInEveryChannelWhateverTheBoundsAre) {
  const auto field = make_grid_density(random_grid(20, 3));
  const float t_max = 10.0F;
  test::Promise promise{.tests = 6 * 3 * kBoundCount, .relative_error = 0.05};
  const double half = density_along(*field, slanting(), 5.0);
  const double whole = density_along(*field, slanting(), 10.0);
  for (const Bound& bound : kBounds) {
    const MediumPtr medium = make_varying(volume_of(field, bound.cells, bound.slack),
                                          FieldPlace({Mat4(1.0F)}), kThinSmoke, even());
    for (const Rgb& shares : {Rgb(1.0F / 3.0F), Rgb(0.45F, 0.3F, 0.25F), Rgb(0.2F, 0.25F, 0.55F)}) {
      Three passed;
      Three near;
      test::Random random(31);
      for (int n = 0; n < 750'000; ++n) {
        const MediumSample sample = medium->sample(slanting(), t_max, shares, random4(random));
        add(passed, sample.scattered ? Rgb(0.0F) : sample.weight);
        add(near, sample.scattered && sample.t < 0.5F * t_max ? sample.weight : Rgb(0.0F));
      }
      for (int c = 0; c < 3; ++c) {
        const auto i = static_cast<size_t>(c);
        const double sigma = extinction(kThinSmoke, c);
        const double albedo = double{kThinSmoke.scattering[c]} / sigma;
        EXPECT_TRUE(test::mean_is(passed[i], std::exp(-sigma * whole), promise)) << c;
        EXPECT_TRUE(test::mean_is(near[i], albedo * -std::expm1(-sigma * half), promise)) << c;
      }
    }
  }
}

// T9: the same in every density everywhere is a homogeneous medium, channels that do not scatter or
// do not absorb included.
TEST(Varying, AnEvenDensityIsAHomogeneousMedium) {
  const auto field = std::make_shared<EvenDensity>(Bounds{Vec3(-50.0F), Vec3(50.0F)}, 2.0F);
  test::Promise promise{.tests = 36, .relative_error = 0.03};
  for (const Coefficients& once : {kThinSmoke, kGaps}) {
    const MediumPtr even_medium =
        make_homogeneous(2.0F * once.absorption, 2.0F * once.scattering, Rgb(0.0F), even());
    const MediumPtr medium =
        make_varying(volume_of(field, Vec3i(3), 1.7F), FieldPlace({Mat4(1.0F)}), once, even());
    for (const Rgb& shares : {Rgb(1.0F / 3.0F), Rgb(0.1F, 0.7F, 0.2F)}) {
      std::array<Three, 2> passed;
      std::array<Three, 2> near;
      test::Random random(5);
      for (int n = 0; n < 400'000; ++n) {
        const Vec4 u = random4(random);
        for (size_t m = 0; m < 2; ++m) {
          const MediumSample sample = (m == 0 ? medium : even_medium)->sample({}, 2.0F, shares, u);
          add(passed[m], sample.scattered ? Rgb(0.0F) : sample.weight);
          add(near[m], sample.scattered && sample.t < 1.0F ? sample.weight : Rgb(0.0F));
        }
      }
      for (size_t c = 0; c < 3; ++c) {
        EXPECT_TRUE(test::means_agree(passed[0][c], passed[1][c], promise)) << c;
        if (once.scattering[static_cast<int>(c)] == 0.0F) {
          EXPECT_EQ(near[0][c].mean(), 0.0) << c;
        } else {
          EXPECT_TRUE(test::means_agree(near[0][c], near[1][c], promise)) << c;
        }
      }
    }
    // The least density of a cell is taken off in closed form: nothing is left to chance.
    const MediumPtr tight =
        make_varying(volume_of(field, Vec3i(3)), FieldPlace({Mat4(1.0F)}), once, even());
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(tight->transmittance({}, 2.0F, Vec4(0.5F))[c],
                  even_medium->transmittance({}, 2.0F, Vec4(0.5F))[c], 1e-6F);
    }
  }
}

// The integral of density times transmittance is (1 - exp(-sigma passed)) / sigma.
TEST(Varying, GlowsByWhatIsSeenWhateverTheBoundsAre) {
  const auto field = make_grid_density(random_grid(20, 3));
  test::Promise promise{.tests = 6 * kBoundCount};
  const Coefficients flame{Rgb(0.0F), Rgb(0.0F), {1.0F, 0.5F, 2.0F}};
  const double passed = density_along(*field, slanting(), 10.0);
  for (const Coefficients& coefficients : {kThinSmoke, flame}) {
    for (const Bound& bound : kBounds) {
      const MediumPtr medium = make_varying(volume_of(field, bound.cells, bound.slack),
                                            FieldPlace({Mat4(1.0F)}), coefficients, even());
      Three seen;
      test::Random random(17);
      for (int n = 0; n < 130'000; ++n)
        add(seen, medium->emitted(slanting(), 10.0F, random4(random)));
      for (int c = 0; c < 3; ++c) {
        const double sigma = extinction(coefficients, c);
        const double length = sigma > 0.0 ? -std::expm1(-sigma * passed) / sigma : passed;
        EXPECT_TRUE(test::mean_is(seen[static_cast<size_t>(c)],
                                  double{coefficients.emission[c]} * length, promise))
            << "cells " << bound.cells.x << ", slack " << bound.slack << ", channel " << c;
      }
    }
  }
}

TEST(Varying, WeightsAreBoundedByTheSharesAndNeverUndefined) {
  const auto field = make_grid_density(random_grid(12, 9));
  const Coefficients wild{Rgb(0.0F), {300.0F, 1.0F, 0.0F}, Rgb(0.0F)};
  const MediumPtr medium =
      make_varying(volume_of(field, Vec3i(4), 3.0F), FieldPlace({Mat4(1.0F)}), wild, even());
  test::Random random(5);
  for (int n = 0; n < 20'000; ++n) {
    const Rgb shares = channel_shares({random.uniform(), random.uniform(), random.uniform()});
    const Ray ray{Vec3(random.uniform(), random.uniform(), random.uniform()) * 12.0F,
                  random.direction()};
    for (const float t_max : {0.1F, 10.0F, kInfinity}) {
      const MediumSample sample = medium->sample(ray, t_max, shares, random4(random));
      for (int c = 0; c < 3; ++c) {
        ASSERT_TRUE(std::isfinite(sample.weight[c]));
        ASSERT_LE(shares[c] * sample.weight[c], 1.0F + 1e-5F);
      }
      if (sample.scattered) {
        ASSERT_LT(sample.t, t_max);
      }
    }
  }
}

// The same numbers give the same bits; other ones another walk.
TEST(Varying, AWalkIsAFunctionOfItsNumbers) {
  const auto field = make_grid_density(random_grid(20, 3));
  const auto make = [&] {
    return make_varying(volume_of(field, Vec3i(2), 5.0F), FieldPlace({Mat4(1.0F)}), kThinSmoke,
                        even());
  };
  const MediumPtr one = make();
  const MediumPtr other = make();
  test::Random random(3);
  int differing = 0;
  for (int n = 0; n < 1000; ++n) {
    Vec4 u = random4(random);
    const Rgb a = one->transmittance(slanting(), 10.0F, u);
    EXPECT_EQ(a, other->transmittance(slanting(), 10.0F, u));
    EXPECT_EQ(one->sample(slanting(), 10.0F, Rgb(1.0F / 3.0F), u).weight,
              other->sample(slanting(), 10.0F, Rgb(1.0F / 3.0F), u).weight);
    u.w = std::nextafter(u.w, 1.0F);
    differing += a != one->transmittance(slanting(), 10.0F, u) ? 1 : 0;
  }
  EXPECT_GT(differing, 900);
}

// Nothing is endless: a field that is nowhere as dense as its bounds say, at a density that would
// take 10^12 collisions.
TEST(Varying, WalksEndWhateverTheDensity) {
  class Deceiver final : public DensityField {
   public:
    float at(const Vec3&) const override { return 0.0F; }
    Extent over(const Bounds&) const override { return {0.0F, 1.0F}; }
    Bounds bounds() const override { return {Vec3(0.0F), Vec3(1.0F)}; }
  };
  const Coefficients dense{Rgb(0.0F), Rgb(1e12F), Rgb(1.0F)};
  const MediumPtr medium = make_varying(volume_of(std::make_shared<Deceiver>(), Vec3i(2)),
                                        FieldPlace({Mat4(1.0F)}), dense, even());
  const Ray ray{Vec3(-1.0F, 0.4F, 0.4F), Vec3(1.0F, 0.0F, 0.0F)};
  EXPECT_EQ(medium->sample(ray, 3.0F, Rgb(1.0F / 3.0F), Vec4(0.5F)).weight, Rgb(0.0F));
  EXPECT_EQ(medium->transmittance(ray, 3.0F, Vec4(0.5F)), Rgb(0.0F));
  EXPECT_GE(medium->emitted(ray, 3.0F, Vec4(0.5F)).x, 0.0F);
}

// A body that moves while the shutter is open takes its density along; a way's length stays that in
// the world, where the body is stretched.
TEST(Varying, TheFieldMovesAndStretchesWithItsBody) {
  const auto field = std::make_shared<EvenDensity>(Bounds{Vec3(0.0F), Vec3(1.0F)}, 1.0F);
  Mat4 opened(1.0F);
  opened[0].x = 4.0F;
  Mat4 closed = opened;
  closed[3].x = 10.0F;
  const Coefficients dye{Rgb(0.5F), Rgb(0.0F), Rgb(0.0F)};
  const MediumPtr medium =
      make_varying(volume_of(field, Vec3i(2)), FieldPlace({opened, closed}), dye, even());
  const auto share = [&](float from, float t_max, float time) {
    const Ray ray{Vec3(from, 0.5F, 0.5F), Vec3(1.0F, 0.0F, 0.0F), kInfinity, time};
    return medium->transmittance(ray, t_max, Vec4(0.5F)).y;
  };
  EXPECT_NEAR(share(-1.0F, kInfinity, 0.0F), std::exp(-2.0F), 1e-6F);
  EXPECT_NEAR(share(-1.0F, 3.0F, 0.0F), std::exp(-1.0F), 1e-6F);
  EXPECT_NEAR(share(5.0F, kInfinity, 0.0F), 1.0F, 1e-6F);
  EXPECT_NEAR(share(5.0F, 2.0F, 0.5F), std::exp(-1.0F), 1e-6F);
  EXPECT_NEAR(share(11.0F, 100.0F, 1.0F), std::exp(-1.5F), 1e-6F);
  Mat4 flat(1.0F);
  flat[1].y = 0.0F;
  const MediumPtr nowhere =
      make_varying(volume_of(field, Vec3i(2)), FieldPlace({flat}), dye, even());
  EXPECT_EQ(nowhere->transmittance({}, 5.0F, Vec4(0.5F)), Rgb(1.0F));
}

}  // namespace
}  // namespace hyades::core
