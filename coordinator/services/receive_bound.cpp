#include "coordinator/services/receive_bound.h"

#include <arpa/inet.h>
#include <linux/filter.h>
#include <linux/tcp.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <cstddef>
#include <cstring>
#include <span>
#include <vector>

namespace hyades::coordinator {
namespace {

/// Where they stand in a TCP header.
constexpr size_t kSequence = 4;
constexpr size_t kHeaderLength = 12;
constexpr size_t kHeaderOfIpv6 = 40;

/// Where the TCP header begins in a packet from its IP header on (RFC 791; RFC 8200 section 4).
std::optional<size_t> tcp_header(std::span<const uint8_t> packet) {
  if (packet.empty()) return std::nullopt;
  if (packet[0] >> 4U == 4) return size_t{4} * (packet[0] & 15U);
  if (packet.size() < kHeaderOfIpv6) return std::nullopt;
  uint8_t next = packet[6];
  size_t at = kHeaderOfIpv6;
  while (next != IPPROTO_TCP) {
    if (at + 2 > packet.size()) return std::nullopt;
    // All that may stand before it tell their length in the same way, but for these two.
    const size_t length = next == IPPROTO_FRAGMENT ? 8
                          : next == IPPROTO_AH     ? 4 * (size_t{packet[at + 1]} + 2)
                                                   : 8 * (size_t{packet[at + 1]} + 1);
    next = packet[at];
    at += length;
  }
  return at;
}

}  // namespace

bool keep_beginnings(const core::Descriptor& listening) {
  const int yes = 1;
  return ::setsockopt(listening.get(), IPPROTO_TCP, TCP_SAVE_SYN, &yes, sizeof yes) == 0;
}

std::optional<uint32_t> take_beginning(const core::Descriptor& socket) {
  // Headers of IPv6 may fill a packet, which without being put together has 64 KiB at most.
  std::vector<uint8_t> headers(size_t{64} << 10U);
  auto size = static_cast<socklen_t>(headers.size());
  if (::getsockopt(socket.get(), IPPROTO_TCP, TCP_SAVED_SYN, headers.data(), &size) != 0) {
    return std::nullopt;
  }
  const std::optional<size_t> tcp = tcp_header({headers.data(), size});
  if (!tcp || *tcp + kSequence + sizeof(uint32_t) > size) return std::nullopt;
  uint32_t sequence = 0;
  std::memcpy(&sequence, headers.data() + *tcp + kSequence, sizeof sequence);
  return ntohl(sequence);
}

void bound_received(const core::Descriptor& socket, uint32_t beginning, uint32_t most) {
  // The filter sees a packet from its TCP header on, and answers how much of it is kept. Of two
  // sequence numbers nothing but the difference counts: between them they may start again from 0.
  const uint32_t end = most + 1;
  std::array<sock_filter, 13> program{{
      {BPF_LD | BPF_W | BPF_ABS, 0, 0, kSequence},
      {BPF_ALU | BPF_SUB | BPF_K, 0, 0, beginning},
      {BPF_JMP | BPF_JGE | BPF_K, 0, 1, end},
      {BPF_RET | BPF_K, 0, 0, 0},
      {BPF_MISC | BPF_TAX, 0, 0, 0},
      {BPF_LD | BPF_IMM, 0, 0, end},
      {BPF_ALU | BPF_SUB | BPF_X, 0, 0, 0},
      {BPF_MISC | BPF_TAX, 0, 0, 0},
      {BPF_LD | BPF_B | BPF_ABS, 0, 0, kHeaderLength},
      // In the upper half of its byte, in words of four bytes.
      {BPF_ALU | BPF_AND | BPF_K, 0, 0, 0xF0},
      {BPF_ALU | BPF_RSH | BPF_K, 0, 0, 2},
      {BPF_ALU | BPF_ADD | BPF_X, 0, 0, 0},
      {BPF_RET | BPF_A, 0, 0, 0},
  }};
  const sock_fprog filter{program.size(), program.data()};
  (void)::setsockopt(socket.get(), SOL_SOCKET, SO_ATTACH_FILTER, &filter, sizeof filter);
}

void lift_bound(const core::Descriptor& socket) {
  const int unused = 0;
  (void)::setsockopt(socket.get(), SOL_SOCKET, SO_DETACH_FILTER, &unused, sizeof unused);
}

uint64_t bytes_received(const core::Descriptor& socket) {
  tcp_info info{};
  socklen_t size = sizeof info;
  if (::getsockopt(socket.get(), IPPROTO_TCP, TCP_INFO, &info, &size) != 0) return 0;
  return info.tcpi_bytes_received;
}

}  // namespace hyades::coordinator
