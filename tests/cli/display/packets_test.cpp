#include "cli/display/packets.h"

#include <gtest/gtest.h>

namespace hyades::cli {
namespace {

std::string bytes(std::initializer_list<int> values) {
  std::string text;
  for (const int value : values) text += static_cast<char>(value);
  return text;
}

// Written out from tev's src/Ipc.cpp (IpcPacket::setCreateImage, setUpdateImage, setCloseImage).

TEST(ViewerPackets, ANewPicture) {
  // Length, operation, focus, name, width, height, number of channels, their names.
  EXPECT_EQ(create_picture("a", true, 258, 3, {"R", "n.X"}),
            bytes({26, 0, 0, 0, 4, 1, 'a', 0,   2, 1,   0,   0,   3,
                   0,  0, 0, 2, 0, 0, 0,   'R', 0, 'n', '.', 'X', 0}));
}

TEST(ViewerPackets, AnUpdateOfAllChannels) {
  const float values[] = {1.0F, -2.0F};
  EXPECT_EQ(update_picture("a", {5, 6, 6, 7}, {"R", "G"}, values),
            bytes({4 + 1 + 1 + 2 + 4 + 4 + 16 + 32 + 8, 0, 0, 0, 6, 0, 'a', 0, 2, 0, 0, 0, 'R', 0,
                   'G', 0}) +
                bytes({5, 0, 0, 0, 6, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}) +
                bytes({0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0}) +
                bytes({2, 0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0}) +
                bytes({0, 0, 0x80, 0x3F, 0, 0, 0, 0xC0}));
}

TEST(ViewerPackets, TheEndOfAPicture) {
  EXPECT_EQ(close_picture("ab"), bytes({8, 0, 0, 0, 2, 'a', 'b', 0}));
}

}  // namespace
}  // namespace hyades::cli
