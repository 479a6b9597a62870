#pragma once

#include <sys/types.h>

#include <set>
#include <string>

namespace hyades::coordinator {

/// The users whose processes hold the other end of TCP connections from `peer`, an address of this
/// machine, to `ours`, at which we listen; all as address_text() has them. They are several where
/// one user has taken the port of another for a connection to another of our addresses. None where
/// there is no such connection, or it is closing: what nobody holds any more counts as root's.
///
/// The kernel is asked anew each time, for a port may be another user's at once. It finds one
/// connection in microseconds (sock_diag(7)), if we name both ends: of those to a socket that
/// listens at all addresses it finds none, but such a coordinator asks for tokens. Only where it
/// cannot tell, because it was built without that, we read the table of all connections
/// (/proc/net/tcp, proc_pid_net(5)), which takes milliseconds and more the more there are.
std::set<uid_t> users_of_peer(const std::string& peer, const std::set<std::string>& ours);

}  // namespace hyades::coordinator
