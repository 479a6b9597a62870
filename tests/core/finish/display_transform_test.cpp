#include "core/finish/display_transform.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <limits>

#include "core/finish/picture.h"
#include "core/image/read_image.h"
#include "core/job/ocio_files.h"
#include "tests/support/temp_folder.h"

namespace hyades::core {
namespace {

// Plain swaps red and blue; Bent squeezes by a file (half the light is a quarter) after a look that
// doubles red and halves blue.
constexpr const char* kConfig = R"(ocio_profile_version: 2
search_path: luts
roles: {scene_linear: light, default: light}
displays:
  Screen:
    - !<View> {name: Plain, colorspace: swapped}
    - !<View> {name: Bent, colorspace: bent, looks: warm}
  sRGB screen:
    - !<View> {name: As it is, colorspace: light}
looks:
  - !<Look>
    name: warm
    process_space: light
    transform: !<MatrixTransform> {matrix: [2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 1]}
  - !<Look>
    name: dim
    process_space: light
    transform: !<MatrixTransform> {matrix: [0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 1]}
colorspaces:
  - !<ColorSpace> {name: light}
  - !<ColorSpace>
    name: swapped
    from_scene_reference: !<MatrixTransform> {matrix: [0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1]}
  - !<ColorSpace>
    name: bent
    from_scene_reference: !<FileTransform> {src: bent.spi1d, interpolation: linear}
  - !<ColorSpace>
    name: half of light
    to_scene_reference: !<MatrixTransform> {matrix: [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1]}
)";

class Display : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directory(folder_.file("luts"));
    write("luts/bent.spi1d",
          "Version 1\nFrom 0.0 1.0\nLength 3\nComponents 1\n{\n0.0\n0.25\n1.0\n}\n");
    write("config.ocio", kConfig);
    const auto opened = open({});
    if (!opened && opened.error().message.find("built without") != std::string::npos) {
      GTEST_SKIP() << opened.error().message;
    }
    ASSERT_TRUE(opened.ok()) << opened.error().message;
  }
  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_.file(name)) << text;
  }
  Result<std::shared_ptr<const DisplayTransform>> open(ColorDesc color) {
    color.config = "config.ocio";
    return open_display_transform(folder_.file("config.ocio"), color);
  }
  ColorDesc names(std::initializer_list<const char*> four) {
    std::vector<std::string> list(four.begin(), four.end());
    list.resize(4);
    ColorDesc color;
    color.display = list[0];
    color.view = list[1];
    color.look = list[2];
    color.working_space = list[3];
    return color;
  }
  std::string complaint(std::initializer_list<const char*> four) {
    const auto opened = open(names(four));
    EXPECT_FALSE(opened.ok());
    return opened.ok() ? "" : opened.error().message;
  }
  void expect(std::initializer_list<const char*> four, const Rgb& light, const Rgb& shown) {
    const auto opened = open(names(four));
    ASSERT_TRUE(opened.ok()) << opened.error().message;
    Image image = make_image(2, 1, {"R", "G", "B"});
    for (int i = 0; i < 6; ++i) image.data[static_cast<size_t>(i)] = light[i % 3];
    (*opened)->apply(image);
    for (int i = 0; i < 6; ++i) {
      EXPECT_NEAR(image.data[static_cast<size_t>(i)], shown[i % 3], 1e-4) << i;
    }
  }

  test::TempFolder folder_;
};

TEST_F(Display, MatricesFilesAndLooksByHand) {
  expect({}, {0.1F, 0.2F, 0.7F}, {0.7F, 0.2F, 0.1F});
  expect({"Screen", "Plain"}, {0.1F, 0.2F, 0.7F}, {0.7F, 0.2F, 0.1F});
  // After the look: 0.25, 0.75, 0.5.
  expect({"Screen", "Bent"}, {0.125F, 0.75F, 1.0F}, {0.125F, 0.625F, 0.25F});
  // Another look takes the place of the view's own, or both follow each other.
  expect({"Screen", "Bent", "dim"}, {0.5F, 1.0F, 0.25F}, {0.125F, 0.25F, 0.0625F});
  expect({"Screen", "Bent", "warm, dim"}, {0.5F, 1.0F, 1.0F}, {0.25F, 0.25F, 0.125F});
  // Light as it is in another space is twice what its numbers say.
  expect({"sRGB screen", "As it is", "", "half of light"}, {0.1F, 0.2F, 0.3F}, {0.2F, 0.4F, 0.6F});
}

TEST_F(Display, WhereTheConfigSaysWhatItsNumbersMeanLightIsConverted) {
  std::string aces = kConfig;
  aces.replace(aces.find("default: light"), 14, "default: light, aces_interchange: light");
  write("config.ocio", aces);
  // Rec.709's red and white in ACES2065-1 (by Bradford's adaptation, as ACES has it).
  expect({"sRGB screen", "As it is"}, {1, 0, 0}, {0.43963F, 0.08978F, 0.01754F});
  expect({"sRGB screen", "As it is"}, {0.5F, 0.5F, 0.5F}, {0.5F, 0.5F, 0.5F});
}

TEST_F(Display, UnknownNamesListWhatThereIs) {
  EXPECT_EQ(complaint({"Scren"}),
            "config.ocio: color.display is 'Scren', which the configuration has not; it has Screen "
            "or sRGB screen, did you mean 'Screen'?");
  EXPECT_EQ(complaint({"Screen", "Fancy"}),
            "config.ocio: display 'Screen': color.view is 'Fancy', which the configuration has "
            "not; it has Plain or Bent");
  EXPECT_EQ(complaint({"", "", "+warm, -cold"}),
            "config.ocio: color.look is 'cold', which the configuration has not; it has warm or "
            "dim");
  const std::string space = complaint({"", "", "", "nowhere"});
  EXPECT_NE(space.find("color.working_space is 'nowhere'"), std::string::npos) << space;
  EXPECT_NE(space.find("half of light"), std::string::npos) << space;
}

TEST_F(Display, GarbageAndMissingFilesAreOneErrorEach) {
  std::filesystem::remove(folder_.file("luts/bent.spi1d"));
  const std::string missing = complaint({"Screen", "Bent"});
  EXPECT_NE(missing.find("bent.spi1d"), std::string::npos) << missing;
  expect({"Screen", "Plain"}, {0.1F, 0.2F, 0.7F}, {0.7F, 0.2F, 0.1F});  // needs it not
  for (const char* text : {"", "no config", "ocio_profile_version: 2\ndisplays: [", "\x7f\x45"}) {
    write("config.ocio", text);
    EXPECT_TRUE(complaint({}).starts_with("config.ocio: ")) << text;
  }
  std::filesystem::remove(folder_.file("config.ocio"));
  EXPECT_TRUE(complaint({}).starts_with("config.ocio: "));
}

TEST_F(Display, PicturesAreMadeByItAndSayWhatIsKnown) {
  Image film = make_image(1, 1, {"R", "G", "B", "A"});
  film.data = {0.05F, 0.1F, 0.35F, 0.5F};
  OutputDesc output;
  output.file = "a.png";
  output.exposure = 1;
  output.transparent = true;
  output.bits = 16;
  for (const bool srgb : {false, true}) {
    const auto display = open(names({srgb ? "sRGB screen" : "Screen"}));
    const std::string path = folder_.file("a.png");
    ASSERT_TRUE(write_output(output, film, path, {}, display->get()).ok());
    const auto back = read_image_file(path, ColorSpace::linear);
    ASSERT_TRUE(back.ok());
    EXPECT_NEAR(back->data[0], srgb ? 0.2 : 1.0, 1e-4);  // 1.4 is clipped
    EXPECT_NEAR(back->data[1], 0.4, 1e-4);
    EXPECT_NEAR(back->data[3], 0.5, 1e-4);
    std::ifstream file(path, std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(file)), {});
    EXPECT_EQ(bytes.find("sRGB\x00", 0, 4) != std::string::npos, srgb);
    const auto texts = read_png_texts(path);
    ASSERT_TRUE(texts.ok());
    ASSERT_EQ(texts->size(), 2U);
    EXPECT_EQ(texts->at(0).second, srgb ? "sRGB screen, As it is, exposure 1, denoise false"
                                        : "Screen, Plain, exposure 1, denoise false");
    EXPECT_EQ(texts->at(1).second, srgb ? "srgb" : "unknown");
  }
  // What no screen can show does no harm.
  const auto display = open(names({"Screen", "Bent"}));
  film.data = {std::numeric_limits<float>::quiet_NaN(), -1.0F,
               std::numeric_limits<float>::infinity(), 1.0F};
  const auto picture = display_picture(film, **display, 0, false);
  ASSERT_TRUE(picture.ok());
  EXPECT_EQ(picture->data[0], 0.0F);
  EXPECT_EQ(picture->data[1], 0.0F);
  EXPECT_EQ(picture->data[2], 1.0F);
}

TEST(OcioFiles, AreFoundInTheText) {
  EXPECT_EQ(ocio_file_candidates(kConfig), std::vector<std::string>{"luts/bent.spi1d"});
  EXPECT_EQ(ocio_file_candidates("search_path: a:../b\n"
                                 "x: !<FileTransform> {interpolation: linear, src: one.cube}\n"
                                 "y: !<GroupTransform>\n  children:\n"
                                 "    - !<FileTransform> {src: \"two, 2.clf\"}\n"
                                 "    - !<FileTransform>\n      src: one.cube\n"
                                 "    - !<FileTransform> {src: /abs/three.csp}\n"
                                 "    - !<FileTransform> {src: $SHOT.cc}\n"
                                 "    - !<FileTransform> {interpolation: best}\n"
                                 "    - !<ColorSpaceTransform> {src: lin, dst: log}\n"),
            (std::vector<std::string>{"a/one.cube", "../b/one.cube", "a/two, 2.clf",
                                      "../b/two, 2.clf", "/abs/three.csp"}));
  EXPECT_EQ(ocio_file_candidates("search_path:\n  - a\n  - \"b c\"\nx: !<FileTransform> {src: f}"),
            (std::vector<std::string>{"a/f", "b c/f"}));
  EXPECT_EQ(ocio_file_candidates("!<FileTransform> {src: f}"), std::vector<std::string>{"./f"});
  for (const char* broken : {"", "<FileTransform>", "!<FileTransform> {src: \"",
                             "search_path:", "!<FileTransform> {src:", "\nsearch_path: '"}) {
    EXPECT_LE(ocio_file_candidates(broken).size(), 1U) << broken;
  }
}

}  // namespace
}  // namespace hyades::core
