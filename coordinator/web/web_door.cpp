#include "coordinator/web/web_door.h"

#include <fcntl.h>

#include <chrono>
#include <cstddef>
#include <exception>
#include <utility>

#include "coordinator/access/address.h"
#include "coordinator/access/listening.h"
#include "coordinator/access/peer_user.h"
#include "farm/log.h"

namespace hyades::coordinator {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;

constexpr size_t kMostConnections = 4000;
/// From one address: a person has some ten, a proxy in front of many people more.
constexpr size_t kMostOfAddress = 1000;
/// With TLS each takes about a hundred kilobytes, whoever it is of.
constexpr size_t kFewerWithTls = 4;
/// ... that it has however many there are.
constexpr size_t kSureOfAddress = 8;
constexpr std::chrono::milliseconds kAcceptAgain{200};
/// Taken in at once, before those who are in have their turn again.
constexpr int kMostAtOnce = 256;
/// How soon certificates that have changed are noticed.
constexpr std::chrono::seconds kLook{2};

}  // namespace

ConnectionCount WebDoor::bounds(bool secure) {
  const size_t fewer = secure ? kFewerWithTls : 1;
  return {kMostConnections / fewer, kMostOfAddress / fewer, kSureOfAddress};
}

WebDoor::WebDoor(asio::io_context& network, ConnectionWorld& world)
    : network_(network), world_(world), look_(network) {}

core::Status WebDoor::open(const farm::Listen& listen) {
  if (const auto door = farm::open_door(listen); !door) return door.error();  // its rules are ours
  const bool secure = !listen.cert_file.empty();
  if (secure) {
    certificates_.emplace(listen);
    const TlsContext::Stamps stamps = certificates_->stamps();
    auto tls = certificates_->load();
    if (!tls) return tls.error();
    certificates_->taken(stamps);
    tls_ = std::move(*tls);
  }
  if (core::Status bound = this->listen(listen.address); !bound) return bound;
  url_ = (secure ? "https://" : "http://") +
         listen.address.substr(0, listen.address.rfind(':') + 1) + std::to_string(port_);
  return {};
}

void WebDoor::begin() {
  for (Address& one : addresses_) accept(one);
  look_at_certificates();
}

void WebDoor::run() {
  for (;;) {
    try {
      network_.run();
      return;
    } catch (const std::exception& error) {
      // One request less, not the farm: without memory, most likely.
      farm::log(farm::LogLevel::error, std::string("a web request broke off: ") + error.what());
    }
  }
}

core::Status WebDoor::listen(const std::string& address) {
  auto listening = listen_at({address});
  if (!listening) return listening.error();
  port_ = listening->port;
  for (core::Descriptor& socket : listening->sockets) {
    addresses_.emplace_back(network_);
    // Only what IPv6 can do differs by the protocol that is told here.
    boost::system::error_code error;
    addresses_.back().acceptor.assign(tcp::v6(), socket.get(), error);
    if (!error) (void)socket.release();  // it is the acceptor's
    // The socket does not block; that accept() must not wait either is told besides.
    if (!error) addresses_.back().acceptor.non_blocking(true, error);
    if (error) return core::Error{address + ": cannot serve there (" + error.message() + ")"};
  }
  return {};
}

void WebDoor::accept(Address& at) {
  at.acceptor.async_wait(tcp::acceptor::wait_read, [this, &at](boost::system::error_code error) {
    if (error == asio::error::operation_aborted) return;
    if (!error) error = accept_all(at.acceptor);
    if (!error) return accept(at);
    // No descriptors left, say.
    at.again.expires_after(kAcceptAgain);
    at.again.async_wait([this, &at](boost::system::error_code) { accept(at); });
  });
}

/// Those who wait outside. One at a time, with a turn for everybody inside in between, thousands
/// would wait for a minute.
boost::system::error_code WebDoor::accept_all(tcp::acceptor& acceptor) {
  for (int taken = 0; taken < kMostAtOnce; ++taken) {
    boost::system::error_code error;
    tcp::socket socket = acceptor.accept(error);
    if (error == asio::error::would_block || error == asio::error::try_again) return {};
    if (error) return error;
    boost::system::error_code gone;
    const auto from = socket.remote_endpoint(gone);
    if (gone) continue;
    std::string address = address_text(from.address().to_string(), std::to_string(from.port()));
    Neighbour owner = neighbour_at(address, socket.native_handle());
    if (!world_.count.may_come(owner)) continue;
    // Programs that the coordinator starts must not hold its connections open.
    (void)::fcntl(socket.native_handle(), F_SETFD, FD_CLOEXEC);
    make_connection(std::move(socket), std::move(address), std::move(owner), tls_, world_)->begin();
  }
  return {};
}

/// Certificates that were renewed are used; where they are none the last ones go on.
void WebDoor::look_at_certificates() {
  if (!certificates_) return;
  look_.expires_after(kLook);
  look_.async_wait([this](boost::system::error_code error) {
    if (error) return;
    if (certificates_->changed()) {
      (void)world_.files.submit([this] { load_certificates(); });
    }
    look_at_certificates();
  });
}

/// What is amiss is told once. Files that were read while they were being written, say, are read
/// again with the next look.
void WebDoor::load_certificates() {
  const TlsContext::Stamps stamps = certificates_->stamps();
  auto fresh = certificates_->load();
  std::string trouble = fresh ? std::string() : fresh.error().message;
  const core::MutexLock lock(certificates_mutex_);
  if (fresh) {
    world_.io->post([this, context = std::move(*fresh)] { tls_ = context; });
    certificates_->taken(stamps);
  } else if (trouble != certificates_trouble_) {
    farm::log(farm::LogLevel::warning, trouble + ": HTTP goes on with the last certificate");
  }
  certificates_trouble_ = std::move(trouble);
}

}  // namespace hyades::coordinator
