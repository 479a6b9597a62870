#include "farm/public_address.h"

#include <netinet/in.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <iterator>

namespace hyades::farm {
namespace {

struct Network {
  uint32_t address;
  int bits;
};

/// RFC 6890, table 1 to 16, and what is multicast (RFC 5771) or reserved (RFC 1112).
constexpr Network kSpecial[] = {
    {0x00000000, 8},   // this network
    {0x0A000000, 8},   // private
    {0x64400000, 10},  // shared by customers of one provider
    {0x7F000000, 8},   // this machine
    {0xA9FE0000, 16},  // link-local, and the metadata of clouds
    {0xAC100000, 12},  // private
    {0xC0000000, 24},  // protocol assignments
    {0xC0000200, 24},  // documentation
    {0xC0A80000, 16},  // private
    {0xC6120000, 15},  // benchmarks
    {0xC6336400, 24},  // documentation
    {0xCB007100, 24},  // documentation
    {0xE0000000, 3},   // multicast, reserved, broadcast
};

bool is_public(uint32_t address) {
  return std::none_of(std::begin(kSpecial), std::end(kSpecial), [&](const Network& network) {
    return (address ^ network.address) >> (32 - network.bits) == 0;
  });
}

uint32_t ipv4_at(const uint8_t* bytes) {
  return uint32_t{bytes[0]} << 24U | uint32_t{bytes[1]} << 16U | uint32_t{bytes[2]} << 8U |
         bytes[3];
}

bool is_public(const in6_addr& address) {
  const uint8_t* bytes = address.s6_addr;
  constexpr uint8_t kMapped[12] = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xFF, 0xFF};
  constexpr uint8_t kNat64[12] = {0x00, 0x64, 0xFF, 0x9B};
  if (std::memcmp(bytes, kMapped, sizeof kMapped) == 0 ||
      std::memcmp(bytes, kNat64, sizeof kNat64) == 0) {
    return is_public(ipv4_at(bytes + sizeof kMapped));
  }
  // Global unicast is 2000::/3 (RFC 4291, 2.4); of it, 2001::/23 is for protocols (RFC 2928), among
  // them Teredo, which holds addresses of IPv4, 2001:db8::/32 is for documentation, and 2002::/16
  // (6to4) holds an address of IPv4.
  if ((bytes[0] & 0xE0U) != 0x20) return false;
  if (bytes[0] != 0x20) return true;
  if (bytes[1] == 0x02) return is_public(ipv4_at(bytes + 2));
  return bytes[1] != 0x01 || (bytes[2] >= 0x02 && !(bytes[2] == 0x0D && bytes[3] == 0xB8));
}

}  // namespace

bool is_public_address(const sockaddr& address) {
  if (address.sa_family == AF_INET) {
    sockaddr_in ipv4{};
    std::memcpy(&ipv4, &address, sizeof ipv4);
    return is_public(ntohl(ipv4.sin_addr.s_addr));
  }
  if (address.sa_family != AF_INET6) return false;
  sockaddr_in6 ipv6{};
  std::memcpy(&ipv6, &address, sizeof ipv6);
  return is_public(ipv6.sin6_addr);
}

}  // namespace hyades::farm
