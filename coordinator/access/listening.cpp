#include "coordinator/access/listening.h"

#include <arpa/inet.h>
#include <linux/tcp.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <memory>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "coordinator/access/address.h"
#include "core/base/text.h"

namespace hyades::coordinator {
namespace {

/// Connections in the kernel's hands until accept().
constexpr int kBacklog = 4096;

struct Endpoint {
  sockaddr_storage address{};
  socklen_t size = 0;

  int family() const { return address.ss_family; }
  in_port_t& port() {
    return family() == AF_INET ? reinterpret_cast<sockaddr_in&>(address).sin_port
                               : reinterpret_cast<sockaddr_in6&>(address).sin6_port;
  }
  bool is_wildcard() const {
    if (family() == AF_INET) {
      return reinterpret_cast<const sockaddr_in&>(address).sin_addr.s_addr == INADDR_ANY;
    }
    return IN6_IS_ADDR_UNSPECIFIED(&reinterpret_cast<const sockaddr_in6&>(address).sin6_addr);
  }
  bool is_loopback_of_ipv6() const {
    return family() == AF_INET6 &&
           IN6_IS_ADDR_LOOPBACK(&reinterpret_cast<const sockaddr_in6&>(address).sin6_addr);
  }
  std::string text() const {
    std::array<char, INET6_ADDRSTRLEN> host{};
    const void* bytes =
        family() == AF_INET
            ? static_cast<const void*>(&reinterpret_cast<const sockaddr_in&>(address).sin_addr)
            : &reinterpret_cast<const sockaddr_in6&>(address).sin6_addr;
    return ::inet_ntop(family(), bytes, host.data(), host.size()) == nullptr ? "?" : host.data();
  }
  bool operator==(const Endpoint& other) const {
    return size == other.size && std::memcmp(&address, &other.address, size) == 0;
  }
};

/// Of any family.
Endpoint wildcard(int family, in_port_t port) {
  Endpoint all;
  all.address.ss_family = static_cast<sa_family_t>(family);
  all.size = family == AF_INET ? sizeof(sockaddr_in) : sizeof(sockaddr_in6);
  all.port() = port;
  return all;
}

std::string reason(int error) { return std::error_code(error, std::generic_category()).message(); }

/// Adds the addresses of one host.
core::Status resolve(const char* host, const std::string& port, std::vector<Endpoint>& all) {
  addrinfo hints{};
  hints.ai_flags = AI_PASSIVE | AI_NUMERICSERV;
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const int failed = ::getaddrinfo(host, port.c_str(), &hints, &found);
  if (failed != 0) return core::Error{::gai_strerror(failed)};
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> owned(found, ::freeaddrinfo);
  for (const addrinfo* one = found; one != nullptr; one = one->ai_next) {
    if (one->ai_family != AF_INET && one->ai_family != AF_INET6) continue;
    Endpoint endpoint;
    std::memcpy(&endpoint.address, one->ai_addr, one->ai_addrlen);
    endpoint.size = one->ai_addrlen;
    if (std::find(all.begin(), all.end(), endpoint) == all.end()) all.push_back(endpoint);
  }
  return {};
}

core::Status resolve(const HostAndPort& where, std::vector<Endpoint>& all) {
  const std::string host = core::lower_case(where.host);
  if (host == "localhost" || host == "localhost.") {
    const core::Status found = resolve("127.0.0.1", where.port, all);
    return found ? resolve("::1", where.port, all) : found;
  }
  return resolve(where.host.empty() ? nullptr : where.host.c_str(), where.port, all);
}

bool set(const core::Descriptor& socket, int level, int option, int value) {
  return ::setsockopt(socket.get(), level, option, &value, sizeof value) == 0;
}

/// Listens there, and puts the port in that it got; what errno tells where it does not.
int listen_there(Endpoint& endpoint, core::Descriptor& socket) {
  socket =
      core::Descriptor(::socket(endpoint.family(), SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (!socket.valid()) return errno;
  const bool both = endpoint.family() == AF_INET6 && endpoint.is_wildcard();
  if (!set(socket, SOL_SOCKET, SO_REUSEADDR, 1)) return errno;
  if (endpoint.family() == AF_INET6 && !set(socket, IPPROTO_IPV6, IPV6_V6ONLY, both ? 0 : 1)) {
    return errno;
  }
  (void)set(socket, IPPROTO_TCP, TCP_NODELAY, 1);
  auto* address = reinterpret_cast<sockaddr*>(&endpoint.address);
  if (::bind(socket.get(), address, endpoint.size) != 0) return errno;
  if (::listen(socket.get(), kBacklog) != 0) return errno;
  return ::getsockname(socket.get(), address, &endpoint.size) == 0 ? 0 : errno;
}

}  // namespace

core::Result<Listening> listen_at(const std::vector<std::string>& addresses) {
  const auto fail = [&](const std::string& why) {
    return core::Error{
        fmt::format("{}: cannot listen there ({})", fmt::join(addresses, ", "), why)};
  };
  std::vector<Endpoint> endpoints;
  for (const std::string& address : addresses) {
    const core::Status found = resolve(split_address(address), endpoints);
    if (!found) return fail(found.error().message);
  }
  const auto any = std::find_if(endpoints.begin(), endpoints.end(),
                                [](const Endpoint& one) { return one.is_wildcard(); });
  const bool all = any != endpoints.end();
  if (all) {
    // One socket for both, or, where this machine has no IPv6, for the other alone.
    const in_port_t port = any->port();
    endpoints = {wildcard(AF_INET6, port), wildcard(AF_INET, port)};
  }
  Listening listening;
  const auto may_miss = [&](const Endpoint& one, int why) {
    return (why == EADDRNOTAVAIL || why == EAFNOSUPPORT) && (all || one.is_loopback_of_ipv6());
  };
  int error = EADDRNOTAVAIL;
  for (Endpoint& endpoint : endpoints) {
    if (listening.port != 0) endpoint.port() = htons(listening.port);
    core::Descriptor socket;
    error = listen_there(endpoint, socket);
    if (error == 0) {
      listening.port = ntohs(endpoint.port());
      listening.sockets.push_back(std::move(socket));
      if (all) break;
    } else if (!may_miss(endpoint, error)) {
      return fail(endpoints.size() > 1 ? endpoint.text() + ": " + reason(error) : reason(error));
    }
  }
  if (listening.sockets.empty()) return fail(reason(error));
  return listening;
}

}  // namespace hyades::coordinator
