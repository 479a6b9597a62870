// Targets, ranges, archives, previews: what needs no server.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "coordinator/operations/operation.h"
#include "coordinator/web/byte_range.h"
#include "coordinator/web/picture_encoding.h"
#include "coordinator/web/request_form.h"
#include "coordinator/web/request_target.h"
#include "coordinator/web/zip_source.h"
#include "hyades/v1/web.pb.h"
#include "tests/support/temp_folder.h"

namespace hyades::coordinator {
namespace {

TEST(Target, PathsAndQueriesAreDecoded) {
  const auto target = parse_target("/a%20b//c%2Fd?x=1&y=a+b%26&x=2&z");
  ASSERT_TRUE(target);
  EXPECT_EQ(target->path, (std::vector<std::string>{"a b", "c/d"}));
  EXPECT_EQ(target->query.at("x"), "2");
  EXPECT_EQ(target->query.at("y"), "a b&");
  EXPECT_EQ(target->query.at("z"), "");
}

TEST(Target, WhatClimbsOrIsBrokenIsNone) {
  for (const char* text : {"", "a", "/..", "/a/%2e%2E/b", "/.", "/%zz", "/%4", "/a%00b", "/?x=%"}) {
    EXPECT_FALSE(parse_target(text)) << text;
  }
}

TEST(ByteRange, AsRfc9110HasThem) {
  ByteRange range;
  EXPECT_EQ(read_range("", 10, range), RangeAsked::whole);
  EXPECT_EQ(read_range("bytes=0-1,3-4", 10, range), RangeAsked::whole);
  EXPECT_EQ(read_range("bytes=5-3", 10, range), RangeAsked::whole);
  EXPECT_EQ(read_range("bytes=2-4", 10, range), RangeAsked::part);
  EXPECT_EQ(range.first, 2U);
  EXPECT_EQ(range.last, 4U);
  EXPECT_EQ(read_range("bytes=7-", 10, range), RangeAsked::part);
  EXPECT_EQ(range.last, 9U);
  EXPECT_EQ(read_range("bytes=-3", 10, range), RangeAsked::part);
  EXPECT_EQ(range.first, 7U);
  EXPECT_EQ(read_range("bytes=-30", 10, range), RangeAsked::part);
  EXPECT_EQ(range.first, 0U);
  EXPECT_EQ(read_range("bytes=10-", 10, range), RangeAsked::impossible);
  EXPECT_EQ(read_range("bytes=0-", 0, range), RangeAsked::impossible);
}

TEST(ZipSource, HoldsEveryFileWhole) {
  const test::TempFolder folder;
  std::filesystem::create_directory(folder.file("frames"));
  ZipSource source(folder.path());
  for (const size_t size : {0U, 1U, 3'000'000U}) {
    const std::string name = "frames/" + std::to_string(size) + ".bin";
    std::ofstream(folder.file(name)) << std::string(size, 'x');
    source.add(name, size);
  }
  std::string archive;
  for (auto piece = source.next(); piece && !piece->empty(); piece = source.next())
    archive += *piece;
  const std::string file = folder.file("all.zip");
  std::ofstream(file) << archive;
  // Read by another program than the one that made it.
  const std::string test =
      "python3 -c \"import zipfile,sys; z=zipfile.ZipFile('" + file +
      "'); assert z.testzip() is None; "
      "assert [i.file_size for i in z.infolist()] == [0, 1, 3000000], z.infolist()\"";
  EXPECT_EQ(std::system(test.c_str()), 0);
}

TEST(ZipSource, AFileThatIsGoneBreaksTheArchiveOff) {
  ZipSource source("/nowhere/at");
  source.add("all", 5);
  EXPECT_FALSE(source.next());
}

TEST(Preview, ShrinkingKeepsTheMean) {
  core::Image image = core::make_image(7, 5, {"R", "G", "B"});
  double sum = 0;
  for (size_t i = 0; i < image.data.size(); ++i) {
    image.data[i] = static_cast<float>((i * 37) % 11);
    sum += static_cast<double>(image.data[i]);
  }
  SampledMask all;
  const core::Image small = shrink(image, 3, all);
  EXPECT_TRUE(all.empty());
  EXPECT_EQ(small.width, 3);
  EXPECT_EQ(small.height, 2);
  double after = 0;
  for (const float value : small.data) after += static_cast<double>(value);
  EXPECT_NEAR(after / static_cast<double>(small.data.size()),
              sum / static_cast<double>(image.data.size()), 1e-5);
}

TEST(Preview, WhatIsNotFiniteDoesNotSpread) {
  core::Image depth = core::make_image(4, 1, {"depth.Z"});
  depth.data = {1, std::numeric_limits<float>::infinity(), 3, 3};
  SampledMask all;
  const core::Image small = shrink(depth, 2, all);
  EXPECT_EQ(small.data[0], 1);
  EXPECT_EQ(small.data[1], 3);
}

TEST(Preview, PixelsWithoutSamplesDoNotDarkenSmallPictures) {
  core::Film film(core::make_film_layout({}), {0, 0, 4, 2});
  const core::PixelRect half{0, 0, 3, 2};
  const auto channels = static_cast<size_t>(film.layout().deposited);
  film.deposit(half, 0, core::kBatchSamples, std::vector<float>(6 * channels, 16.0F));
  SampledMask mask = sampled_pixels(film);
  EXPECT_EQ(mask, (SampledMask{255, 255, 255, 0, 255, 255, 255, 0}));
  core::Image image = core::make_image(4, 2, {"R"});
  image.data = {8, 8, 8, 0, 8, 8, 8, 0};
  const core::Image small = shrink(image, 2, mask);
  EXPECT_EQ(small.data, (std::vector<float>{8, 8}));
  EXPECT_EQ(mask, (SampledMask{255, 128}));
  const std::string bytes = half_planes(small, {"beauty", {"beauty"}, 16, true, 4, 2, &mask});
  const auto header = farm::Json::parse(bytes.substr(0, bytes.find('\n')));
  EXPECT_EQ(header["full_width"], 4);
  EXPECT_EQ(header["mask"], true);
  EXPECT_EQ(bytes.size() - bytes.find('\n') - 1, 2U * 2 + 2);
  EXPECT_EQ(static_cast<unsigned char>(bytes.back()), 128);
}

TEST(Preview, AFilmThatIsCoveredHasNoMask) {
  core::Film film(core::make_film_layout({}), {5, 6, 7, 8});
  const auto channels = static_cast<size_t>(film.layout().deposited);
  film.deposit({5, 6, 7, 8}, 0, core::kBatchSamples, std::vector<float>(4 * channels, 1.0F));
  EXPECT_TRUE(sampled_pixels(film).empty());
}

TEST(Preview, LayersAreTakenByName) {
  core::Image film = core::make_image(
      1, 1, {"R", "G", "B", "A", "depth.Z", "normal.X", "normal.Y", "normal.Z", "samples.N"});
  for (size_t i = 0; i < film.data.size(); ++i) film.data[i] = static_cast<float>(i);
  EXPECT_EQ(layers_of(film),
            (std::vector<std::string>{"beauty", "alpha", "depth", "normal", "samples"}));
  EXPECT_EQ(take_layer(film, "normal")->data, (std::vector<float>{5, 6, 7}));
  const auto none = take_layer(film, "albedo");
  ASSERT_FALSE(none.ok());
  EXPECT_NE(none.error().message.find("beauty, alpha, depth"), std::string::npos);
}

TEST(Preview, HalfPlanesLieOneAfterTheOther) {
  core::Image image = core::make_image(2, 1, {"R", "G"});
  image.data = {1, 2, 1e9F, -0.5F};
  const std::string bytes = half_planes(image, {"beauty", {"beauty"}, 16, true, 2, 1, nullptr});
  const std::string planes = bytes.substr(bytes.find('\n') + 1);
  const unsigned char expected[] = {0x00, 0x3C, 0xFF, 0x7B, 0x00, 0x40, 0x00, 0xB8};
  ASSERT_EQ(planes.size(), sizeof expected);
  for (size_t i = 0; i < planes.size(); ++i) {
    EXPECT_EQ(static_cast<unsigned char>(planes[i]), expected[i]) << i;
  }
}

core::Result<v1::SubmitRequest> read_submission(const std::string& body) {
  v1::SubmitRequest request;
  const Route& route = operation_of_route("POST /api/v1/jobs").routes.front();
  const grpc::Status read = read_body(body, *route.body, request);
  if (!read.ok()) return core::Error{read.error_message()};
  return request;
}

TEST(Submission, FieldsThatAreWrongAreNamed) {
  const std::string digest(64, 'a');
  const auto error = [](const std::string& body) {
    const auto read = read_submission(body);
    return read ? std::string() : read.error().message;
  };
  EXPECT_NE(error("[]").find("object"), std::string::npos);
  EXPECT_NE(error(R"({"document": "j", "files": []})").find("name"), std::string::npos);
  EXPECT_NE(
      error(R"({"name": "n", "document": "j", "files": [{"path": "p", "sha256": "x", "size": 1}]})")
          .find("files[0].sha256"),
      std::string::npos);
  const std::string start =
      R"({"name": "n", "document": "j", "files": [{"path": "j", "sha256": ")" + digest +
      R"(", "size": 1}], )";
  EXPECT_NE(error(start + R"("priority": 1.5})").find("priority"), std::string::npos);
  EXPECT_NE(error(start + R"("max_workers": -1})").find("max_workers"), std::string::npos);
  EXPECT_NE(error(start + R"("samples": 4294967296})").find("samples"), std::string::npos);
  EXPECT_NE(error(start + R"("frames": [{"first": 1}]})").find("frames[0].last"),
            std::string::npos);
  EXPECT_NE(error(start + R"("frame_order": "backwards"})").find("frame_order"), std::string::npos);
  EXPECT_NE(error(start + R"("priorty": 1})").find("did you mean 'priority'"), std::string::npos);
  const auto read = read_submission(
      start +
      R"("priority": -3, "frames": [{"first": 1, "last": 9, "step": 2}], "tags": ["big"]})");
  ASSERT_TRUE(read.ok());
  EXPECT_EQ(read->priority(), -3);
  EXPECT_EQ(read->spec().frames(0).step(), 2);
  EXPECT_EQ(read->tags(0), "big");
}

TEST(Submission, FlagsAreReadOutOfABody) {
  const BodyForm form = {.fields = {{"download"}}};
  v1::OutputRequest asked;
  EXPECT_TRUE(read_body(R"({"download": true})", form, asked).ok());
  EXPECT_TRUE(asked.download());
  EXPECT_EQ(read_body(R"({"download": 1})", form, asked).error_message(),
            "download: expected true or false");
}

}  // namespace
}  // namespace hyades::coordinator
