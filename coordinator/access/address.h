#pragma once

#include <string>
#include <string_view>

namespace hyades::coordinator {

/// The two parts of "HOST:PORT"; an IPv6 address is written "[HOST]:PORT".
struct HostAndPort {
  std::string host;
  std::string port;
};
HostAndPort split_address(const std::string& address);

/// Where a call comes from, in one form whichever way it came: "192.0.2.7:5000",
/// "[2001:db8::1]:5000". `host` may be an IPv6 address of an IPv4 one (::ffff:192.0.2.7), which
/// becomes that.
std::string address_text(const std::string& host, const std::string& port);

/// The address_text of what gRPC calls a peer: "ipv4:192.0.2.7:5000",
/// "ipv6:%5B2001:db8::1%5D:5000". What is neither (a socket of this machine) stays as it is.
std::string address_of_peer(std::string_view peer);

/// What counts as one caller where calls are limited: an IPv4 address, or the /64 network of an
/// IPv6 one, of which anybody who has one address has them all. `address` as address_text() has it.
std::string neighbourhood_of(const std::string& address);

/// The /48 network of an IPv6 address, as one customer of a network may have; empty of IPv4.
/// `address` as address_text() has it.
std::string site_of(const std::string& address);

}  // namespace hyades::coordinator
