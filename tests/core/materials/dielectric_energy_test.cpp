#include "core/materials/dielectric_energy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <thread>
#include <vector>

#include "core/materials/fresnel.h"
#include "core/materials/local.h"
#include "tests/support/random.h"

namespace hyades::core {
namespace {

constexpr float kIndices[] = {0.34F, 0.4F,  0.67F, 0.8F, 0.95F, 0.99F,
                              1.01F, 1.07F, 1.33F, 1.5F, 2.5F};
constexpr float kAlphas[] = {0.05F, 0.09F, 0.23F, 0.36F, 0.55F, 1.0F};

Vec3 at_cosine(float cosine) { return {std::sqrt(1.0F - cosine * cosine), 0.0F, cosine}; }

/// E by 16,384 strata: within 3e-4.
double exact(float cosine, float alpha, float eta) {
  constexpr int kSide = 128;
  const Ggx facets{alpha};
  const Vec3 wo = at_cosine(cosine);
  test::Random random(7);
  double sum = 0.0;
  for (int n = 0; n < kSide * kSide; ++n) {
    const Vec2 u((static_cast<float>(n % kSide) + random.uniform()) / kSide,
                 (static_cast<float>(n / kSide) + random.uniform()) / kSide);
    const Vec3 m = facets.sample_normal(wo, glm::min(u, Vec2(0x1.fffffep-1F)));
    const float o_m = std::clamp(glm::dot(wo, m), 0.0F, 1.0F);
    const auto [reflectance, cos_t] = fresnel_dielectric(o_m, eta);
    const Vec3 back = reflected(wo, m);
    if (back.z > 0.0F) sum += reflectance * facets.reflect_weight(wo, back);
    const Vec3 through = (o_m / eta - cos_t) * m - wo / eta;
    if (reflectance < 1.0F && through.z < 0.0F) {
      sum += (1.0F - reflectance) * facets.reflect_weight(wo, above(through));
    }
  }
  return sum / (kSide * kSide);
}

TEST(DielectricEnergy, TablesAreTheIntegralOfTheLobes) {
  for (const float eta : kIndices) {
    const DielectricEnergy energy(eta);
    double sum = 0.0;
    double squares = 0.0;
    int count = 0;
    for (const float alpha : kAlphas) {
      for (const float cosine : {0.03F, 0.1F, 0.17F, 0.31F, 0.45F, 0.62F, 0.77F, 0.9F, 1.0F}) {
        const double error = energy.reflectance(cosine, alpha) - exact(cosine, alpha, eta);
        EXPECT_NEAR(error, 0.0, 0.009) << eta << " " << alpha << " " << cosine;
        sum += error;
        squares += error * error;
        ++count;
      }
    }
    EXPECT_NEAR(sum / count, 0.0, 0.001) << eta;
    EXPECT_LT(std::sqrt(squares / count), 0.002) << eta;
  }
}

/// What `lost` gives back of light to `wo`, above or below, by quadrature over the cosine.
double given_back(const LostGlassLight& lost, const Vec3& wo) {
  constexpr int kSteps = 4000;
  double sum = 0.0;
  for (int n = 0; n < kSteps; ++n) {
    // Even in the root of the cosine, which grazing directions need.
    const float root = (static_cast<float>(n) + 0.5F) / kSteps;
    const Vec3 wi = at_cosine(root * root);
    const float width = 2.0F * root / kSteps * 2.0F * kPi;
    sum += (lost.evaluate(wo, wi).x + lost.evaluate(wo, -wi).x) * width;
  }
  return sum;
}

// The lobes give back what is missing, whatever the roughness and the indices on both sides.
TEST(LostGlassLight, GivesBackWhatIsMissing) {
  for (const float eta : kIndices) {
    for (const float alpha : kAlphas) {
      const LostGlassLight lost(eta, alpha, Rgb(1.0F), Rgb(1.0F));
      double lost_or_won = 0.0;
      int count = 0;
      for (const float cosine : {0.05F, 0.2F, 0.4F, 0.6F, 0.8F, 0.97F}) {
        for (const Vec3& wo : {at_cosine(cosine), -at_cosine(cosine)}) {
          EXPECT_NEAR(given_back(lost, wo), lost.part(wo), 2e-3 * lost.part(wo) + 1e-5)
              << eta << " " << alpha << " " << wo.z;
          EXPECT_GE(lost.reflected_share(wo), 0.0F);
          EXPECT_LE(lost.reflected_share(wo), 1.0F);
          const double single = exact(cosine, alpha, wo.z > 0.0F ? eta : 1.0F / eta);
          lost_or_won += 2.0 * cosine * (single + given_back(lost, wo) - 1.0);
          ++count;
        }
      }
      EXPECT_NEAR(lost_or_won / count, 0.0, 0.003) << eta << " " << alpha;
    }
  }
}

// As importance: f / eta_i^2 is symmetric.
TEST(LostGlassLight, IsReciprocalWithTints) {
  test::Random random(3);
  for (const float eta : kIndices) {
    const LostGlassLight lost(eta, 0.4F, {0.9F, 0.5F, 0.2F}, {0.3F, 0.6F, 1.0F});
    for (int n = 0; n < 100; ++n) {
      const Vec3 a = random.direction();
      const Vec3 b = random.direction();
      const auto eta2 = [&](const Vec3& w) { return w.z > 0.0F ? 1.0F : eta * eta; };
      const Rgb forth = lost.evaluate(a, b) / (std::fabs(b.z) * eta2(b));
      const Rgb back = lost.evaluate(b, a) / (std::fabs(a.z) * eta2(a));
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(forth[k], back[k], 1e-4F * forth[k] + 1e-9F);
    }
  }
}

TEST(LostGlassLight, KeepsToTheTints) {
  const Vec3 up(0.0F, 0.0F, 1.0F);
  const LostGlassLight opaque(1.5F, 0.5F, Rgb(0.0F), Rgb(1.0F));
  EXPECT_EQ(opaque.evaluate(up, -up), Rgb(0.0F));
  EXPECT_GT(opaque.evaluate(up, up).x, 0.0F);
  const LostGlassLight clear(1.5F, 0.5F, Rgb(1.0F), Rgb(1.0F));
  const LostGlassLight red(1.5F, 0.5F, {1.0F, 0.5F, 0.0F}, Rgb(1.0F));
  for (const Vec3& wo : {up, -up}) {
    EXPECT_NEAR(red.evaluate(wo, -wo).x, clear.evaluate(wo, -wo).x, 1e-6F);
    EXPECT_LT(red.evaluate(wo, -wo).y, 0.5F * clear.evaluate(wo, -wo).y);
    EXPECT_LT(red.evaluate(wo, wo).y, clear.evaluate(wo, wo).y);
    EXPECT_EQ(red.evaluate(wo, -wo).z, 0.0F);
  }
}

// Smooth facets lose nothing; neither do facets of equal indices where all goes on (the material
// needs no lobe then).
TEST(LostGlassLight, IsNothingForSmoothFacets) {
  const LostGlassLight lost(1.5F, 1e-4F, Rgb(1.0F), Rgb(1.0F));
  for (const float cosine : {0.1F, 0.5F, 1.0F}) {
    EXPECT_LT(lost.part(at_cosine(cosine)), 1e-3F);
    EXPECT_LT(lost.part(-at_cosine(cosine)), 1e-3F);
  }
}

TEST(DielectricEnergy, IsTheSameForAllThreadsThatAskFirst) {
  std::vector<float> found(8);
  std::vector<std::thread> threads;
  for (size_t n = 0; n < found.size(); ++n) {
    // Indices that no other test asks for.
    threads.emplace_back(
        [&found, n] { found[n] = DielectricEnergy(1.77F).reflectance(0.3F, 0.4F); });
  }
  for (std::thread& thread : threads) thread.join();
  for (const float value : found) EXPECT_EQ(value, found[0]);
  EXPECT_GT(found[0], 0.5F);
}

}  // namespace
}  // namespace hyades::core
