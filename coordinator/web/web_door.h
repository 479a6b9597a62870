#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>

#include "coordinator/web/connection.h"
#include "coordinator/web/tls_context.h"
#include "core/base/mutex.h"
#include "core/base/result.h"
#include "farm/channel.h"

namespace hyades::coordinator {

/// Where a web server is reached: takes in those who connect, as many as ConnectionWorld::count
/// lets, over TLS where there is a certificate, which is read again when it changes.
class WebDoor {
 public:
  /// How many connections a server has at once, with TLS fewer.
  static ConnectionCount bounds(bool secure);

  /// `network` and `world` outlive the door, and whom it has taken in.
  WebDoor(boost::asio::io_context& network, ConnectionWorld& world);

  /// Listens at listen.address, with its certificate. An error where the files are not what they
  /// should be, the address is taken or not this machine's, or farm::open_door has one.
  core::Status open(const farm::Listen& listen);
  /// Begins to take in; once, after open().
  void begin();
  /// Does all that concerns the connections, until network.stop().
  void run();

  /// "http://HOST:PORT", or https: what it listens on.
  const std::string& url() const { return url_; }
  /// Of all its addresses.
  uint16_t port() const { return port_; }

 private:
  /// An address at which others may connect.
  struct Address {
    explicit Address(boost::asio::io_context& network) : acceptor(network), again(network) {}

    boost::asio::ip::tcp::acceptor acceptor;
    boost::asio::steady_timer again;
  };

  core::Status listen(const std::string& address);
  void accept(Address& at);
  boost::system::error_code accept_all(boost::asio::ip::tcp::acceptor& acceptor);
  void look_at_certificates();
  void load_certificates() HYADES_EXCLUDES(certificates_mutex_);

  boost::asio::io_context& network_;
  ConnectionWorld& world_;
  std::string url_;
  uint16_t port_ = 0;
  std::optional<TlsContext> certificates_;  ///< none: plain text
  TlsContext::Context tls_;                 ///< of those who come from now on
  core::Mutex certificates_mutex_;
  std::string certificates_trouble_ HYADES_GUARDED_BY(certificates_mutex_);  ///< as it was told
  std::deque<Address> addresses_;
  boost::asio::steady_timer look_;
};

}  // namespace hyades::coordinator
