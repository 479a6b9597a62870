#include "coordinator/access/address.h"

#include <gtest/gtest.h>

namespace hyades::coordinator {
namespace {

TEST(Address, HasOneFormWhicheverWayTheCallCame) {
  EXPECT_EQ(address_of_peer("ipv4:192.0.2.7:5000"), "192.0.2.7:5000");
  EXPECT_EQ(address_text("192.0.2.7", "5000"), "192.0.2.7:5000");
  for (const char* peer : {"ipv6:%5B2001:db8::1%5D:5000", "ipv6:[2001:db8::1]:5000",
                           "ipv6:%5B2001:0db8:0:0::0001%5D:5000"}) {
    EXPECT_EQ(address_of_peer(peer), "[2001:db8::1]:5000") << peer;
  }
  EXPECT_EQ(address_text("2001:db8::1", "5000"), "[2001:db8::1]:5000");
  // An IPv4 caller of a server that listens at [::].
  EXPECT_EQ(address_of_peer("ipv6:%5B::ffff:192.0.2.7%5D:5000"), "192.0.2.7:5000");
  EXPECT_EQ(address_text("::ffff:192.0.2.7", "5000"), "192.0.2.7:5000");
  EXPECT_EQ(address_text("fe80::1%eth0", "5000"), "[fe80::1]:5000");
}

TEST(Address, WhatIsNoneStaysAsItIs) {
  for (const char* peer : {"", "unix:/run/hyades", "ipv4:", "ipv6:%5B", "ipv4:nonsense"}) {
    EXPECT_EQ(address_of_peer(peer), peer);
  }
}

TEST(Address, WhoHasANetworkIsOneCaller) {
  EXPECT_EQ(neighbourhood_of("192.0.2.7:5000"), neighbourhood_of("192.0.2.7:6000"));
  EXPECT_NE(neighbourhood_of("192.0.2.7:5000"), neighbourhood_of("192.0.2.8:5000"));
  EXPECT_EQ(neighbourhood_of("[2001:db8:1:2::1]:5000"),
            neighbourhood_of("[2001:db8:1:2:ffff::9]:7"));
  EXPECT_NE(neighbourhood_of("[2001:db8:1:2::1]:5000"), neighbourhood_of("[2001:db8:1:3::1]:5000"));
  EXPECT_EQ(neighbourhood_of("unix:/run/hyades"), "unix");
}

}  // namespace
}  // namespace hyades::coordinator
