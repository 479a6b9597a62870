#include "core/base/address.h"

#include <arpa/inet.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <system_error>

namespace hyades::core {
namespace {

constexpr std::string_view kHostCharacters =
    "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.-_";

bool is_host(const std::string& host) {
  if (!host.starts_with('[')) {
    return !host.empty() && host.find_first_not_of(kHostCharacters) == std::string::npos;
  }
  if (!host.ends_with(']')) return false;
  // A link-local address may name its interface: [fe80::1%eth0].
  const std::string address = host.substr(1, std::min(host.find('%'), host.size() - 1) - 1);
  in6_addr parsed{};
  return inet_pton(AF_INET6, address.c_str(), &parsed) == 1;
}

bool is_port(std::string_view text) {
  uint16_t port = 0;
  const auto [last, error] = std::from_chars(text.data(), text.data() + text.size(), port);
  return error == std::errc() && last == text.data() + text.size();
}

}  // namespace

Status check_address(const std::string& text) {
  const size_t colon = text.rfind(':');
  if (colon != std::string::npos && is_host(text.substr(0, colon)) &&
      is_port(std::string_view(text).substr(colon + 1))) {
    return {};
  }
  return Error{"expected HOST:PORT (an IPv6 address in brackets, a port up to 65535), not '" +
               text + "'"};
}

Address split_address(const std::string& text) {
  const size_t colon = text.rfind(':');
  Address address{text.substr(0, colon), text.substr(colon + 1)};
  if (address.host.starts_with('[')) {
    address.host = address.host.substr(1, address.host.size() - 2);
  }
  return address;
}

}  // namespace hyades::core
