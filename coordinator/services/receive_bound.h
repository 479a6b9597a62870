#pragma once

#include <cstdint>
#include <optional>

#include "core/base/descriptor.h"

namespace hyades::coordinator {

/// Lets the kernel keep of whoever connects to this listening socket where their bytes begin
/// (TCP_SAVE_SYN); false where it cannot.
bool keep_beginnings(const core::Descriptor& listening);

/// The sequence number before that of an accepted connection's first byte, which the kernel tells
/// once. Nothing where it has not kept it, as when it answers a flood of them with cookies
/// (`net.ipv4.tcp_syncookies`).
std::optional<uint32_t> take_beginning(const core::Descriptor& socket);

/// Lets no more than the first `most` bytes (below 2^31) of a connection in: the kernel drops what
/// comes after them (a socket filter over sequence numbers, RFC 9293 section 3.4), and the other
/// side sends it again until the bound is raised by another call, or lifted. What has come before
/// the first call stays.
void bound_received(const core::Descriptor& socket, uint32_t beginning, uint32_t most);

/// Lets everything in again.
void lift_bound(const core::Descriptor& socket);

/// How many bytes of a connection have come in; 0 where the kernel does not tell.
uint64_t bytes_received(const core::Descriptor& socket);

}  // namespace hyades::coordinator
