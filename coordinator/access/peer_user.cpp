#include "coordinator/access/peer_user.h"

#include <arpa/inet.h>
#include <linux/inet_diag.h>
#include <linux/netlink.h>
#include <linux/sock_diag.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <optional>
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

/// The kernel's answer; nothing where it gives none.
std::optional<Told> ask_kernel(const Question& question) {
  const core::Descriptor kernel(::socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_SOCK_DIAG));
  if (!kernel.valid() || ::send(kernel.get(), &question, sizeof question, 0) < 0) {
    return std::nullopt;
  }
  Told told;
  const ssize_t got = ::recv(kernel.get(), &told, sizeof told, MSG_DONTWAIT);
  return got < static_cast<ssize_t>(sizeof told.head) ? std::nullopt : std::optional(told);
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
  for (uint32_t& any : question.wanted.id.idiag_cookie) any = INET_DIAG_NOCOOKIE;
  const auto told = ask_kernel(question);
  if (!told || told->head.nlmsg_type != SOCK_DIAG_BY_FAMILY ||
      told->found.idiag_state != kEstablished) {
    return std::nullopt;
  }
  return told->found.idiag_uid;
}

/// Whether the kernel can tell at all: one that was built without says of each connection that
/// there is none. A list of those in no state ends at once where it can.
bool kernel_can_tell(int family) {
  Question question = question_about(family);
  question.head.nlmsg_flags |= NLM_F_DUMP;
  const auto told = ask_kernel(question);
  return told && told->head.nlmsg_type == NLMSG_DONE;
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

std::string text_of(const Place& place) {
  std::array<char, INET6_ADDRSTRLEN> host{};
  (void)::inet_ntop(place.family, place.host.data(), host.data(), host.size());
  return address_text(host.data(), std::to_string(ntohs(place.port)));
}

/// Of connections to any of our addresses.
std::set<uid_t> read_table(const std::string& peer, const std::set<in_port_t>& ports) {
  std::set<uid_t> users;
  for (const char* path : {"/proc/net/tcp", "/proc/net/tcp6"}) {
    std::ifstream lines(path);
    std::string line;
    std::getline(lines, line);  // what the columns are
    while (std::getline(lines, line)) {
      std::istringstream words(line);
      std::string number, local, remote, state, queues, timer, retransmits;
      uid_t user = 0;
      if (!(words >> number >> local >> remote >> state >> queues >> timer >> retransmits >>
            user)) {
        continue;
      }
      if (state != "01") continue;  // established
      const auto to = read_row(remote);
      const auto from = read_row(local);
      if (from && to && ports.contains(to->port) && text_of(*from) == peer) users.insert(user);
    }
  }
  return users;
}

}  // namespace

std::set<uid_t> users_of_peer(const std::string& peer, const std::set<std::string>& ours) {
  const auto from = read_place(peer);
  if (!from) return {};
  std::set<uid_t> users;
  std::set<in_port_t> ports;
  for (const std::string& each : ours) {
    const auto own = read_place(each);
    if (!own) continue;
    ports.insert(own->port);
    if (own->family != from->family) continue;
    if (const auto user = holder(*from, *own)) users.insert(*user);
  }
  // Who is not found has gone mostly, and hears no answer: nobody shall wait for that.
  return !users.empty() || kernel_can_tell(from->family) ? users : read_table(peer, ports);
}

}  // namespace hyades::coordinator
