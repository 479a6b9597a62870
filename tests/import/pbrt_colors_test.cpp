// Colours and spectra of pbrt's scenes.

#include "core/base/color.h"
#include "import/pbrt/color_space.h"
#include "import/pbrt/smooth_reflectance.h"
#include "import/pbrt/spectra.h"
#include "tests/import/pbrt_files.h"

namespace hyades::test {
namespace {

using namespace core::pbrt;  // NOLINT: what is tested
using core::Rgb;
using core::Vec3d;
using ::testing::HasSubstr;

void expect_near(const Rgb& found, const Rgb& expected, float tolerance) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], tolerance) << c;
}

Spectrum constant(float value) { return *spectrum_of_pairs({300.0F, value, 900.0F, value}); }

TEST(PbrtColors, AConstantReflectanceIsGrey) {
  expect_near(surface_color(constant(0.3F)), Rgb(0.3F), 1e-5F);
}

TEST(PbrtColors, LightHasLuminanceOneWhateverItsNumbers) {
  const Rgb equal = light_color(constant(17.0F));
  EXPECT_NEAR(core::luminance(equal), 1.0F, 1e-3F);
  // Equal energy is x = y = 1/3: redder than D65.
  expect_near(equal, Rgb(1.205F, 0.948F, 0.909F), 0.02F);
}

TEST(PbrtColors, BlackBodies) {
  // The renderer's own are of a fit of the observer, which is a percent or two off.
  for (const float kelvin : {2500.0F, 4000.0F, 6500.0F, 20000.0F}) {
    const Rgb found = blackbody_light(static_cast<double>(kelvin));
    EXPECT_NEAR(core::luminance(found), 1.0F, 1e-3F);
    expect_near(found, core::blackbody_color(kelvin), 0.035F);
  }
  EXPECT_GT(blackbody_light(300.0).x, 1.0F);
}

TEST(PbrtColors, SpacesAreConverted) {
  // ITU-R BT.2087: pure Rec.2020 green lies outside of Rec.709.
  const Rgb green = light_from_rgb(*find_rgb_space("REC2020"), Vec3d(0.0, 1.0, 0.0));
  EXPECT_EQ(green.x, 0.0F);
  EXPECT_NEAR(green.y, 1.1329F, 1e-3F);
  expect_near(light_from_rgb(*find_rgb_space("rec2020"), Vec3d(1.0)), Rgb(1.0F), 1e-5F);
  // Its white is that of D60, which is reddish; surfaces of (1, 1, 1) are white under any light.
  EXPECT_GT(light_from_rgb(*find_rgb_space("aces2065-1"), Vec3d(1.0)).x, 1.02F);
  expect_near(surface_from_rgb(*find_rgb_space("aces2065-1"), Vec3d(0.4)), Rgb(0.4F), 1e-5F);
  EXPECT_EQ(find_rgb_space("xyz"), nullptr);
}

TEST(PbrtColors, NamedSpectra) {
  expect_near(*named_light("stdillum-D65"), Rgb(1.0F), 2e-3F);
  EXPECT_GT(named_light("stdillum-A")->x, 2.0F * named_light("stdillum-A")->z);
  EXPECT_NEAR(*named_glass("glass-BK7"), 1.5168F, 1e-4F);
  EXPECT_TRUE(named_metal("metal-Au-k")->is_k);
  EXPECT_FALSE(named_metal("metal-Xx-k"));
  EXPECT_FALSE(is_named_spectrum("light.spd"));
}

// Mirrors of pbrt under a white sky, by its own pictures.
TEST(PbrtColors, MetalsReflectWhatThoseOfPbrtDo) {
  const auto reflectance = [](const std::string& formula) {
    const Rgb eta = named_metal("metal-" + formula + "-eta")->eta;
    const Rgb k = named_metal("metal-" + formula + "-k")->k;
    return ((eta - 1.0F) * (eta - 1.0F) + k * k) / ((eta + 1.0F) * (eta + 1.0F) + k * k);
  };
  expect_near(reflectance("Ag"), Rgb(0.9719F, 0.9598F, 0.9155F), 1e-3F);
  expect_near(reflectance("Au"), Rgb(0.995F, 0.7824F, 0.3438F), 1e-3F);
  expect_near(reflectance("Cu"), Rgb(0.9556F, 0.6374F, 0.5383F), 1e-3F);
  expect_near(reflectance("CuZn"), Rgb(0.9098F, 0.778F, 0.4233F), 1e-3F);
}

TEST(PbrtColors, SpectraFromFiles) {
  PbrtFiles files(pbrt_world("LightSource \"infinite\" \"spectrum L\" \"a.spd\""));
  files.add("a.spd", "# a lamp\n400 1\n500 2 # more\n700 1");
  EXPECT_THAT(read_pbrt_job(files).text, HasSubstr("environment: {color: ["));
  files.add("a.spd", "400 1 300 2");
  EXPECT_THAT(read_pbrt_job(files).error, HasSubstr("must grow"));
  files.add("a.spd", "400 one");
  EXPECT_THAT(read_pbrt_job(files).error, HasSubstr("1:5: expected a number"));
}

TEST(PbrtColors, MetalsAndTheirReflectance) {
  const auto material = [](const char* text) {
    return pbrt_job(pbrt_world(std::string("Material \"conductor\" ") + text + " Shape \"sphere\""))
        .text;
  };
  EXPECT_THAT(material(""), HasSubstr("eta: [0.39, 0.958, 1.166], k: [5.7"));
  EXPECT_THAT(material("\"spectrum eta\" \"metal-Al-eta\" \"spectrum k\" \"metal-Al-k\""),
              HasSubstr("metal: aluminium"));
  EXPECT_THAT(material("\"spectrum eta\" \"metal-Ag-eta\" \"spectrum k\" \"metal-Ag-k\""),
              HasSubstr("eta: [0.15, 0.13, 0.14], k: [4.4"));
  // k = 2 sqrt(r / (1 - r))
  EXPECT_THAT(material("\"rgb reflectance\" [.5 .5 .5]"), HasSubstr("eta: 1, k: 2"));
}

TEST(PbrtSpectra, SmoothReflectancesLookAsTheyShould) {
  for (const Rgb& color : {Rgb(0.5F), Rgb(0.2F, 0.5F, 0.7F), Rgb(0.8F, 0.3F, 0.1F),
                           Rgb(0.05F, 0.3F, 0.1F), Rgb(0.9F, 0.85F, 0.2F)}) {
    const Spectrum spectrum = smooth_reflectance(color);
    const Rgb seen = surface_color(spectrum);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(seen[c], color[c], 0.004F) << color.x;
    for (const double value : spectrum.values) {
      EXPECT_GE(value, 0.0);
      EXPECT_LE(value, 1.0);
    }
  }
  // The strongest colours have no such spectrum; what comes near is still one.
  for (const Rgb& color : {Rgb(1, 0, 0), Rgb(0, 0, 1), Rgb(1, 1, 0), Rgb(0.0F), Rgb(1.0F)}) {
    const Rgb seen = surface_color(smooth_reflectance(color));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(seen[c], color[c], 0.15F) << color.x << color.z;
  }
}

}  // namespace
}  // namespace hyades::test
