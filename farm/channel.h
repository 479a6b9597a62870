#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace grpc {
class Channel;
class ClientContext;
class ServerCredentials;
}  // namespace grpc

namespace hyades::farm {

/// How a client or a worker reaches its coordinator.
struct Peer {
  /// HOST:PORT, or those of several coordinators, of which one leads, with commas between.
  std::string address = "127.0.0.1:7700";
  std::string ca_file;    ///< PEM: who signed the coordinator's certificate; empty: plaintext
  std::string cert_file;  ///< PEM, with key_file: shown to a coordinator that asks; empty: none
  std::string key_file;
  std::string token_file;  ///< holds the farm's token; empty: none
  bool insecure = false;   ///< plaintext also beyond this machine
};

/// How a coordinator is reached.
struct Listen {
  std::string address = "localhost:7700";  ///< HOST:PORT; port 0: one that is free
  std::string cert_file;                   ///< PEM, with key_file: TLS
  std::string key_file;
  std::string ca_file;  ///< PEM: clients must show a certificate that it signed; empty: need not
  std::string worker_ca_file;  ///< PEM: the same of workers alone
  std::string token_file;      ///< holds one token for all; empty: none
  bool asks_tokens = false;    ///< every call must carry a token, whether there is a file or not
  bool insecure = false;       ///< plaintext or no token also beyond this machine
};

/// A line of at least 16 printable characters; an empty file name gives an empty token. Errors name
/// the file.
core::Result<std::string> read_token(const std::string& file);

/// The addresses of Peer::address one by one; where a comma has nothing on a side, an empty one.
std::vector<std::string> split_addresses(const std::string& text);

/// Whether HOST:PORT stays on this machine: 127.x.y.z, [::1], localhost.
bool is_loopback(const std::string& address);

/// Whether all that is said to `peer`, tokens too, can be read by whoever listens: plain text that
/// leaves this machine. What to tell people then; empty: it cannot.
std::string plaintext_warning(const Peer& peer);

/// How soon keepalive pings notice that a peer is dead or frozen while it is called.
enum class Notices {
  patiently,  ///< within 30 s
  soon        ///< within 6 s: another one may have taken its place
};

/// A connection that reconnects by itself, to a `peer` of one address; its files have been read,
/// and certificates are read again when they change. Thread-safe; nothing is contacted yet. An
/// error where a file is not what it should be, or plaintext would leave this machine without
/// `insecure`.
core::Result<std::shared_ptr<grpc::Channel>> connect(const Peer& peer,
                                                     Notices notices = Notices::patiently);

/// What is amiss with TLS where gRPC could not connect to `peer` and says `message`; nothing where
/// it is something else.
std::optional<std::string> tls_trouble(const std::string& message, const Peer& peer);

/// Why there is no connection to `peer`, in one line that stays the same while the reason does.
std::string connection_trouble(const std::string& message, const Peer& peer);

/// What every call carries: protocol version, token, and a deadline (none where `timeout` is 0, for
/// streams without end).
void prepare(grpc::ClientContext& context, const std::string& token,
             std::chrono::milliseconds timeout);

/// What a coordinator needs in order to listen; the files of its `Listen` have been read, and
/// certificates are read again when they change.
struct Door {
  std::string address;
  std::shared_ptr<grpc::ServerCredentials> credentials;
  std::string token;          ///< one for all; empty: none
  bool workers_show = false;  ///< workers must have shown a certificate
};

/// An error, which names the file if it is one's fault, where `listen` does not hold together, or
/// where plaintext or an open door would be offered beyond this machine without `insecure`.
core::Result<Door> open_door(const Listen& listen);

/// Keepalive pings of a client must be so far apart, or the coordinator hangs up.
inline constexpr std::chrono::milliseconds kLeastPingInterval{1000};

/// The names of the metadata of every call.
inline constexpr const char* kProtocolKey = "hyades-protocol";
inline constexpr const char* kTokenKey = "authorization";  ///< "Bearer TOKEN"

}  // namespace hyades::farm
