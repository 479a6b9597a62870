// Coordinators at several addresses, of which one leads.
#include "farm/channels.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace hyades::farm {
namespace {

using Addresses = std::vector<std::string>;

std::shared_ptr<Channels> channels(const std::string& addresses) {
  Peer peer;
  peer.address = addresses;
  const auto opened = Channels::open(peer);
  EXPECT_TRUE(opened.ok());
  return opened ? *opened : nullptr;
}

TEST(Channels, HaveTheirAddressesBetweenCommas) {
  EXPECT_EQ(split_addresses("a:1"), Addresses{"a:1"});
  EXPECT_EQ(split_addresses("a:1,[::1]:2,c:3"), (Addresses{"a:1", "[::1]:2", "c:3"}));
  EXPECT_EQ(split_addresses("a:1,"), (Addresses{"a:1", ""})) << "which check_address() refuses";
  EXPECT_EQ(split_addresses(""), Addresses{""});
}

TEST(Channels, AreGoneThroughInTurn) {
  const auto three = channels("127.0.0.1:1,127.0.0.1:2,127.0.0.1:3");
  EXPECT_EQ(three->size(), 3U);
  for (const char* address : {"127.0.0.1:1", "127.0.0.1:2", "127.0.0.1:3", "127.0.0.1:1"}) {
    EXPECT_EQ(three->current().address, address);
    (void)three->failed(three->current());
  }
}

TEST(Channels, AreWaitedForOnlyWhenEachHasHadItsTurn) {
  const auto three = channels("127.0.0.1:1,127.0.0.1:2,127.0.0.1:3");
  for (int round = 0; round < 3; ++round) {
    EXPECT_TRUE(three->failed(three->current()));
    EXPECT_TRUE(three->failed(three->current()));
    EXPECT_FALSE(three->failed(three->current())) << "a round is over";
  }
  EXPECT_TRUE(three->failed(three->current()));
  EXPECT_TRUE(three->failed(three->current()));
  three->answered();
  EXPECT_TRUE(three->failed(three->current())) << "who answered was the first of another round";
  EXPECT_TRUE(three->failed(three->current()));
  EXPECT_FALSE(three->failed(three->current()));
}

TEST(Channels, OneAddressIsWaitedForEachTime) {
  const auto one = channels("127.0.0.1:1");
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(one->failed(one->current()));
  EXPECT_EQ(one->current().address, "127.0.0.1:1");
}

TEST(Channels, OfTwoWhoSayThatTheSameOneFailedOneIsLate) {
  const auto two = channels("127.0.0.1:1,127.0.0.1:2");
  const Channels::Way first = two->current();
  EXPECT_TRUE(two->failed(first));
  EXPECT_TRUE(two->failed(first)) << "there is another current one already";
  EXPECT_EQ(two->current().address, "127.0.0.1:2");
  EXPECT_FALSE(two->failed(two->current())) << "nothing was counted twice";
}

TEST(Channels, PlainTextLeavesThisMachineToNoneOfThem) {
  Peer peer;
  peer.address = "127.0.0.1:1,farm.example:7700,10.0.0.1:2";
  const auto refused = Channels::open(peer);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().message.find("farm.example:7700 is not this machine"), 0U);
  EXPECT_EQ(plaintext_warning(peer), "");
  peer.insecure = true;
  EXPECT_TRUE(Channels::open(peer).ok());
  EXPECT_EQ(plaintext_warning(peer).find("plain text to farm.example:7700, 10.0.0.1:2 "), 0U);
  peer.address = "127.0.0.1:1,localhost:2";
  EXPECT_EQ(plaintext_warning(peer), "");
}

}  // namespace
}  // namespace hyades::farm
