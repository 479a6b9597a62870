// Who may wait for how many pictures.
#include "coordinator/web/picture_turns.h"

#include <gtest/gtest.h>

#include <chrono>
#include <string>

namespace hyades::coordinator {
namespace {

using namespace std::chrono_literals;

PictureAsker asker(const std::string& owner) {
  return {{owner}, [](WebReply) {}};
}

/// Many who wait for one picture cost nothing but their connections, which are others' too.
TEST(PictureTurns, OneCallerWaitsForOnePictureWithFewConnections) {
  PictureTurns turns(1s);
  const AskedPicture picture{.job = 1, .frame = 2};
  for (int i = 0; i < PictureTurns::kMostAskersOfOne; ++i) {
    EXPECT_TRUE(turns.add(picture, asker("ada")));
  }
  EXPECT_FALSE(turns.add(picture, asker("ada")));
  EXPECT_FALSE(turns.add({.job = 1, .frame = 2, .width = 64}, asker("ada")));
  EXPECT_TRUE(turns.add(picture, asker("grace")));
  EXPECT_TRUE(turns.add({.job = 1, .frame = 3}, asker("ada")));
}

}  // namespace
}  // namespace hyades::coordinator
