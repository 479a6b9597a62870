// Small scenes of pbrt look here as pbrt itself shows them.

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <string>

#include "import/pbrt/read_pbrt.h"
#include "tests/import/rendered_scene.h"

namespace hyades::test {
namespace {

constexpr int kBlock = 4;  ///< pixels a side
constexpr int kColumns = 6;
constexpr int kRows = 4;

/// Means of red, green and blue over blocks of a picture of 24 x 16 pixels, from above. Those below
/// are pbrt-v4's (volpath, or path where a scene says so) with 16,384 independent samples of each
/// pixel, which leaves about 0.2 % of noise in a block.
using Blocks = std::array<double, static_cast<size_t>(kColumns* kRows)>;

class OneScene : public core::AssetResolver {
 public:
  explicit OneScene(std::string text)
      : text_(std::make_shared<const std::string>(std::move(text))) {}
  core::Result<core::Bytes> open(const std::string& reference, const std::string&) override {
    if (reference != "scene.pbrt") return core::Error{"there is no '" + reference + "'"};
    return core::Bytes(text_, std::as_bytes(std::span(text_->data(), text_->size())));
  }

 private:
  std::shared_ptr<const std::string> text_;
};

struct Tolerance {
  double mean;   ///< of the picture, relative
  double block;  ///< of each block
};

void expect_as_pbrt(const std::string& name, const std::string& scene, const Blocks& expected,
                    const Tolerance& tolerance) {
  OneScene files(
      "Film \"rgb\" \"integer xresolution\" 24 \"integer yresolution\" 16\nPixelFilter \"box\"\n" +
      scene);
  const auto source = core::read_pbrt(files, "scene.pbrt");
  ASSERT_TRUE(source) << source.error().message;
  const ScenePicture picture = render_scene(**source, {.yaml = "", .samples = 1024}, ".", name);
  double ours = 0.0;
  double theirs = 0.0;
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      const core::Rgb color =
          picture.mean(column * kBlock, row * kBlock, (column + 1) * kBlock, (row + 1) * kBlock);
      const double here = static_cast<double>(color.x + color.y + color.z) / 3.0;
      const double there = expected[static_cast<size_t>(row * kColumns + column)];
      EXPECT_NEAR(here / there, 1.0, tolerance.block) << "row " << row << ", column " << column;
      ours += here;
      theirs += there;
    }
  }
  EXPECT_NEAR(ours / theirs, 1.0, tolerance.mean);
}

TEST(PbrtPictures, CoatsWindowsAndLenses) {
  // The mean is right; rough coats send a little more sideways than they do in pbrt.
  expect_as_pbrt("pbrt-coats", R"(
Integrator "volpath" "integer maxdepth" 6
Scale -1 1 1
LookAt 0 2.2 -5.5  0.4 .8 0  0 1 0
Camera "perspective" "float fov" 40 "float lensradius" .1 "float focaldistance" 5
WorldBegin
AttributeBegin
AreaLightSource "diffuse" "rgb L" [9 9 9]
Shape "trianglemesh" "point3 P" [-1.5 4 -2  .5 4 -2  .5 4 0  -1.5 4 0] "integer indices" [0 1 2 0 2 3]
AttributeEnd
LightSource "infinite" "rgb L" [.25 .25 .25]
Texture "checks" "spectrum" "checkerboard" "float uscale" 6 "float vscale" 4 "rgb tex1" [.7 .7 .7] "rgb tex2" [.2 .2 .2]
Material "diffuse" "texture reflectance" "checks"
Shape "bilinearmesh" "point3 P" [-6 0 -6  6 0 -6  -6 0 6  6 0 6] "point2 uv" [0 0 1 0 0 1 1 1]
Material "coateddiffuse" "rgb reflectance" [.7 .7 .7] "float roughness" .2
AttributeBegin Translate -1.2 1 0 Shape "sphere" AttributeEnd
Material "coateddiffuse" "rgb reflectance" [.9 .9 .9] "float roughness" 0 "float thickness" .05
AttributeBegin Translate 1.2 .8 .5 Rotate 30 0 1 0 Scale .8 .8 .8 Shape "sphere" "float zmax" .5 AttributeEnd
)",
                 {0.2500, 0.2500, 0.2501, 0.2501, 0.2981, 0.2530, 0.2310, 0.2148,
                  0.4085, 0.2348, 0.3845, 0.2165, 0.1635, 0.2165, 0.2606, 0.2007,
                  0.0714, 0.0884, 0.1810, 0.4553, 0.5421, 0.3160, 0.1452, 0.1743},
                 {0.008, 0.08});
}

TEST(PbrtPictures, MetalGlassAndLamps) {
  expect_as_pbrt("pbrt-glass", R"(
Integrator "volpath" "integer maxdepth" 12
LookAt 3 2.2 -4.5  0 .8 0  0 1 0
Camera "perspective" "float fov" 40 "float screenwindow" [-1.2 1.5 -1 .8]
WorldBegin
LightSource "infinite" "rgb L" [1 1 1] "float scale" .4
LightSource "spot" "point3 from" [-2 5 -2] "point3 to" [0 0 0] "float coneangle" 30 "float conedeltaangle" 10 "rgb I" [40 40 40]
LightSource "distant" "point3 from" [1 3 0] "point3 to" [0 0 0] "rgb L" [.5 .5 .5] "float illuminance" .7
Material "diffuse" "rgb reflectance" [.5 .5 .5]
Shape "bilinearmesh" "point3 P" [-6 0 -6  6 0 -6  -6 0 6  6 0 6]
Material "conductor" "spectrum eta" "metal-Al-eta" "spectrum k" "metal-Al-k" "float roughness" .1
AttributeBegin Translate -1 .7 .4 Rotate 90 1 0 0 Shape "cylinder" "float radius" .6 "float zmin" -.7 "float zmax" .7 AttributeEnd
Material "dielectric" "float eta" 1.5 "float roughness" .05
AttributeBegin Translate .8 .7 -.6 Scale .7 .7 .7 Shape "sphere" AttributeEnd
)",
                 {0.3999, 0.3970, 0.3975, 0.4002, 0.3998, 0.3999, 0.3251, 0.3168,
                  0.3226, 0.3252, 0.3360, 0.3451, 0.4092, 0.4447, 0.3225, 0.3039,
                  0.3252, 0.3221, 0.4204, 0.4374, 0.3725, 0.3984, 0.3044, 0.3320},
                 {0.006, 0.025});
}

TEST(PbrtPictures, FogAndSmoke) {
  expect_as_pbrt("pbrt-media", R"(
Integrator "volpath" "integer maxdepth" 20
LookAt 0 1.5 -6  0 1 0  0 1 0
Camera "perspective" "float fov" 35
WorldBegin
LightSource "infinite" "rgb L" [.5 .5 .5]
AttributeBegin
AreaLightSource "diffuse" "rgb L" [1 1 1] "float power" 60
Translate -2 3 0 Shape "sphere" "float radius" .4
AttributeEnd
Material "diffuse" "rgb reflectance" [.6 .6 .6]
Shape "bilinearmesh" "point3 P" [-6 0 -6  6 0 -6  -6 0 6  6 0 6]
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [.1 .1 .1] "rgb sigma_s" [1 1 1] "float scale" 1.5 "float g" .5
AttributeBegin
MediumInterface "fog" ""
Material "interface"
Translate -1 1 0 Shape "sphere" "float radius" .9
AttributeEnd
MakeNamedMedium "smoke" "string type" "uniformgrid" "integer nx" 2 "integer ny" 2 "integer nz" 2 "float density" [0 1 2 1 1 3 1 0] "rgb sigma_a" [.5 .5 .5] "rgb sigma_s" [2 2 2] "point3 p0" [.2 .2 -.6] "point3 p1" [1.6 1.6 .6]
AttributeBegin
MediumInterface "smoke" ""
Material "interface"
Translate .9 .9 0 Scale .65 .65 .55 Shape "trianglemesh" "point3 P" [-1 -1 -1 1 -1 -1 1 1 -1 -1 1 -1 -1 -1 1 1 -1 1 1 1 1 -1 1 1] "integer indices" [0 2 1 0 3 2 4 5 6 4 6 7 0 1 5 0 5 4 2 3 7 2 7 6 1 2 6 1 6 5 0 4 7 0 7 3]
AttributeEnd
)",
                 {1.6956, 0.9427, 0.5002, 0.5003, 0.4997, 0.4999, 0.4999, 0.4739,
                  0.4497, 0.4193, 0.4389, 0.4998, 0.3860, 0.3551, 0.3274, 0.2861,
                  0.2799, 0.3552, 0.3672, 0.3297, 0.3087, 0.2987, 0.2956, 0.3049},
                 {0.004, 0.02});
}

TEST(PbrtPictures, InstancesCutOutsAndMotion) {
  expect_as_pbrt("pbrt-things", R"(
Integrator "path" "integer maxdepth" 5
LookAt 2 3 -6  0 1 0  0 1 0
Camera "perspective" "float fov" 40 "float shutteropen" 0 "float shutterclose" 1
WorldBegin
LightSource "point" "rgb I" [30 30 30] "point3 from" [1 5 -2]
LightSource "infinite" "rgb L" [.3 .3 .3]
Material "diffuse" "rgb reflectance" [.5 .5 .5]
Shape "bilinearmesh" "point3 P" [-6 0 -6  6 0 -6  -6 0 6  6 0 6]
Texture "bars" "float" "checkerboard" "float uscale" 2 "float vscale" 8 "float tex1" 1 "float tex2" 0
Texture "mixed" "spectrum" "mix" "rgb tex1" [.1 .1 .1] "rgb tex2" [.8 .8 .8] "float amount" .3
ObjectBegin "thing"
Material "diffuse" "texture reflectance" "mixed"
Shape "bilinearmesh" "point3 P" [-.5 0 0  .5 0 .4  -.5 1.6 0  .5 1.2 -.4] "texture alpha" "bars"
Material "diffusetransmission" "rgb reflectance" [.3 .3 .3] "rgb transmittance" [.5 .5 .5]
Shape "loopsubdiv" "integer levels" 3 "point3 P" [0 1 0  1 0 0  0 0 1  -1 0 0  0 0 -1  0 -1 0] "integer indices" [0 2 1 0 3 2 0 4 3 0 1 4 5 1 2 5 2 3 5 3 4 5 4 1]
ObjectEnd
AttributeBegin Translate -1.5 .6 0 ObjectInstance "thing" AttributeEnd
AttributeBegin Translate .6 .8 .5 Rotate 70 0 1 0 Scale .7 1.3 .7 ObjectInstance "thing" AttributeEnd
AttributeBegin
ActiveTransform EndTime Translate .8 0 0 ActiveTransform All
Translate .6 .4 -2 
Material "diffuse" "rgb reflectance" [.9 .9 .9]
Shape "disk" "float radius" .4
AttributeEnd
)",
                 {0.3000, 0.3000, 0.3001, 0.2956, 0.2998, 0.2999, 0.2822, 0.2259,
                  0.2445, 0.2662, 0.2681, 0.2751, 0.2181, 0.2258, 0.2527, 0.2461,
                  0.2499, 0.2297, 0.2732, 0.3018, 0.3201, 0.3059, 0.3178, 0.2939},
                 {0.004, 0.02});
}

}  // namespace
}  // namespace hyades::test
