// What becomes of pbrt's scenes in the language of jobs.

#include "tests/import/pbrt_files.h"

namespace hyades::test {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

TEST(PbrtScene, TriangleWithAPictureALampSkyAndFog) {
  core::SceneRequest request;
  request.prefix = "room";
  request.made = "made/";
  request.beside = "../";
  PbrtFiles files(pbrt_world(R"(
    LightSource "infinite" "rgb L" [.1 .2 .3]
    MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [0 .1 .2]
      "rgb sigma_s" [2 2 2] "float g" .5 "float scale" 3
    Texture "wood" "spectrum" "imagemap" "string filename" "textures/wood.png" "float scale" .5
      "string wrap" "clamp" "string filter" "trilinear" "float uscale" 4
    Material "diffuse" "texture reflectance" "wood"
    Shape "trianglemesh" "point3 P" [0 0 0  1 0 0  0 1 0] "point2 uv" [0 0 1 0 0 1]
    AttributeBegin
      AreaLightSource "diffuse" "rgb L" [1 2 3] "float scale" 10
      Translate 0 3 0
      Shape "sphere" "float radius" .5
    AttributeEnd
    AttributeBegin
      Material "interface"
      MediumInterface "fog" ""
      Shape "sphere"
    AttributeEnd)"));
  const PbrtJob job = read_pbrt_job(files, request);
  ASSERT_EQ(job.error, "");
  EXPECT_THAT(job.notes, IsEmpty());
  EXPECT_THAT(job.text, HasSubstr("size: [64, 48]"));
  EXPECT_THAT(job.text, HasSubstr("room.wood:"));
  EXPECT_THAT(job.text, HasSubstr("{type: image, file: ../textures/wood.png, wrap: clamp, "
                                  "scale: [4, 1]}"));
  EXPECT_THAT(job.text, HasSubstr("color: room.wood"));
  EXPECT_THAT(job.text, HasSubstr("mesh: made/meshes/shape-0.ply"));
  EXPECT_THAT(job.text, HasSubstr("emit: {color: [10, 20, 30], radiance: 1}"));
  EXPECT_THAT(job.text, HasSubstr("room.fog: {absorption: [0, 0.1, 0.2], scattering: 2, "
                                  "scale: 3, g: 0.5}"));
  EXPECT_THAT(job.text, HasSubstr("interior: room.fog"));
  EXPECT_THAT(job.text, HasSubstr("environment: {color: [0.1, 0.2, 0.3]}"));
  const auto mesh = pbrt_mesh(job, "meshes/shape-0.ply");
  ASSERT_NE(mesh, nullptr);
  EXPECT_THAT(mesh->uvs, ElementsAre(core::Vec2(0, 0), core::Vec2(1, 0), core::Vec2(0, 1)));
}

TEST(PbrtScene, PicturesAreNotMirrored) {
  // pbrt's cameras have x to the right, y up and z forward: left-handed. The world is mirrored,
  // unless the camera was (as exporters from right-handed programs do).
  const PbrtJob plain = pbrt_job(
      "LookAt 0 0 -5  0 0 0  0 1 0 Camera \"perspective\" WorldBegin "
      "Translate 1 2 3 Shape \"disk\"");
  EXPECT_THAT(plain.text, HasSubstr("look_from: [0, 0, -5]"));
  EXPECT_THAT(plain.text, HasSubstr("[-1, 0, 0, -1, 0, 0, -1, 2, 0, 1, 0, 3, 0, 0, 0, 1]"));
  const PbrtJob turned = pbrt_job(
      "Scale -1 1 1 LookAt 0 0 -5  0 0 0  0 1 0 Camera \"perspective\" "
      "WorldBegin Translate 1 2 3 Shape \"disk\"");
  EXPECT_THAT(turned.text, HasSubstr("look_from: [0, 0, -5]"));
  EXPECT_THAT(turned.text, HasSubstr("[1, 0, 0, 1, 0, 0, -1, 2, 0, 1, 0, 3, 0, 0, 0, 1]"));
  // A panorama's middle is -x and its right -z: right-handed.
  const PbrtJob around = pbrt_job(
      "Camera \"spherical\" \"string mapping\" \"equirectangular\" "
      "WorldBegin Translate 1 2 3 Shape \"disk\"");
  EXPECT_THAT(around.text, HasSubstr("[1, 0, 0, 1, 0, 0, -1, 2, 0, 1, 0, 3, 0, 0, 0, 1]"));
}

TEST(PbrtScene, TheFieldOfViewIsOfTheShorterSide) {
  const auto camera = [](const char* size, const char* more) {
    return pbrt_job(std::string("Film \"rgb\" ") + size + " Camera \"perspective\" " + more +
                    " WorldBegin Shape \"sphere\"")
        .text;
  };
  const char* const kWide = "\"integer xresolution\" 200 \"integer yresolution\" 100";
  const char* const kHigh = "\"integer xresolution\" 100 \"integer yresolution\" 200";
  EXPECT_THAT(camera(kWide, "\"float fov\" 40"), HasSubstr("fov: 40"));
  // tan(v / 2) = 2 tan(20 degrees)
  EXPECT_THAT(camera(kHigh, "\"float fov\" 40"), HasSubstr("fov: 72.1"));
  EXPECT_THAT(camera(kWide, "\"float screenwindow\" [-1 3 0 2]"), HasSubstr("fov: 90"));
  EXPECT_THAT(camera(kWide, "\"float screenwindow\" [-1 3 0 2]"), HasSubstr("shift: [0.25, 0.5]"));
  EXPECT_THAT(camera(kWide, "\"float lensradius\" .1 \"float focaldistance\" 7"),
              HasSubstr("aperture: {radius: 0.1}"));
  EXPECT_THAT(camera(kWide, "\"float lensradius\" .1 \"float focaldistance\" 7"),
              HasSubstr("focus: 7"));
}

TEST(PbrtScene, ARealisticLensBecomesAThinOneOfItsFocalLength) {
  PbrtFiles files(
      "Film \"rgb\" \"integer xresolution\" 300 \"integer yresolution\" 200 \"float diagonal\" 36 "
      "Camera \"realistic\" \"string lensfile\" \"a.dat\" \"float aperturediameter\" 10 "
      "\"float focusdistance\" 2 WorldBegin Shape \"sphere\"");
  // Two faces of 100 mm with nothing between: f = R / (2 (n - 1)) = 100 mm.
  files.add("a.dat", "# lens\n100 0 1.5 30\n0 0 0 10\n-100 90 1 30\n");
  const PbrtJob job = read_pbrt_job(files);
  ASSERT_EQ(job.error, "");
  // Half of the film's height is 36 / sqrt(13) = 9.98 mm.
  EXPECT_THAT(job.text, HasSubstr("fov: 11.4"));
  EXPECT_THAT(job.text, HasSubstr("aperture: {radius: 0.005}"));
  EXPECT_THAT(job.notes, Contains(HasSubstr("a thin lens stands in")));
  files.add("a.dat", "-100 0 1.5 30\n100 0 1 30");
  EXPECT_THAT(read_pbrt_job(files).error, HasSubstr("does not gather light"));
  files.add("a.dat", "1 2 3");
  EXPECT_THAT(read_pbrt_job(files).error, HasSubstr("four numbers"));
}

TEST(PbrtScene, TheFilmsExposureGoesIntoTheLights) {
  const PbrtJob job = pbrt_job(
      "Film \"rgb\" \"float iso\" 50 Camera \"perspective\" \"float shutterclose\" 4 WorldBegin "
      "LightSource \"point\" \"rgb I\" [1 1 2] \"point3 from\" [1 2 3] Shape \"sphere\"");
  EXPECT_THAT(job.text, HasSubstr("color: [2, 2, 4], power: 12.566371"));
  EXPECT_THAT(job.text, HasSubstr("at: [-1, 2, 3]"));
}

TEST(PbrtScene, ObjectsArePlacedManyTimes) {
  const PbrtJob job = pbrt_job(pbrt_world(R"(
    ObjectBegin "tree" Translate 0 1 0 Shape "sphere" Shape "disk" ObjectEnd
    AttributeBegin Translate 5 0 0 ObjectInstance "tree" AttributeEnd
    Scale 2 2 2 ObjectInstance "tree")"));
  ASSERT_EQ(job.error, "");
  EXPECT_THAT(job.text, HasSubstr("groups:\n  tree:"));
  EXPECT_THAT(job.text, HasSubstr("[1, 0, 0, 0, 0, 0, -1, 1, 0, 1, 0, 0, 0, 0, 0, 1]"));
  EXPECT_THAT(job.text, HasSubstr("{instance: tree, transform: [{scale: [-1, 1, 1]}, "
                                  "{translate: [-5, 0, 0]}]}"));
  EXPECT_THAT(job.text, HasSubstr("{instance: tree, transform: [{scale: [-2, 2, 2]}]}"));
}

TEST(PbrtScene, RoughnessIsRemapped) {
  const auto material = [](const char* text) {
    return pbrt_job(pbrt_world(std::string("Material ") + text + " Shape \"sphere\"")).text;
  };
  // alpha = sqrt(0.0625) = 0.25; ours is its root
  EXPECT_THAT(material("\"conductor\" \"float roughness\" .0625"), HasSubstr("roughness: 0.5"));
  EXPECT_THAT(material("\"conductor\" \"float roughness\" .25 \"bool remaproughness\" false"),
              HasSubstr("roughness: 0.5"));
  EXPECT_THAT(material("\"conductor\" \"float roughness\" 0"), Not(HasSubstr("roughness")));
}

TEST(PbrtScene, FacetsAreThoseOfPbrt) {
  const auto material = [](const char* text) {
    return pbrt_job(pbrt_world(std::string("Material ") + text + " Shape \"sphere\"")).text;
  };
  EXPECT_THAT(material("\"dielectric\" \"float roughness\" .1"),
              HasSubstr("multiple_scattering: false"));
}

TEST(PbrtScene, FloatsOfPicturesAreTheirAlphaOrMean) {
  const auto job = [](const std::string& picture, const std::string& more = "") {
    PbrtFiles files(
        pbrt_world("Texture \"t\" \"float\" \"imagemap\" \"string filename\" "
                   "\"t.tga\" " +
                   more +
                   " Material \"diffuse\" \"texture displacement\" \"t\" "
                   "Shape \"sphere\""));
    if (!picture.empty()) files.add("t.tga", picture);
    const PbrtJob made = read_pbrt_job(files);
    return made.error.empty() ? made.text : made.error;
  };
  const std::string color("\0\0\2\0\0\0\0\0\0\0\0\0\1\0\1\0\x18\0\1\2\3", 21);
  const std::string grey("\0\0\2\0\0\0\0\0\0\0\0\0\1\0\1\0\x18\0\2\2\2", 21);
  const std::string clear("\0\0\2\0\0\0\0\0\0\0\0\0\1\0\1\0\x20\x08\1\2\3\4", 22);
  const std::string opaque("\0\0\2\0\0\0\0\0\0\0\0\0\1\0\1\0\x20\x08\2\2\2\xFF", 22);
  EXPECT_THAT(job(grey), HasSubstr("channel: luminance"));
  EXPECT_THAT(job(opaque), HasSubstr("channel: luminance"));
  EXPECT_THAT(job(clear), HasSubstr("channel: alpha"));
  EXPECT_THAT(job(""), HasSubstr("scene.pbrt:5:1: cannot open 't.tga'"));
  const std::string mean = job(color, "\"string encoding\" \"gamma 2\"");
  EXPECT_THAT(mean, HasSubstr("channel: red"));
  EXPECT_THAT(mean, HasSubstr("channel: green"));
  EXPECT_THAT(mean, HasSubstr("factor: 0.33333"));
}

TEST(PbrtScene, CausticsAreLeftToBothEnds) {
  const PbrtJob job =
      pbrt_job("Integrator \"sppm\" \"integer maxdepth\" 7 " + pbrt_world("Shape \"sphere\""));
  EXPECT_THAT(job.text, HasSubstr("integrator: {type: bdpt, max_depth: 7}"));
  EXPECT_THAT(job.notes, Contains(HasSubstr("bidirectional path tracing stands in")));
}

TEST(PbrtScene, SurfacesWithAMediumOutsideOnlyAreTold) {
  const std::string fog = "MakeNamedMedium \"tea\" \"string type\" \"homogeneous\" ";
  const auto notes = [&](const char* interface, const char* material) {
    return pbrt_job(pbrt_world(fog + "MediumInterface " + interface + " Material " + material +
                               " Shape \"sphere\""))
        .notes;
  };
  const auto told = Contains(HasSubstr("'tea' is only outside of this surface"));
  EXPECT_THAT(notes("\"\" \"tea\"", "\"dielectric\""), told);
  EXPECT_THAT(notes("\"tea\" \"\"", "\"dielectric\""), Not(told));
  EXPECT_THAT(notes("\"\" \"tea\"", "\"diffuse\""), Not(told));
}

TEST(PbrtScene, WhatIsLeftOutIsNoted) {
  const PbrtJob job =
      pbrt_job(pbrt_world("Material \"hair\" \"float wetness\" 1\n"
                          "Shape \"sphere\" \"float shininess\" 3"));
  EXPECT_EQ(job.error, "");
  EXPECT_THAT(job.notes, Contains(HasSubstr("scene.pbrt:5:1: hair")));
  EXPECT_THAT(job.notes, Contains("scene.pbrt:5:17: parameter 'float wetness' is left out"));
  EXPECT_THAT(job.notes, Contains("scene.pbrt:6:16: parameter 'float shininess' is left out"));
}

TEST(PbrtScene, AttributesAreForAllThatFollow) {
  const PbrtJob job = pbrt_job(pbrt_world(R"(AttributeBegin
    Attribute "shape" "float radius" 2 Attribute "shape" "float radius" 3
    Shape "sphere" Shape "disk" "float radius" 4
    AttributeEnd Shape "sphere")"));
  EXPECT_THAT(job.text, HasSubstr("radius: 3"));
  EXPECT_THAT(job.text, HasSubstr("radius: 4"));
  EXPECT_THAT(job.text, HasSubstr("radius: 1"));
  EXPECT_THAT(job.text, Not(HasSubstr("radius: 2")));
}

}  // namespace
}  // namespace hyades::test
