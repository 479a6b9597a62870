#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/materials/dielectric_energy.h"
#include "core/materials/interface_energy.h"
#include "import/pbrt/layer_walk.h"
#include "tests/import/pbrt_files.h"

namespace hyades::core::pbrt {
namespace {

using test::pbrt_job;
using test::pbrt_world;
using ::testing::HasSubstr;

constexpr int kWalks = 1 << 16;
// Of diffuse light, a smooth surface of index 1.5 reflects 0.0918 from above and 0.596 from below
// (Egan and Hilgeman 1973, "Optical Properties of Inhomogeneous Materials").
constexpr double kAbove = 0.0918;
constexpr double kBelow = 0.5963;

double to_and_fro(double r, int times) {
  double sum = 0.0;
  double term = (1.0 - kAbove) * r * (1.0 - kBelow);
  for (int i = 0; i < times; ++i, term *= r * kBelow) sum += term;
  return sum;
}

TEST(PbrtLayer, SmoothClearOnesAreAsInClosedForm) {
  const LayerAnswer whole({.thickness = 0.0F, .events = 100}, kWalks);
  for (const double r : {0.2, 0.5, 0.9}) {
    EXPECT_NEAR(whole.share(static_cast<float>(r), 0.0F), to_and_fro(r, 100), 0.002) << r;
  }
  // What goes down must come up.
  EXPECT_NEAR(whole.share(1.0F, 0.0F), 1.0 - kAbove, 0.002);
  EXPECT_NEAR(whole.once(0.0F), to_and_fro(1.0, 1), 0.002);
  EXPECT_EQ(whole.scattered_only(0.0F), 0.0F);
}

TEST(PbrtLayer, WalksEndWherePbrtEndsThem) {
  // Ten events: down to the base and up to the surface five times.
  const LayerAnswer ten({.thickness = 0.0F, .events = 10}, kWalks);
  EXPECT_NEAR(ten.share(0.9F, 0.0F), to_and_fro(0.9, 5), 0.002);
  const LayerAnswer three({.thickness = 0.0F, .events = 3}, kWalks);
  EXPECT_NEAR(three.share(0.9F, 0.0F), to_and_fro(0.9, 1), 0.002);
}

TEST(PbrtLayer, WhatIsBetweenAbsorbsOrScatters) {
  const CoatLayer thick{.eta = 1.0F, .thickness = 0.3F, .events = 100};
  // 2 E3(0.3), the part of diffuse light that crosses a slab that absorbs 0.3 free paths
  // (Abramowitz and Stegun 1964, section 5.1), by quadrature.
  constexpr double kAcross = 0.60008;
  EXPECT_NEAR(LayerAnswer(thick, kWalks).share(1.0F, 0.0F), kAcross * kAcross, 0.003);
  CoatLayer fog = thick;
  fog.scatters = true;
  const LayerAnswer answer(fog, kWalks);
  EXPECT_NEAR(answer.share(1.0F, 0.0F), kAcross * kAcross, 0.01);
  EXPECT_NEAR(answer.share(1.0F, 1.0F), 1.0, 0.005);
  EXPECT_GT(answer.scattered_only(1.0F), 0.1F);
}

TEST(PbrtLayer, RoughFacetsLoseWhatTheyThrowOntoEachOther) {
  constexpr float kAlpha = 0.45F;
  const LayerAnswer rough({.alpha = kAlpha, .thickness = 0.0F, .events = 100}, kWalks);
  // The tables of our own rough glass: what is neither reflected nor lost goes through.
  const auto through = [](float eta) {
    return InterfaceEnergy(eta).mean_rest(kAlpha) - DielectricEnergy(eta).mean_loss(kAlpha);
  };
  const float down = through(1.5F);
  const float up = through(1.0F / 1.5F);
  EXPECT_NEAR(rough.once(0.0F), down * up, 0.003F);
  const float back = 1.0F - InterfaceEnergy(1.0F / 1.5F).mean_rest(kAlpha);
  EXPECT_NEAR(rough.share(0.9F, 0.0F), down * up * 0.9F / (1.0F - 0.9F * back), 0.005F);
}

TEST(PbrtLayer, ColorsBelowCoatsAreThoseOfTheWalk) {
  const auto material = [](const char* text) {
    return pbrt_job(pbrt_world(std::string("Material ") + text + " Shape \"sphere\"")).text;
  };
  // A little below (1 - 0.596) 0.5 / (1 - 0.596 * 0.5) = 0.288: the layer absorbs.
  EXPECT_THAT(material("\"coateddiffuse\""), HasSubstr("color: 0.27"));
  EXPECT_THAT(material("\"coateddiffuse\" \"float thickness\" 0 \"integer maxdepth\" 100"),
              HasSubstr("color: 0.28"));
  // Red by red alone would be 0.859: a spectrum that looks so is not 1 for all of red.
  EXPECT_THAT(material("\"coateddiffuse\" \"rgb reflectance\" [1 .378676 .013473]"),
              HasSubstr("color: [0.73"));
  EXPECT_THAT(material("\"coateddiffuse\" \"rgb reflectance\" [0 0 0]"), HasSubstr("color: 0}"));
  EXPECT_THAT(material("\"coateddiffuse\" \"rgb reflectance\" [0 0 0] \"rgb albedo\" [0 1 0]"
                       " \"float thickness\" 1"),
              HasSubstr("color: [0, 0."));
}

}  // namespace
}  // namespace hyades::core::pbrt
