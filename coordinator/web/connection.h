#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <set>

#include <boost/asio/ip/tcp.hpp>

#include "coordinator/access/authority.h"
#include "coordinator/controller/thread_pool.h"
#include "coordinator/web/connection_count.h"
#include "coordinator/web/exchange.h"
#include "coordinator/web/io_handle.h"

namespace boost::asio::ssl {
class context;
}

namespace hyades::coordinator {

class Meters;

/// One connection, over which requests come one after the other. Everything but push() and end()
/// happens on the network's thread.
class Connection : public LiveReader {
 public:
  virtual void begin() = 0;
};

/// What all connections share.
struct ConnectionWorld {
  /// What is said of a request before its body is read: how many bytes that may have; or, where it
  /// may not come in at all, the answer.
  struct Admitted {
    uint64_t most_bytes = 0;
    std::optional<WebReply> refusal{};
  };
  /// Puts in who asks.
  std::function<Admitted(WebRequest&)> admit;
  /// Registers one whose answer takes its time (Authority::visit).
  std::function<std::unique_ptr<Visit>(const Caller&, std::function<void(const grpc::Status&)>)>
      visit;
  /// Answers a request; called by the network's thread.
  std::function<void(WebRequest, Answer)> serve;
  ThreadPool& files;  ///< who reads what is sent from the disk
  std::shared_ptr<IoHandle> io;
  Meters& meters;
  ConnectionCount count;                         ///< of the network's thread
  std::set<std::shared_ptr<Connection>> open{};  ///< likewise
  uint64_t body_bytes = 0;                       ///< that requests have been granted; likewise
};

/// `tls`: null for plain text. The world outlives the connection.
std::shared_ptr<Connection> make_connection(boost::asio::ip::tcp::socket socket,
                                            const std::shared_ptr<boost::asio::ssl::context>& tls,
                                            ConnectionWorld& world);

}  // namespace hyades::coordinator
