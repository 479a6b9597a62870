// Whose connections there may be how many of.
#include "coordinator/web/connection_count.h"

#include <gtest/gtest.h>

namespace hyades::coordinator {
namespace {

boost::asio::ip::address at(const char* text) { return boost::asio::ip::make_address(text); }

TEST(ConnectionCount, NobodyTakesAll) {
  ConnectionCount count(60, 2, 1);
  count.enter(at("192.0.2.1"));
  EXPECT_TRUE(count.may_come(at("192.0.2.1")));
  count.enter(at("192.0.2.1"));
  EXPECT_FALSE(count.may_come(at("192.0.2.1")));
  EXPECT_FALSE(count.may_come(at("::ffff:192.0.2.1"))) << "the same, written otherwise";
  EXPECT_TRUE(count.may_come(at("192.0.2.2")));
  count.leave(at("192.0.2.1"));
  EXPECT_TRUE(count.may_come(at("192.0.2.1")));
}

TEST(ConnectionCount, AProxyHereHasAsManyAsThereAre) {
  ConnectionCount count(6, 2, 1);
  for (int i = 0; i < 6; ++i) {
    EXPECT_TRUE(count.may_come(at(i % 2 == 0 ? "127.0.0.1" : "::1")));
    count.enter(at(i % 2 == 0 ? "127.0.0.1" : "::1"));
  }
  EXPECT_FALSE(count.may_come(at("127.0.0.1")));
  EXPECT_FALSE(count.may_come(at("192.0.2.1")));
}

TEST(ConnectionCount, AnAddressIsItsOwnersWhole) {
  const auto owner = [](const char* text) { return ConnectionCount::owner_of(at(text)); };
  EXPECT_NE(owner("192.0.2.1"), owner("192.0.2.2"));
  EXPECT_EQ(owner("2001:db8:1:2::5"), owner("2001:db8:1:2:ffff::9"));
  EXPECT_NE(owner("2001:db8:1:2::5"), owner("2001:db8:1:3::5"));
  EXPECT_EQ(owner("::ffff:192.0.2.1"), owner("192.0.2.1"));
}

}  // namespace
}  // namespace hyades::coordinator
