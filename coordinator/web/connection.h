#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include <boost/asio/ip/tcp.hpp>

#include "coordinator/access/authority.h"
#include "coordinator/access/peer_user.h"
#include "coordinator/controller/owner_connections.h"
#include "coordinator/web/connection_count.h"
#include "coordinator/web/exchange.h"
#include "coordinator/web/io_handle.h"
#include "farm/byte_budget.h"
#include "farm/thread_pool.h"

namespace boost::asio::ssl {
class context;
}

namespace hyades::coordinator {

class Meters;

/// One connection, over which requests come one after the other. Everything but push() and end()
/// happens on the network's thread.
class Connection : public LiveReader {
 public:
  /// Begins to read requests. From then on ConnectionWorld::open keeps the connection alive.
  virtual void begin() = 0;
};

/// What all connections of a server share.
struct ConnectionWorld {
  /// Of the bodies of all requests in work together, and of those of one caller; of answers, too.
  static constexpr uint64_t kMostBytes = uint64_t{256} << 20U;
  static constexpr uint64_t kMostBytesOfOne = kMostBytes / 4;

  /// What becomes of a request whose body has not been read yet.
  struct Admitted {
    uint64_t most_bytes = 0;            ///< that its body may have
    std::optional<WebReply> refusal{};  ///< the answer, where it may not come in
  };
  /// Looks whether a request may come in, by all but its body, and puts in who asks; by a
  /// connection with this end of ours.
  std::function<Admitted(WebRequest&, const OwnEnd&)> admit;
  /// Registers a caller whose answer takes its time (Authority::visit).
  std::function<std::unique_ptr<Visit>(const Caller&, std::function<void(const grpc::Status&)>)>
      visit;
  /// Counts such a caller's connection for its owner (count_connection()).
  std::function<std::unique_ptr<OwnerConnections::Entry>(const Caller&, grpc::Status& refused)>
      entry;
  /// Answers a request; called by the network's thread.
  std::function<void(WebRequest, Answer)> serve;
  farm::ThreadPool& files;  ///< who reads what is sent from the disk
  std::shared_ptr<IoHandle> io;
  Meters& meters;
  /// What the bodies of requests in work may have together. Small ones are not counted. Outlives
  /// all connections, as the other one does.
  farm::ByteBudget& bodies;
  /// What answers may have in memory together that are read by one connection alone: a text, but
  /// for small ones; of a BodySource the piece that is on its way, and what it keeps.
  farm::ByteBudget& answers;

  // Of the network's thread.
  ConnectionCount count;
  /// Whether a connection ends with the answer to its first request.
  bool one_request = false;
  std::set<std::shared_ptr<Connection>> open{};
  /// What a reader may take for a piece of at most a megabyte.
  std::chrono::milliseconds send_patience{60'000};
};

/// A connection over an accepted socket, from `address` (address_text()). `owner`: whom it is
/// counted for. `tls`: null for plain text. The world outlives it.
std::shared_ptr<Connection> make_connection(boost::asio::ip::tcp::socket socket,
                                            std::string address, Neighbour owner,
                                            const std::shared_ptr<boost::asio::ssl::context>& tls,
                                            ConnectionWorld& world);

}  // namespace hyades::coordinator
