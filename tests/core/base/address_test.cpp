#include "core/base/address.h"

#include <gtest/gtest.h>

namespace hyades::core {
namespace {

TEST(Address, PortsAreSaidAndInRange) {
  for (const char* good : {"127.0.0.1:7700", "farm.example:0", "localhost:65535", "[::1]:1",
                           "[fe80::1%eth0]:7700", "node-1_a:80"}) {
    EXPECT_TRUE(check_address(good).ok()) << good;
  }
  for (const char* bad : {"", "127.0.0.1", ":7700", "127.0.0.1:", "127.0.0.1:99999", "host:-1",
                          "host:+1", "host: 1", "host:1x", "::1", "::1:7700", "[::1]", "[::1:7700",
                          "[]:1", "[host]:1", "a b:1", "dns:///host:1", "a:1\n"}) {
    const Status checked = check_address(bad);
    ASSERT_FALSE(checked.ok()) << bad;
    EXPECT_NE(checked.error().message.find("expected HOST:PORT"), std::string::npos) << bad;
  }
}

TEST(Address, PartsOfAnAddress) {
  EXPECT_EQ(split_address("farm.example:7700").host, "farm.example");
  EXPECT_EQ(split_address("farm.example:7700").port, "7700");
  EXPECT_EQ(split_address("[fe80::1%eth0]:80").host, "fe80::1%eth0");
  EXPECT_EQ(split_address("[fe80::1%eth0]:80").port, "80");
}

}  // namespace
}  // namespace hyades::core
