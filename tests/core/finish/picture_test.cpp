#include "core/finish/picture.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/hash.h"
#include "core/base/text.h"
#include "core/finish/cryptomatte.h"
#include "core/finish/frame_outputs.h"
#include "core/finish/picture_layers.h"
#include "core/image/read_image.h"
#include "core/job/parse.h"
#include "tests/support/temp_folder.h"

namespace hyades::core {
namespace {

using test::TempFolder;

/// A picture like Film::normalised() returns.
Image normalised_film() {
  Image image =
      make_image(8, 6,
                 {"R", "G", "B", "A", "depth.Z", "albedo.R", "albedo.G", "albedo.B", "normal.X",
                  "normal.Y", "normal.Z", "variance.R", "variance.G", "variance.B", "samples.N"});
  for (size_t i = 0; i < image.data.size(); ++i) {
    image.data[i] = static_cast<float>(mix64(i) >> 40) * 0x1p-24F;
  }
  return image;
}

OutputDesc output(const std::string& file) {
  OutputDesc desc;
  desc.file = file;
  return desc;
}

TEST(Picture, OutputPaths) {
  const auto path = [](const std::string& file, int32_t frame) {
    return output_path(output(file), "out", frame);
  };
  EXPECT_EQ(path("a.####.exr", 7), "out/a.0007.exr");
  EXPECT_EQ(path("a.##.exr", 12345), "out/a.12345.exr");
  EXPECT_EQ(path("##/a.png", 4), "out/04/a.png");
  EXPECT_EQ(path("a.####.exr", -7), "out/a.-007.exr");
  EXPECT_EQ(path("a.exr", 3), "out/a.exr");
  EXPECT_EQ(path("/abs/a#.exr", 3), "/abs/a3.exr");
  EXPECT_EQ(output_path(output("a.#.exr"), "", 3), "a.3.exr");
  EXPECT_EQ(output_path(output("a.exr"), "shot#1", 3), "shot#1/a.exr");
}

/// What the job parser says about one output.
std::string complaint(const std::string& output_yaml) {
  const std::string text = "hyades: 1\noutputs:\n  - " + output_yaml + "\n";
  Diagnostics diagnostics;
  class NoFiles : public AssetResolver {
    Result<Bytes> open(const std::string&, const std::string&) override { return Error{"none"}; }
  } files;
  (void)parse_job(text, "job.yaml", files, diagnostics);
  return diagnostics.to_string();
}

TEST(Picture, JobsKnowTheSameNames) {
  const std::string layer = complaint("{file: a.exr, layers: [zzzz]}");
  EXPECT_NE(layer.find(join_names(layer_names())), std::string::npos) << layer;
  const std::string curve = complaint("{file: a.png, tone_map: zzzz}");
  for (const std::string& name : tone_curve_names()) {
    EXPECT_NE(curve.find(name), std::string::npos) << curve;
    EXPECT_EQ(complaint("{file: a.png, tone_map: " + name + "}").find("tone_map"),
              std::string::npos);
  }
}

TEST(Picture, FormatsByEnding) {
  EXPECT_EQ(*picture_format("a.exr"), PictureFormat::exr);
  EXPECT_EQ(*picture_format("b/A.PNG"), PictureFormat::png);
  EXPECT_EQ(*picture_format("a.jpeg"), PictureFormat::jpeg);
  EXPECT_FALSE(picture_format("a.gif"));
  EXPECT_FALSE(picture_format("a"));
  EXPECT_FALSE(picture_format("png"));
}

TEST(Picture, ExrHoldsTheChosenLayers) {
  const TempFolder folder;
  const Image film = normalised_film();
  OutputDesc desc = output("sub/deeper/a.exr");
  desc.layers = {"normal", "beauty", "depth", "samples"};
  const std::string path = output_path(desc, folder.path().string(), 1);
  const Status status = write_output(desc, film, path, {{"hyades.frame", "1"}});
  ASSERT_TRUE(status) << status.error().message;
  const Result<Image> back = read_image_file(path);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->channels, (std::vector<std::string>{"R", "G", "B", "depth.Z", "normal.X",
                                                      "normal.Y", "normal.Z", "samples.N"}));
  for (int i = 0; i < back->channel_count(); ++i) {
    const int source = film.find_channel(back->channels[static_cast<size_t>(i)]);
    for (int y = 0; y < 6; ++y) {
      for (int x = 0; x < 8; ++x) EXPECT_EQ(back->at(x, y, i), film.at(x, y, source));
    }
  }
}

TEST(Picture, ACropKeepsItsPlaceInTheFrame) {
  const TempFolder folder;
  FilmInfo info;
  info.frame = 1;
  info.width = 20;
  info.height = 10;
  const std::vector<OutputDesc> outputs{output("crop.exr")};
  const auto placement = [&](const PixelRect& window) {
    const Film film(make_film_layout({}), window);
    EXPECT_TRUE(write_outputs(outputs, folder.path().string(), info, film).ok());
    return read_image_file(folder.file("crop.exr"))->placement;
  };
  EXPECT_EQ(placement({5, 7, 8, 9}), (ImageWindow{5, 7, 20, 10}));
  EXPECT_EQ(placement({0, 0, 20, 10}), ImageWindow{});
}

TEST(Picture, EveryLayerCanBeWrittenAndMissingOnesAreNamed) {
  LayerSet layers{true, true, true};
  layers.position = layers.motion = true;
  layers.components.fill(true);
  layers.light_groups = {"key", kRestGroup};
  layers.ids = {true, true};
  const Film exact(make_film_layout(layers), {0, 0, 8, 6});
  Image film = exact.normalised();
  add_id_channels(exact, film);
  std::vector<std::string> names;
  for (const std::string& layer : layer_names()) {
    if (unfolded(layer).size() > 1) continue;
    names.push_back(layer);
    const Result<Image> one = select_layers(film, std::vector<std::string>{layer});
    ASSERT_TRUE(one) << layer;
    EXPECT_FALSE(one->channels.empty()) << layer;
    if (layer == "light_groups") continue;  // several
    EXPECT_TRUE(view_layer(film, layer)) << layer;
  }
  const Result<Image> all = select_layers(film, names);
  ASSERT_TRUE(all);
  EXPECT_EQ(all->channels.size(), film.channels.size());
  const Result<Image> plain = select_layers(film, {});
  ASSERT_TRUE(plain);
  EXPECT_EQ(plain->channels, (std::vector<std::string>{"R", "G", "B", "A"}));

  const Image bare = make_image(2, 2, {"R", "G", "B"});
  const Result<Image> missing = select_layers(bare, std::vector<std::string>{"depth"});
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().message, "the film holds no layer 'depth'");
  const Result<Image> typo = select_layers(bare, std::vector<std::string>{"albdo"});
  ASSERT_FALSE(typo);
  EXPECT_NE(typo.error().message.find("did you mean 'albedo'?"), std::string::npos);
}

TEST(Picture, PngAndJpegAreToneMapped) {
  const TempFolder folder;
  Image film = make_image(16, 16, {"R", "G", "B", "A"});
  for (size_t i = 0; i < film.data.size(); ++i) film.data[i] = i % 4 == 3 ? 1.0F : 0.09F;
  for (const char* name : {"a.png", "a.jpg"}) {
    OutputDesc desc = output(name);
    desc.tone_map = "aces";
    desc.exposure = 1.0F;
    const Status status = write_output(desc, film, folder.file(name));
    ASSERT_TRUE(status) << status.error().message;
    const Result<Image> back = read_image_file(folder.file(name), ColorSpace::linear);
    ASSERT_TRUE(back);
    EXPECT_EQ(back->channels.size(), 3U);
    EXPECT_NEAR(back->at(5, 5, 0), tone_map(Rgb(0.18F), ToneCurve::aces, 0.0F).x, 0.004F);
  }
}

TEST(Picture, TransparentPngHasStraightAlpha) {
  const TempFolder folder;
  Image film = make_image(2, 1, {"R", "G", "B", "A"});
  film.data = {0.1F, 0.2F, 0.05F, 0.5F, 0.0F, 0.0F, 0.0F, 0.0F};
  OutputDesc desc = output("a.png");
  desc.transparent = true;
  desc.tone_map = "linear";
  ASSERT_TRUE(write_output(desc, film, folder.file("a.png")));
  const Result<Image> back = read_image_file(folder.file("a.png"), ColorSpace::linear);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->channels, (std::vector<std::string>{"R", "G", "B", "A"}));
  EXPECT_NEAR(back->at(0, 0, 0), 0.2F, 0.002F);
  EXPECT_NEAR(back->at(0, 0, 1), 0.4F, 0.002F);
  EXPECT_NEAR(back->at(0, 0, 3), 0.5F, 0.002F);
  EXPECT_EQ(back->at(1, 0, 3), 0.0F);
}

TEST(Picture, ErrorsSayWhatAndWhere) {
  const TempFolder folder;
  const Image film = normalised_film();
  const Status ending = write_output(output("a.tga"), film, folder.file("a.tga"));
  ASSERT_FALSE(ending);
  EXPECT_NE(ending.error().message.find("expected .exr, .png, .jpg or .tif"), std::string::npos);
  OutputDesc desc = output("a.png");
  desc.tone_map = "filmc";
  const Status curve = write_output(desc, film, folder.file("a.png"));
  ASSERT_FALSE(curve);
  EXPECT_NE(curve.error().message.find("did you mean 'filmic'?"), std::string::npos);
  ASSERT_TRUE(write_output(output("file.png"), film, folder.file("file.png")));
  const Status blocked = write_output(output("x.png"), film, folder.file("file.png/x.png"));
  ASSERT_FALSE(blocked);
  EXPECT_NE(blocked.error().message.find("cannot make the folder"), std::string::npos);
}

}  // namespace
}  // namespace hyades::core
