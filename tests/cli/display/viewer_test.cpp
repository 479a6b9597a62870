#include "cli/display/viewer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/fake_viewer.h"

namespace hyades::cli {
namespace {

using test::FakeViewer;

/// Two channels whose values say where they are and which version this is.
core::Image picture(int width, int height, int version, int x0 = 0, int y0 = 0) {
  core::Image image = core::make_image(width, height, {"R", "depth.Z"});
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      image.at(x, y, 0) = static_cast<float>(1000 * version + x0 + x);
      image.at(x, y, 1) = static_cast<float>(y0 + y) + 0.5F;
    }
  }
  return image;
}

bool shows(const FakeViewer::Seen& seen, const std::string& name, const core::Image& image) {
  const auto found = seen.pictures.find(name);
  return found != seen.pictures.end() && found->second.width == image.width &&
         found->second.channels == image.channels && found->second.values == image.data;
}

TEST(Viewer, ShowsWhatIsPutIntoIt) {
  FakeViewer fake;
  {
    Viewer viewer(fake.address());
    viewer.put("a", 150, 70, picture(150, 70, 1), 0, 0);
    viewer.put("b", 10, 10, picture(3, 4, 2, 5, 6), 5, 6);
    EXPECT_EQ(viewer.take_notice(), std::nullopt);
  }
  ASSERT_TRUE(fake.wait_until([](const auto& seen) {
    return shows(seen, "a", picture(150, 70, 1)) && seen.pictures.contains("b") &&
           seen.pictures.at("b").updates > 0;
  }));
  const auto seen = fake.seen();
  EXPECT_THAT(seen.wrong, testing::IsEmpty());
  const FakeViewer::Picture& b = seen.pictures.at("b");
  EXPECT_EQ(b.values[(6 * 10 + 5) * 2], 2005.0F);
  EXPECT_EQ(b.values[(9 * 10 + 7) * 2 + 1], 9.5F);
  EXPECT_EQ(b.values[0], 0.0F) << "what was not put is black";
  EXPECT_EQ(seen.connections, 1);
}

TEST(Viewer, WhatStaysTheSameIsNotSentAgain) {
  FakeViewer fake;
  Viewer viewer(fake.address());
  viewer.put("a", 200, 200, picture(200, 200, 1), 0, 0);
  ASSERT_TRUE(
      fake.wait_until([](const auto& seen) { return shows(seen, "a", picture(200, 200, 1)); }));
  const int before = fake.seen().pictures.at("a").updates;
  core::Image changed = picture(200, 200, 1);
  changed.at(100, 100, 0) = -1.0F;
  viewer.put("a", 200, 200, changed, 0, 0);
  ASSERT_TRUE(fake.wait_until([&](const auto& seen) { return shows(seen, "a", changed); }));
  EXPECT_EQ(fake.seen().pictures.at("a").updates, before + 1);
}

TEST(Viewer, OneThatComesLaterGetsThePictureAsItIsThen) {
  const int port = test::free_port();
  Viewer viewer("127.0.0.1:" + std::to_string(port));
  viewer.put("a", 90, 90, picture(90, 90, 1), 0, 0);
  std::optional<std::string> notice;
  while (!notice) notice = viewer.take_notice();
  EXPECT_THAT(*notice, testing::HasSubstr("no viewer at 127.0.0.1:" + std::to_string(port)));
  viewer.put("a", 90, 90, picture(90, 90, 2), 0, 0);
  FakeViewer fake(port);
  EXPECT_TRUE(
      fake.wait_until([](const auto& seen) { return shows(seen, "a", picture(90, 90, 2)); }));
  EXPECT_EQ(viewer.take_notice(), std::nullopt) << "told once";
  EXPECT_THAT(fake.seen().wrong, testing::IsEmpty());
}

TEST(Viewer, OneThatGoesAndComesAgainGetsAllAgain) {
  FakeViewer fake;
  Viewer viewer(fake.address());
  for (int round = 1; round <= 3; ++round) {
    viewer.put("a", 90, 90, picture(90, 90, round), 0, 0);
    viewer.put("b", 20, 20, picture(20, 20, 7), 0, 0);
    ASSERT_TRUE(fake.wait_until([&](const auto& seen) {
      return shows(seen, "a", picture(90, 90, round)) && shows(seen, "b", picture(20, 20, 7));
    })) << round;
    fake.leave();
    fake.come_back();
  }
  EXPECT_THAT(fake.seen().wrong, testing::IsEmpty());
}

TEST(Viewer, OneThatDoesNotReadHoldsUpNobodyAndMissesWhatIsOld) {
  FakeViewer fake;
  fake.stop_reading();
  constexpr int kVersions = 200;
  constexpr int kEdge = 512;
  {
    Viewer viewer(fake.address());
    // Far more than fits into the buffers of a connection.
    for (int version = 1; version <= kVersions; ++version) {
      viewer.put("a", kEdge, kEdge, picture(kEdge, kEdge, version), 0, 0);
    }
    fake.read_again();
    EXPECT_TRUE(fake.wait_until(
        [](const auto& seen) { return shows(seen, "a", picture(kEdge, kEdge, kVersions)); }));
  }
  const auto seen = fake.seen();
  EXPECT_THAT(seen.wrong, testing::IsEmpty());
  constexpr uint64_t kOnce = uint64_t{kEdge} * kEdge * 2 * sizeof(float);
  EXPECT_LT(seen.bytes, kVersions / 4 * kOnce);
}

TEST(Viewer, EndsWhereNobodyReads) {
  FakeViewer fake;
  fake.stop_reading();
  Viewer viewer(fake.address());
  viewer.put("a", 2048, 2048, picture(2048, 2048, 1), 0, 0);
}

TEST(Viewer, WhatAViewerSaysIsOfNoInterest) {
  FakeViewer fake;
  Viewer viewer(fake.address());
  ASSERT_TRUE(fake.wait_until([](const auto& seen) { return seen.connections > 0; }));
  for (int i = 0; i < 10; ++i) fake.babble(std::string(10'000, '\xFF'));
  viewer.put("a", 9, 9, picture(9, 9, 1), 0, 0);
  EXPECT_TRUE(fake.wait_until([](const auto& seen) { return shows(seen, "a", picture(9, 9, 1)); }));
}

TEST(Viewer, OldPicturesAreClosedWhereThereAreMany) {
  FakeViewer fake;
  Viewer viewer(fake.address());
  constexpr int kExtra = 3;
  for (int i = 0; i < static_cast<int>(Viewer::kMostShown) + kExtra; ++i) {
    const std::string name = "walk." + std::to_string(i);
    viewer.put(name, 8, 8, picture(8, 8, i), 0, 0);
    ASSERT_TRUE(
        fake.wait_until([&](const auto& seen) { return shows(seen, name, picture(8, 8, i)); }));
  }
  ASSERT_TRUE(fake.wait_until([](const auto& seen) { return seen.closed.size() == kExtra; }));
  const auto seen = fake.seen();
  EXPECT_THAT(seen.closed, testing::ElementsAre("walk.0", "walk.1", "walk.2"));
  EXPECT_EQ(seen.pictures.size(), Viewer::kMostShown);
  EXPECT_THAT(seen.wrong, testing::IsEmpty());
}

TEST(Viewer, APictureOfAnotherSizeBeginsAnew) {
  FakeViewer fake;
  Viewer viewer(fake.address());
  viewer.put("a", 90, 90, picture(90, 90, 1), 0, 0);
  viewer.put("a", 30, 20, picture(30, 20, 2), 0, 0);
  EXPECT_TRUE(
      fake.wait_until([](const auto& seen) { return shows(seen, "a", picture(30, 20, 2)); }));
}

}  // namespace
}  // namespace hyades::cli
