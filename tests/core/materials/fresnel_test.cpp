#include "core/materials/fresnel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>

#include "core/materials/make_material.h"

namespace hyades::core {
namespace {

/// Fresnel's equations as every textbook has them, with complex numbers in double.
double reference(double cos_i, std::complex<double> index) {
  const std::complex<double> cos_t = std::sqrt(1.0 - (1.0 - cos_i * cos_i) / (index * index));
  const std::complex<double> s = (cos_i - index * cos_t) / (cos_i + index * cos_t);
  const std::complex<double> p = (index * cos_i - cos_t) / (index * cos_i + cos_t);
  return 0.5 * (std::norm(s) + std::norm(p));
}

TEST(Fresnel, DielectricMatchesTheTextbookAtAllAngles) {
  for (const float eta : {1.0F, 1.33F, 1.5F, 2.4F, 1.0F / 1.5F}) {
    for (int i = 0; i <= 200; ++i) {
      const float cos_i = static_cast<float>(i) / 200.0F;
      const double sin2_t = (1.0 - double(cos_i) * cos_i) / (double(eta) * eta);
      const auto f = fresnel_dielectric(cos_i, eta);
      if (sin2_t > 1.0 + 1e-6) {
        EXPECT_EQ(f.reflectance, 1.0F);
      } else if (sin2_t < 1.0 - 1e-6) {
        EXPECT_NEAR(f.reflectance, i == 0 && eta == 1.0F ? 1.0 : reference(cos_i, double(eta)),
                    2e-6)
            << eta << " " << cos_i;
        EXPECT_NEAR(f.cos_t, std::sqrt(1.0 - sin2_t), 1e-6) << eta << " " << cos_i;
      }
    }
  }
}

TEST(Fresnel, DielectricKnownPoints) {
  EXPECT_NEAR(fresnel_dielectric(1.0F, 1.5F).reflectance, 0.04F, 1e-7F);
  EXPECT_NEAR(fresnel_dielectric(1.0F, 1.0F / 1.5F).reflectance, 0.04F, 1e-7F);
  // Brewster's angle: only s-polarised light is reflected, ((eta^2 - 1) / (eta^2 + 1))^2 of it.
  const float brewster = 1.0F / std::sqrt(1.0F + 1.5F * 1.5F);
  const float s = (1.5F * 1.5F - 1.0F) / (1.5F * 1.5F + 1.0F);
  EXPECT_NEAR(fresnel_dielectric(brewster, 1.5F).reflectance, 0.5F * s * s, 1e-6F);
  EXPECT_EQ(fresnel_dielectric(0.0F, 1.5F).reflectance, 1.0F);
  for (float c = 0.01F; c < 1.0F; c += 0.01F) {
    EXPECT_LT(fresnel_dielectric(c, 1.0F).reflectance, 1e-13F) << c;
    EXPECT_NEAR(fresnel_dielectric(c, 1.0F).cos_t, c, 1e-7F);
  }
}

// The same light path backwards: entering at theta_i and leaving at theta_t reflect alike.
TEST(Fresnel, DielectricIsTheSameFromBothSides) {
  for (float c = 0.05F; c <= 1.0F; c += 0.05F) {
    const auto in = fresnel_dielectric(c, 1.5F);
    const auto out = fresnel_dielectric(in.cos_t, 1.0F / 1.5F);
    EXPECT_NEAR(in.reflectance, out.reflectance, 2e-5F);
    EXPECT_NEAR(out.cos_t, c, 1e-5F);
  }
}

TEST(Fresnel, ConductorMatchesComplexArithmetic) {
  for (const float eta : {0.04F, 0.2F, 1.0F, 1.5F, 3.0F}) {
    for (const float k : {0.0F, 1e-3F, 0.5F, 2.0F, 7.0F}) {
      for (int i = 1; i <= 100; ++i) {
        const float cos_i = static_cast<float>(i) / 100.0F;
        EXPECT_NEAR(fresnel_conductor(cos_i, eta, k),
                    reference(cos_i, std::complex<double>(eta, k)), 1e-5)
            << eta << " " << k << " " << cos_i;
      }
      EXPECT_EQ(fresnel_conductor(0.0F, eta, k), 1.0F);
    }
  }
}

// Colours in linear Rec.709 that others measured or computed for daylight; the spread between
// sources is about 0.03.
TEST(Metals, NormalReflectanceHasTheKnownColours) {
  const struct {
    const char* name;
    Rgb color;
    float tolerance;
  } known[] = {
      {"gold", {1.00F, 0.77F, 0.34F}, 0.05F},       {"silver", {0.97F, 0.96F, 0.94F}, 0.05F},
      {"copper", {0.955F, 0.638F, 0.538F}, 0.03F},  {"aluminium", {0.913F, 0.921F, 0.925F}, 0.015F},
      {"chromium", {0.55F, 0.556F, 0.554F}, 0.01F}, {"iron", {0.53F, 0.513F, 0.494F}, 0.01F},
      {"nickel", {0.69F, 0.64F, 0.563F}, 0.03F},    {"titanium", {0.617F, 0.58F, 0.542F}, 0.01F},
      {"platinum", {0.675F, 0.64F, 0.585F}, 0.02F}, {"tungsten", {0.505F, 0.497F, 0.477F}, 0.01F},
      {"cobalt", {0.68F, 0.655F, 0.615F}, 0.03F},
  };
  for (const auto& metal : known) {
    const auto index = find_metal(metal.name);
    ASSERT_TRUE(index) << metal.name;
    const Rgb r = fresnel_conductor(1.0F, index->eta, index->k);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(r[c], metal.color[c], metal.tolerance) << metal.name;
  }
}

TEST(Metals, TableIsSortedAndPhysical) {
  const auto names = metal_names();
  EXPECT_GE(names.size(), 10U);
  EXPECT_TRUE(std::is_sorted(names.begin(), names.end()));
  for (const std::string& name : names) {
    const auto index = find_metal(name);
    ASSERT_TRUE(index);
    EXPECT_EQ(index->name, name);
    EXPECT_GT(min_component(index->eta), 0.0F);
    EXPECT_GT(min_component(index->k), 0.0F);
  }
  EXPECT_FALSE(find_metal("unobtainium"));
}

}  // namespace
}  // namespace hyades::core
