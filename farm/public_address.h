#pragma once

#include <sys/socket.h>

namespace hyades::farm {

/// Whether `address` (IPv4 or IPv6) is of the public internet: none of this machine, its network,
/// a private one, or of no single machine (the special-purpose registries of IANA, RFC 6890). IPv6
/// addresses that stand for one of IPv4 (mapped, NAT64) are judged as that. Other families: no.
bool is_public_address(const sockaddr& address);

}  // namespace hyades::farm
