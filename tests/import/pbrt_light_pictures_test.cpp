// Lights of pbrt's scenes that have pictures: skies, goniometric lights and projections.

#include <cmath>
#include <limits>
#include <sstream>

#include "core/image/read_image.h"
#include "core/image/write_image.h"
#include "import/pbrt/panorama.h"
#include "tests/import/pbrt_files.h"

namespace hyades::test {
namespace {

using namespace core::pbrt;  // NOLINT: what is tested
using core::Vec3d;
using ::testing::HasSubstr;

TEST(PbrtSky, TheSquareIsTheSphere) {
  for (const auto& [place, direction] : {std::pair(glm::dvec2(0.5, 0.5), Vec3d(0, 0, 1)),
                                         {{0.0, 0.0}, Vec3d(0, 0, -1)},
                                         {{1.0, 0.5}, Vec3d(1, 0, 0)},
                                         {{0.5, 0.0}, Vec3d(0, -1, 0)}}) {
    EXPECT_NEAR(glm::length(equal_area_direction(place) - direction), 0.0, 1e-9);
  }
  // Equal areas: the mean of z^2 is that of the sphere.
  double mean = 0.0;
  constexpr int kSide = 64;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const glm::dvec2 place((x + 0.5) / kSide, (y + 0.5) / kSide);
      const Vec3d d = equal_area_direction(place);
      EXPECT_NEAR(glm::length(d), 1.0, 1e-9);
      EXPECT_NEAR(glm::length(equal_area_square(d) - place), 0.0, 1e-9);
      mean += d.z * d.z / (kSide * kSide);
    }
  }
  EXPECT_NEAR(mean, 1.0 / 3.0, 1e-3);
}

/// An equal-area picture, red where the light's x is above 0, green where y, blue where z.
std::string octants() {
  core::Image image = core::make_image(32, 32, {"R", "G", "B"});
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) {
      const Vec3d d = equal_area_direction({(x + 0.5) / 32, (y + 0.5) / 32});
      for (int c = 0; c < 3; ++c) image.at(x, y, c) = d[c] > 0.0 ? 1.0F : 0.0F;
    }
  }
  const auto bytes = core::encode_exr(image);
  return {bytes->chars(), bytes->size()};
}

TEST(PbrtSky, PicturesBecomePanoramas) {
  PbrtFiles files(
      pbrt_world("AttributeBegin Rotate 90 0 1 0 LightSource \"infinite\" "
                 "\"string filename\" \"sky.exr\" \"float scale\" 2 AttributeEnd "
                 "LightSource \"infinite\" \"rgb L\" [.5 .5 .5]"));
  files.add("sky.exr", octants());
  core::SceneRequest request;
  request.made = "made/";
  const PbrtJob job = read_pbrt_job(files, request);
  ASSERT_EQ(job.error, "");
  EXPECT_THAT(job.text, HasSubstr("environment: {image: made/sky.exr}"));
  const auto bytes = job.source->made_file("sky.exr");
  ASSERT_TRUE(bytes.ok()) << bytes.error().message;
  const auto image = core::read_image(*bytes, "sky.exr");
  ASSERT_TRUE(image.ok());
  EXPECT_EQ(image->width, 64);
  EXPECT_EQ(image->height, 32);
  // A quarter turn about y brings the light's x to -z and its z to x, and x is mirrored.
  for (const Vec3d d : {Vec3d(0.5, 0.5, 0.7), Vec3d(-0.5, 0.5, 0.7), Vec3d(0.6, -0.5, -0.6)}) {
    const Vec3d world(-d.x, d.y, d.z);
    const Vec3d light(-world.z, world.y, world.x);
    const double u = std::atan2(d.z, d.x) / (2.0 * 3.14159265358979) + 0.5;
    const double v = std::acos(d.y / glm::length(d)) / 3.14159265358979;
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(image->at(static_cast<int>(u * 64), static_cast<int>(v * 32), c),
                  0.5F + (light[c] > 0.0 ? 2.0F : 0.0F), 1e-3F)
          << c;
    }
  }
}

TEST(PbrtSky, IlluminanceIsOfLevelGround) {
  PbrtFiles files(pbrt_world("LightSource \"infinite\" \"rgb L\" [3 3 3] \"float illuminance\" 2"));
  // L = 3 E / pi: as pbrt has it, colours scale what is asked for.
  EXPECT_THAT(read_pbrt_job(files).text, HasSubstr("environment: {color: 1.909859"));
}

TEST(PbrtSky, MissingAndUnfitPictures) {
  PbrtFiles files(pbrt_world("LightSource \"infinite\" \"string filename\" \"sky.exr\""));
  const PbrtJob missing = read_pbrt_job(files);
  EXPECT_THAT(missing.source->made_file("sky.exr").error().message,
              HasSubstr("scene.pbrt:5:1: cannot open 'sky.exr'"));
  core::Image wide = core::make_image(4, 2, {"R", "G", "B"});
  const auto bytes = core::encode_exr(wide);
  files.add("sky.exr", {bytes->chars(), bytes->size()});
  EXPECT_THAT(read_pbrt_job(files).source->made_file("sky.exr").error().message,
              HasSubstr("is not square"));
}

TEST(PbrtPicturedLights, GoniometricPicturesBecomePanoramas) {
  PbrtFiles files(pbrt_world(
      "AttributeBegin Translate 1 2 3 LightSource \"goniometric\" "
      "\"string filename\" \"lamp.exr\" \"float scale\" 2 \"rgb I\" [1 .5 .25] AttributeEnd"));
  // The pole of the picture is the light's y, its y the light's z.
  core::Image lamp = core::make_image(32, 32, {"R", "G", "B"});
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) {
      const Vec3d d = equal_area_direction({(x + 0.5) / 32, (y + 0.5) / 32});
      lamp.at(x, y, 0) = d.x > 0.0 ? 3.0F : 0.0F;
      lamp.at(x, y, 1) = d.y > 0.0 ? 6.0F : 0.0F;
      lamp.at(x, y, 2) = d.z > 0.0 ? 12.0F : 0.0F;
    }
  }
  const auto encoded = core::encode_exr(lamp);
  files.add("lamp.exr", {encoded->chars(), encoded->size()});
  core::SceneRequest request;
  request.made = "made/";
  const PbrtJob job = read_pbrt_job(files, request);
  ASSERT_EQ(job.error, "");
  EXPECT_THAT(job.text, HasSubstr("type: point"));
  EXPECT_THAT(job.text, HasSubstr("at: [-1, 2, 3]"));
  EXPECT_THAT(job.text, HasSubstr("image: made/lights/0.exr"));
  const auto bytes = job.source->made_file("lights/0.exr");
  ASSERT_TRUE(bytes.ok()) << bytes.error().message;
  const auto image = core::read_image(*bytes, "0.exr");
  ASSERT_TRUE(image.ok());
  EXPECT_EQ(image->width, 64);
  // Each octant is as bright as it has positive coordinates; x is mirrored, the picture's pole is
  // y.
  for (const Vec3d d : {Vec3d(0.5, 0.5, 0.7), Vec3d(-0.5, 0.5, 0.7), Vec3d(-0.6, -0.5, -0.6),
                        Vec3d(-0.6, 0.5, -0.6), Vec3d(0.6, -0.5, 0.6)}) {
    const float mean =
        (d.x < 0.0 ? 1.0F : 0.0F) + (d.z > 0.0 ? 2.0F : 0.0F) + (d.y > 0.0 ? 4.0F : 0.0F);
    const double u = std::atan2(d.z, d.x) / (2.0 * 3.14159265358979) + 0.5;
    const double v = std::acos(d.y / glm::length(d)) / 3.14159265358979;
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(image->at(static_cast<int>(u * 64), static_cast<int>(v * 32), c), mean, 1e-3F);
    }
  }
  EXPECT_FALSE(job.source->made_file("lights/1.exr").ok());
  EXPECT_FALSE(job.source->made_file("lights/0.exrx").ok());
}

/// Numbers after `key` in a job's text.
std::vector<double> numbers_after(const std::string& text, const std::string& key) {
  std::vector<double> found;
  const size_t at = text.find(key);
  if (at == std::string::npos) return found;
  std::string numbers = text.substr(at + key.size(), text.find('\n', at) - at - key.size());
  for (char& c : numbers) {
    if (c == '[' || c == ']' || c == ',' || c == '}') c = ' ';
  }
  std::istringstream in(numbers);
  for (double x = 0.0; in >> x;) found.push_back(x);
  return found;
}

TEST(PbrtPicturedLights, PowerIsWhatTheirPicturesLetThrough) {
  PbrtFiles lamp(
      pbrt_world("LightSource \"goniometric\" \"string filename\" \"lamp.exr\" "
                 "\"float power\" 10"));
  core::Image grey = core::make_image(4, 4, {"Y"});
  grey.data.assign(grey.data.size(), 0.25F);
  const auto pixels = core::encode_exr(grey);
  lamp.add("lamp.exr", {pixels->chars(), pixels->size()});
  const std::vector<double> color = numbers_after(read_pbrt_job(lamp).text, "color: ");
  ASSERT_FALSE(color.empty());
  EXPECT_NEAR(color[0], 10.0 / (4.0 * M_PI * 0.25), 1e-3);
  // White and 90 degrees: a side of a cube, a sixth of the sphere.
  PbrtFiles film(
      pbrt_world("LightSource \"projection\" \"string filename\" \"film.exr\" "
                 "\"float power\" 10"));
  core::Image white = core::make_image(64, 64, {"R", "G", "B"});
  white.data.assign(white.data.size(), 1.0F);
  const auto bytes = core::encode_exr(white);
  film.add("film.exr", {bytes->chars(), bytes->size()});
  const PbrtJob job = read_pbrt_job(film);
  ASSERT_EQ(job.error, "");
  const std::vector<double> through = numbers_after(job.text, "color: ");
  ASSERT_FALSE(through.empty());
  EXPECT_NEAR(through[0], 10.0 / (4.0 * M_PI / 6.0), 2e-3);
}

TEST(PbrtPicturedLights, PowerLeavesOutWhatIsNoLight) {
  core::Image picture = core::make_image(8, 8, {"R", "G", "B"});
  picture.data.assign(picture.data.size(), 1.0F);
  const auto color_of_film = [&] {
    PbrtFiles film(
        pbrt_world("LightSource \"projection\" \"string filename\" \"film.exr\" "
                   "\"float power\" 10"));
    const auto bytes = core::encode_exr(picture);
    film.add("film.exr", {bytes->chars(), bytes->size()});
    const PbrtJob job = read_pbrt_job(film);
    EXPECT_EQ(job.error, "");
    return std::pair(numbers_after(job.text, "color: ").at(0), job.notes);
  };
  const double clean = color_of_film().first;
  picture.at(4, 4, 1) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_NEAR(color_of_film().first / clean, 1.0, 0.05);
  picture.data.assign(picture.data.size(), -1.0F);
  EXPECT_THAT(color_of_film().second, testing::ElementsAre(HasSubstr("its power is left out")));
}

TEST(PbrtPicturedLights, LightsOfOnePictureShareIt) {
  std::string lights;
  for (const char* turn : {"Translate 1 0 0", "Translate 2 0 0", "Rotate 90 0 1 0"}) {
    lights += std::string("AttributeBegin ") + turn +
              " LightSource \"goniometric\" \"string filename\" \"lamp.exr\" AttributeEnd\n";
  }
  PbrtFiles files(pbrt_world(lights));
  files.add("lamp.exr", octants());
  const std::string text = read_pbrt_job(files).text;
  EXPECT_THAT(text, HasSubstr("lights/0.exr"));
  EXPECT_THAT(text, testing::Not(HasSubstr("lights/1.exr")));
  EXPECT_THAT(text, HasSubstr("lights/2.exr"));
}

TEST(PbrtPicturedLights, ProjectionsBecomeProjectors) {
  core::Image white = core::make_image(2, 1, {"R", "G", "B"});
  const auto bytes = core::encode_exr(white);
  const auto job_of = [&](const std::string& transform) {
    PbrtFiles files(pbrt_world("AttributeBegin " + transform +
                               " LightSource \"projection\" \"string filename\" \"film.exr\" "
                               "\"float fov\" 30 AttributeEnd"));
    files.add("film.exr", {bytes->chars(), bytes->size()});
    core::SceneRequest request;
    request.beside = "there/";
    return read_pbrt_job(files, request);
  };
  const PbrtJob plain = job_of("Translate 1 2 3");
  ASSERT_EQ(plain.error, "");
  EXPECT_THAT(plain.text, HasSubstr("type: projector"));
  EXPECT_THAT(plain.text, HasSubstr("image: there/film.exr"));
  EXPECT_THAT(plain.text, HasSubstr("at: [-1, 2, 3]"));
  EXPECT_THAT(plain.text, HasSubstr("look_at: [-1, 2, 4]"));
  EXPECT_THAT(plain.text, HasSubstr("fov: 30"));
  EXPECT_THAT(plain.notes, testing::IsEmpty());
  // A transform that mirrors shows the picture the other way round.
  EXPECT_THAT(job_of("Scale -1 1 1").text, HasSubstr("transform: [{scale: [-1, 1, 1]}]"));
  EXPECT_THAT(job_of("Scale 1 2 1").notes, testing::ElementsAre(HasSubstr("only turned")));
}

TEST(PbrtPicturedLights, MissingPicturesAreTold) {
  PbrtFiles none(pbrt_world("LightSource \"projection\""));
  EXPECT_THAT(read_pbrt_job(none).error,
              HasSubstr("scene.pbrt:5:1: a projection has no 'filename'"));
  for (const std::string type : {"projection", "goniometric"}) {
    PbrtFiles gone(pbrt_world("LightSource \"" + type + "\" \"string filename\" \"missing.exr\""));
    EXPECT_THAT(read_pbrt_job(gone).error, HasSubstr("scene.pbrt:5:1: cannot open 'missing.exr'"));
  }
}

}  // namespace
}  // namespace hyades::test
