#pragma once

#include <sys/types.h>

#include <cstdint>
#include <optional>
#include <set>
#include <string>

namespace hyades::coordinator {

/// The user whose process holds the other end of a TCP connection from this machine to one of our
/// `ports`, as the kernel tells of its open connections (/proc/net/tcp, proc_pid_net(5)). `peer`:
/// its address as address_text() has it. Nothing where there is no such connection, or it is
/// closing: what nobody holds any more counts as root's there.
std::optional<uid_t> user_of_peer(const std::string& peer, const std::set<uint16_t>& ports);

}  // namespace hyades::coordinator
