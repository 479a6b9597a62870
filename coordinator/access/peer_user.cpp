#include "coordinator/access/peer_user.h"

#include <arpa/inet.h>
#include <linux/inet_diag.h>
#include <linux/netlink.h>
#include <linux/sock_diag.h>
#include <linux/tcp.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <sstream>
#include <system_error>

#include "coordinator/access/address.h"
#include "core/base/descriptor.h"

namespace hyades::coordinator {
namespace {

constexpr uint8_t kEstablished = 1;  ///< as the kernel counts the states of TCP

/// An address and its port, both in the network's order.
struct Place {
  int family = AF_UNSPEC;
  std::array<uint32_t, 4> host{};
  in_port_t port = 0;
};

std::optional<Place> read_place(const std::string& text) {
  const HostAndPort parts = split_address(text);
  Place place;
  uint16_t port = 0;
  const char* end = parts.port.data() + parts.port.size();
  if (std::from_chars(parts.port.data(), end, port).ptr != end) return std::nullopt;
  place.port = htons(port);
  for (const int family : {AF_INET, AF_INET6}) {
    if (::inet_pton(family, parts.host.c_str(), place.host.data()) == 1) place.family = family;
  }
  return place.family == AF_UNSPEC ? std::nullopt : std::optional(place);
}

/// What the kernel is asked about sockets of TCP (sock_diag(7)), and what it answers.
struct Question {
  nlmsghdr head{};
  inet_diag_req_v2 wanted{};
};
struct Told {
  nlmsghdr head{};
  inet_diag_msg found{};
  std::array<std::byte, 512> more{};
};

Question question_about(int family) {
  Question question;
  question.head.nlmsg_len = sizeof question;
  question.head.nlmsg_type = SOCK_DIAG_BY_FAMILY;
  question.head.nlmsg_flags = NLM_F_REQUEST;
  question.wanted.sdiag_family = static_cast<uint8_t>(family);
  question.wanted.sdiag_protocol = IPPROTO_TCP;
  return question;
}

/// The kernel's answer, what it does not fill being zero; nothing where it gives none.
std::optional<Told> ask_kernel(const Question& question) {
  const core::Descriptor kernel(::socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_SOCK_DIAG));
  if (!kernel.valid() || ::send(kernel.get(), &question, sizeof question, 0) < 0) {
    return std::nullopt;
  }
  Told told;
  const ssize_t got = ::recv(kernel.get(), &told, sizeof told, MSG_DONTWAIT);
  return got < static_cast<ssize_t>(sizeof told.head) ? std::nullopt : std::optional(told);
}

/// The kernel's answer to a list of connections, of which it has none to show.
int list_error(const Told& told) {
  int error = 0;
  std::memcpy(&error, &told.found, sizeof error);
  return error;
}

/// Whether the kernel has a name of its own for each user here. In a user namespace it calls all
/// those that are not mapped by one number (user_namespaces(7)), which may be ours too.
bool are_all_users_mapped() {
  std::ifstream map("/proc/self/uid_map");
  uint64_t inside = 1, outside = 1, count = 0;
  map >> inside >> outside >> count;
  return inside == 0 && count >= 0xffffffff;
}

uid_t overflow_user() {
  uid_t number = 65534;
  std::ifstream("/proc/sys/kernel/overflowuid") >> number;
  return number;
}

/// The user of this number; nothing where many may be meant.
std::optional<uid_t> one_user(uid_t user) {
  static const uid_t kOfMany = overflow_user();
  return user != kOfMany || are_all_users_mapped() ? std::optional(user) : std::nullopt;
}

/// Who holds the end at `peer` of the connection from there to `own`; nothing where the kernel
/// knows none, or cannot tell.
std::optional<uid_t> holder(const Place& peer, const Place& own) {
  Question question = question_about(peer.family);
  question.wanted.idiag_states = 1U << kEstablished;
  question.wanted.id.idiag_sport = peer.port;
  question.wanted.id.idiag_dport = own.port;
  std::memcpy(question.wanted.id.idiag_src, peer.host.data(), sizeof peer.host);
  std::memcpy(question.wanted.id.idiag_dst, own.host.data(), sizeof own.host);
  // All that this machine says to itself comes by there; of sockets that are bound to a device
  // those to another are not found, and without a device none.
  static const unsigned kLoopback = ::if_nametoindex("lo");
  question.wanted.id.idiag_if = kLoopback;
  for (uint32_t& any : question.wanted.id.idiag_cookie) any = INET_DIAG_NOCOOKIE;
  const auto told = ask_kernel(question);
  if (!told || told->head.nlmsg_type != SOCK_DIAG_BY_FAMILY ||
      told->found.idiag_state != kEstablished || told->found.idiag_inode == 0) {
    return std::nullopt;
  }
  return one_user(told->found.idiag_uid);
}

/// Whether the kernel can tell at all: one that was built without says of each connection that
/// there is none. A list of those in no state ends at once where it can, and where it only knows
/// other protocols than TCP it ends with an error.
bool kernel_can_tell(int family) {
  Question question = question_about(family);
  question.head.nlmsg_flags |= NLM_F_DUMP;
  const auto told = ask_kernel(question);
  return told && told->head.nlmsg_type == NLMSG_DONE &&
         told->head.nlmsg_len >= sizeof told->head + sizeof(int) && list_error(*told) >= 0;
}

/// Of "0100007F:1F90": words of 32 bits in the processor's order, and the port as a number.
std::optional<Place> read_row(const std::string& text) {
  const size_t colon = text.find(':');
  if (colon != 8 && colon != 32) return std::nullopt;
  Place place;
  place.family = colon == 8 ? AF_INET : AF_INET6;
  for (size_t i = 0; i * 8 < colon; ++i) {
    const char* from = text.data() + i * 8;
    if (std::from_chars(from, from + 8, place.host[i], 16).ptr != from + 8) return std::nullopt;
  }
  const char* end = text.data() + text.size();
  uint16_t port = 0;
  if (std::from_chars(text.data() + colon + 1, end, port, 16).ptr != end) return std::nullopt;
  place.port = htons(port);
  return place;
}

/// The group of all users of this machine but our own.
constexpr const char* kOthers = "users of this machine";

Neighbour neighbour_of_this_machine(uid_t user, const std::string& host) {
  if (is_own_user(user)) return {"this user at " + host, "", true};
  return {"user " + std::to_string(user), kOthers};
}

std::string text_of(const Place& place) {
  std::array<char, INET6_ADDRSTRLEN> host{};
  (void)::inet_ntop(place.family, place.host.data(), host.data(), host.size());
  return address_text(host.data(), std::to_string(ntohs(place.port)));
}

/// Who holds it by the table of all connections.
std::optional<uid_t> read_table(const std::string& peer, const std::string& own) {
  for (const char* path : {"/proc/net/tcp", "/proc/net/tcp6"}) {
    std::ifstream lines(path);
    std::string line;
    std::getline(lines, line);  // what the columns are
    while (std::getline(lines, line)) {
      std::istringstream words(line);
      std::string number, local, remote, state, queues, timer, retransmits, timeout;
      uid_t user = 0;
      uint64_t inode = 0;
      if (!(words >> number >> local >> remote >> state >> queues >> timer >> retransmits >> user >>
            timeout >> inode)) {
        continue;
      }
      if (state != "01" || inode == 0) continue;  // not established, or nobody's
      const auto from = read_row(local);
      const auto to = read_row(remote);
      if (from && to && text_of(*from) == peer && text_of(*to) == own) return one_user(user);
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<uid_t> user_of_peer(const std::string& peer, const std::string& own) {
  const auto from = read_place(peer);
  const auto to = read_place(own);
  if (!from || !to || from->family != to->family) return std::nullopt;
  if (const auto user = holder(*from, *to)) return user;
  // Who is not found has gone mostly, and hears no answer: nobody shall wait for that.
  return kernel_can_tell(from->family) ? std::nullopt : read_table(peer, own);
}

bool is_own_user(uid_t user) { return user == ::geteuid() || user == 0; }

std::string own_end(int socket) {
  tcp_info info{};
  socklen_t size = sizeof info;
  if (::getsockopt(socket, IPPROTO_TCP, TCP_INFO, &info, &size) != 0 ||
      info.tcpi_state != kEstablished) {
    return {};
  }
  sockaddr_storage own{};
  size = sizeof own;
  if (::getsockname(socket, reinterpret_cast<sockaddr*>(&own), &size) != 0) return {};
  Place place{own.ss_family, {}, 0};
  if (own.ss_family == AF_INET) {
    const auto& four = reinterpret_cast<const sockaddr_in&>(own);
    std::memcpy(place.host.data(), &four.sin_addr, sizeof four.sin_addr);
    place.port = four.sin_port;
  } else if (own.ss_family == AF_INET6) {
    const auto& six = reinterpret_cast<const sockaddr_in6&>(own);
    std::memcpy(place.host.data(), &six.sin6_addr, sizeof six.sin6_addr);
    place.port = six.sin6_port;
  } else {
    return {};
  }
  return text_of(place);
}

Neighbour neighbour_at(const std::string& peer, int socket) {
  const std::string own = own_end(socket);
  const std::string from = split_address(peer).host;
  const auto there = read_place(peer);
  const auto here = read_place(own);
  const bool whole = there && here && there->family == here->family;
  // He may come by any address that this machine has.
  const auto user = whole ? holder(*there, *here) : std::nullopt;
  if (user) return neighbour_of_this_machine(*user, from);
  const bool is_local =
      from.starts_with("127.") || from == "::1" || from == split_address(own).host;
  return is_local ? Neighbour{"this machine", kOthers}
                  : Neighbour{neighbourhood_of(peer), site_of(peer)};
}

}  // namespace hyades::coordinator
