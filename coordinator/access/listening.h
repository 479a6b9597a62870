#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/descriptor.h"
#include "core/base/result.h"

namespace hyades::coordinator {

/// Sockets at which others may connect, and their port.
struct Listening {
  std::vector<core::Descriptor> sockets;
  uint16_t port = 0;
};

/// Listens at each HOST:PORT, at all addresses that HOST stands for: at one that we left another
/// user could take our place. 0.0.0.0 and [::] are all of IPv4 and IPv6 there are, and localhost is
/// both loopbacks, whatever this machine's list of hosts says: callers may not look there (RFC
/// 6761, section 6.3). Port 0: one that is free. An error that names the first address that will
/// not do; only [::1] may be missing where others are there, as it is on machines without IPv6. The
/// sockets do not block, send without delay, and are not shared with other processes: a second
/// coordinator on the same port is a mistake.
core::Result<Listening> listen_at(const std::vector<std::string>& addresses);

}  // namespace hyades::coordinator
