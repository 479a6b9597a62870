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

/// Listens at HOST:PORT, at all of this machine's addresses that HOST stands for; 0.0.0.0 and [::]
/// are all of IPv4 and IPv6 there are. Port 0: one that is free. The sockets do not block, and are
/// not shared with other processes: a second coordinator on the same port is a mistake.
core::Result<Listening> listen_at(const std::string& address);

}  // namespace hyades::coordinator
