#include "farm/public_address.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>

#include <cstring>
#include <string>

namespace hyades::farm {
namespace {

bool is_public(const std::string& text) {
  sockaddr_storage address{};
  sockaddr_in ipv4{};
  sockaddr_in6 ipv6{};
  if (::inet_pton(AF_INET, text.c_str(), &ipv4.sin_addr) == 1) {
    ipv4.sin_family = AF_INET;
    std::memcpy(&address, &ipv4, sizeof ipv4);
  } else {
    EXPECT_EQ(::inet_pton(AF_INET6, text.c_str(), &ipv6.sin6_addr), 1) << text;
    ipv6.sin6_family = AF_INET6;
    std::memcpy(&address, &ipv6, sizeof ipv6);
  }
  return is_public_address(reinterpret_cast<const sockaddr&>(address));
}

TEST(PublicAddress, OfTheInternet) {
  for (const char* text :
       {"1.1.1.1", "172.15.0.1", "172.32.0.1", "100.63.0.1", "100.128.0.1", "192.167.1.1",
        "2001:200::1", "198.17.0.1", "223.255.255.255", "2606:4700::1111", "::ffff:1.1.1.1",
        "64:ff9b::101:101", "2002:101:101::1"}) {
    EXPECT_TRUE(is_public(text)) << text;
  }
}

TEST(PublicAddress, OfThisMachineAPrivateNetworkOrNobody) {
  for (const char* text :
       {"0.0.0.0",        "127.0.0.1",      "127.9.9.9",       "10.0.0.1",   "172.16.0.1",
        "172.31.255.255", "192.168.1.1",    "169.254.169.254", "100.64.0.1", "198.18.0.1",
        "224.0.0.1",      "240.0.0.1",      "255.255.255.255", "::",         "::1",
        "fe80::1",        "fc00::1",        "fd12::1",         "ff02::1",    "::ffff:127.0.0.1",
        "64:ff9b::a00:1", "2002:7f00:1::1", "2001:db8::1",     "2001::1"}) {
    EXPECT_FALSE(is_public(text)) << text;
  }
}

}  // namespace
}  // namespace hyades::farm
