#pragma once

#include <sys/types.h>

#include <functional>
#include <optional>
#include <string>

namespace hyades::coordinator {

/// The user whose process holds the other end of the TCP connection from `peer` to `own`. `peer` is
/// an address of this machine, `own` that address of ours at which the connection came in; both as
/// address_text() has them.
///
/// Nothing where there is no such connection, or no process holds that end any more. close() can
/// leave such ends open (of MPTCP, say), and until Linux 6.16 the kernel says that they are root's.
/// The answer is about this connection alone: to each address of ours another user's may come from
/// the same port. So `own` has to be this connection's (own_end()).
///
/// The kernel is asked anew each time, for a port may be another user's at once. It finds one
/// connection in microseconds (sock_diag(7)), as we name both ends. Only where it cannot tell,
/// because it was built without that or nobody may ask, we read the table of all connections
/// (/proc/net/tcp, proc_pid_net(5)), which takes milliseconds and more the more there are.
std::optional<uid_t> user_of_peer(const std::string& peer, const std::string& own);

/// Whether this is the user whose process we are, or root, who may do all that he may.
bool is_own_user(uid_t user);

/// Our address that this accepted socket is at, as address_text() has it; empty once either side
/// has ended the connection. Where it is there both before and after user_of_peer() was asked, that
/// answer is about this connection: the kernel has no other between the same two ends meanwhile.
std::string own_end(int socket);

/// Who counts as one caller where connections are bounded.
struct Neighbour {
  std::string name;
  /// Several that may be one: other users of this machine, of whom one may make many (user
  /// namespaces), or site_of() an address; empty: none.
  std::string group{};
  bool is_own_user = false;  ///< this process's user or root, on this machine
};

/// Whose the accepted `socket` is, from `peer` (as address_text() has it). From another machine it
/// is neighbourhood_of() the address. Users of this machine share its addresses: here it is the
/// user who has the other end, by however many addresses he comes, and of our own user each
/// address. Those of whom the kernel does not say so in microseconds are one caller.
Neighbour neighbour_at(const std::string& peer, int socket);

/// own_end() of the connection by which somebody calls.
using OwnEnd = std::function<std::string()>;

}  // namespace hyades::coordinator
