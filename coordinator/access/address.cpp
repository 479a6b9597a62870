#include "coordinator/access/address.h"

#include <arpa/inet.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>

namespace hyades::coordinator {
namespace {

using Bytes = std::array<unsigned char, 16>;

std::optional<Bytes> ipv6(const std::string& text) {
  Bytes bytes{};
  // What follows '%' names an interface of this machine.
  if (::inet_pton(AF_INET6, text.substr(0, text.find('%')).c_str(), bytes.data()) != 1) {
    return std::nullopt;
  }
  return bytes;
}

std::string text_of(int family, const void* bytes) {
  std::array<char, INET6_ADDRSTRLEN> text{};
  return ::inet_ntop(family, bytes, text.data(), text.size()) == nullptr ? "" : text.data();
}

void replace(std::string& text, std::string_view what, std::string_view by) {
  if (const size_t at = text.find(what); at != std::string::npos) text.replace(at, what.size(), by);
}

std::string host_of(const std::string& address) { return address.substr(0, address.rfind(':')); }

/// The network of so many bits that an IPv6 address is in; empty of others.
std::string network_of(const std::string& address, size_t bits) {
  const std::string host = host_of(address);
  if (!host.starts_with('[') || !host.ends_with(']')) return {};
  auto bytes = ipv6(host.substr(1, host.size() - 2));
  if (!bytes) return {};
  std::fill(bytes->begin() + static_cast<ptrdiff_t>(bits / 8), bytes->end(),
            static_cast<unsigned char>(0));
  return text_of(AF_INET6, bytes->data()) + "/" + std::to_string(bits);
}

}  // namespace

HostAndPort split_address(const std::string& address) {
  const size_t colon = address.rfind(':');
  if (colon == std::string::npos) return {address, ""};
  std::string host = address.substr(0, colon);
  if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
  return {host, address.substr(colon + 1)};
}

std::string address_text(const std::string& host, const std::string& port) {
  const auto bytes = ipv6(host);
  if (!bytes) return host + ":" + port;
  constexpr Bytes kMapped = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xFF, 0xFF};
  constexpr size_t kPrefix = 12;
  if (std::equal(kMapped.begin(), kMapped.begin() + kPrefix, bytes->begin())) {
    return text_of(AF_INET, bytes->data() + kPrefix) + ":" + port;
  }
  return "[" + text_of(AF_INET6, bytes->data()) + "]:" + port;
}

std::string address_of_peer(std::string_view peer) {
  const bool four = peer.starts_with("ipv4:");
  if (!four && !peer.starts_with("ipv6:")) return std::string(peer);
  std::string text(peer.substr(5));
  replace(text, "%5B", "[");
  replace(text, "%5D", "]");
  const size_t colon = text.rfind(':');
  if (colon == std::string::npos) return std::string(peer);
  std::string host = text.substr(0, colon);
  if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
  return address_text(host, text.substr(colon + 1));
}

std::string neighbourhood_of(const std::string& address) {
  const std::string network = network_of(address, 64);
  return network.empty() ? host_of(address) : network;
}

std::string site_of(const std::string& address) { return network_of(address, 48); }

}  // namespace hyades::coordinator
