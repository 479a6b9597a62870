#include "coordinator/web/web_server.h"

#include <fcntl.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <optional>
#include <thread>
#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>

#include "coordinator/access/address.h"
#include "coordinator/access/authority.h"
#include "coordinator/access/listening.h"
#include "coordinator/access/peer_user.h"
#include "coordinator/controller/controller.h"
#include "coordinator/meters/meters.h"
#include "coordinator/operations/operation.h"
#include "coordinator/operations/ownership.h"
#include "coordinator/web/assets_api.h"
#include "coordinator/web/authenticator.h"
#include "coordinator/web/connection.h"
#include "coordinator/web/live_api.h"
#include "coordinator/web/operation_routes.h"
#include "coordinator/web/pictures_api.h"
#include "coordinator/web/router.h"
#include "coordinator/web/routes.h"
#include "coordinator/web/tls_context.h"
#include "core/base/mutex.h"
#include "farm/log.h"
#include "farm/wire.h"

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
constexpr std::chrono::seconds kSweep{30};
/// How soon certificates that have changed are noticed.
constexpr std::chrono::seconds kLook{2};

}  // namespace

struct WebServer::Parts {
  /// An address at which others may connect.
  struct Door {
    explicit Door(asio::io_context& network) : acceptor(network), again(network) {}

    tcp::acceptor acceptor;
    asio::steady_timer again;
  };

  Parts(Controller& controller, Authority& known, std::vector<std::string> names, bool secure,
        Serves serves)
      : meters(controller.meters()),
        authority(known),
        authenticator(known, std::move(names), secure),
        io(std::make_shared<IoHandle>(network)),
        operations({controller, known}, executors),
        assets(controller, executors, known.audit()),
        pictures(controller),
        live(controller, executors, network, io),
        world{[this](WebRequest& request, const OwnEnd& own) { return admit(request, own); },
              [this](const Caller& caller, std::function<void(const grpc::Status&)> leave) {
                return authority.visit(caller, std::move(leave));
              },
              [&controller](const Caller& caller, grpc::Status& refused) {
                return count_connection(controller, caller, refused);
              },
              [this](WebRequest request, Answer answer) { serve(std::move(request), answer); },
              executors.files,
              io,
              meters,
              bodies,
              answers,
              ConnectionCount(kMostConnections / (secure ? kFewerWithTls : 1),
                              kMostOfAddress / (secure ? kFewerWithTls : 1), kSureOfAddress)},
        sweep(network),
        look(network) {
    add_health_routes(router, controller, executors);
    add_metrics(router, controller, executors);
    world.one_request = serves == Serves::health;
    if (serves == Serves::health) return;
    add_dashboard(router);
    add_session(router);
    operations.add_routes(router);
    add_job_routes(router, controller, executors);
    add_output_routes(router, controller, executors);
    assets.add_routes(router);
    pictures.add_routes(router);
    live.add_routes(router);
  }

  /// Counts by route, never by what was asked for: there are as many rows as routes.
  void serve(WebRequest request, const Answer& answer) const {
    const Router::Entry* route = router.find(request);
    const std::string name = route != nullptr ? route->pattern : "none";
    const std::string method = route != nullptr ? request.method : "any";
    const auto begun = std::chrono::steady_clock::now();
    router.answer(
        std::move(request), [&meters = meters, answer, name, method, begun](WebReply reply) {
          meters.answered(method, name, reply.status, std::chrono::steady_clock::now() - begun);
          answer(std::move(reply));
        });
  }

  void add_session(Router& to) {
    to.add("POST", "/api/v1/session", [this](const WebRequest& request, const Answer& answer) {
      const auto json = farm::Json::parse(request.body, nullptr, false);
      const std::string token =
          json.is_object() && json.contains("token") && json["token"].is_string()
              ? json["token"].get<std::string>()
              : std::string();
      grpc::Status why;
      const auto cookie = authenticator.open_session(request, token, why);
      if (!cookie) {
        if (why.error_code() == grpc::StatusCode::UNAUTHENTICATED) {
          note_refusal(request.caller, operation_of_route("POST /api/v1/session").rule, why);
        }
        answer(error_reply(why));
        return;
      }
      WebReply reply = empty_reply(204);
      reply.headers.emplace_back("Set-Cookie", *cookie);
      answer(std::move(reply));
    });
    to.add("DELETE", "/api/v1/session", [this](const WebRequest& request, const Answer& answer) {
      WebReply reply = empty_reply(204);
      reply.headers.emplace_back("Set-Cookie", authenticator.end_session(request));
      answer(std::move(reply));
    });
  }

  ConnectionWorld::Admitted admit(WebRequest& request, const OwnEnd& own) const {
    grpc::Status allowed = authenticator.check(request, own, request.caller);
    // What is not here at all is told to nobody who may not come in.
    const Router::Entry* route = router.find(request);
    const Operation& operation =
        route != nullptr ? *route->operation : operation_of_method("Farm/Info");
    const Rule& rule = operation.rule;
    const bool for_all = rule.least == v1::ROLE_UNSPECIFIED;
    if (for_all && allowed.error_code() == grpc::StatusCode::UNAUTHENTICATED) {
      allowed = grpc::Status::OK;
    }
    if (allowed.ok()) allowed = allow(request.caller, rule);
    if (!allowed.ok()) {
      note_refusal(request.caller, rule, allowed);
      WebReply refusal = error_reply(allowed);
      meters.answered("any", "refused", refusal.status, Meters::Time(0));
      return {0, std::move(refusal)};
    }
    if (route != nullptr) return {route->most_bytes};
    return {request.method == "GET" ? 0 : farm::kMaxRequestBytes};
  }

  void note_refusal(const Caller& caller, const Rule& rule, const grpc::Status& why) const {
    if (AuditLog* log = authority.audit()) log->refuse(caller, rule.action, why);
  }

  core::Status listen(const std::string& address) {
    auto listening = listen_at({address});
    if (!listening) return listening.error();
    port = listening->port;
    for (core::Descriptor& socket : listening->sockets) {
      doors.emplace_back(network);
      // Only what IPv6 can do differs by the protocol that is told here.
      boost::system::error_code error;
      doors.back().acceptor.assign(tcp::v6(), socket.get(), error);
      if (!error) (void)socket.release();  // it is the acceptor's
      // The socket does not block; that accept() must not wait either is told besides.
      if (!error) doors.back().acceptor.non_blocking(true, error);
      if (error) return core::Error{address + ": cannot serve there (" + error.message() + ")"};
    }
    return {};
  }

  void accept(Door& door) {
    door.acceptor.async_wait(
        tcp::acceptor::wait_read, [this, &door](boost::system::error_code error) {
          if (error == asio::error::operation_aborted) return;
          if (!error) error = accept_all(door.acceptor);
          if (!error) return accept(door);
          // No descriptors left, say.
          door.again.expires_after(kAcceptAgain);
          door.again.async_wait([this, &door](boost::system::error_code) { accept(door); });
        });
  }

  /// Those who wait outside. One at a time, with a turn for everybody inside in between, thousands
  /// would wait for a minute.
  boost::system::error_code accept_all(tcp::acceptor& acceptor) {
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
      if (!world.count.may_come(owner)) continue;
      // Programs that the coordinator starts must not hold its connections open.
      (void)::fcntl(socket.native_handle(), F_SETFD, FD_CLOEXEC);
      make_connection(std::move(socket), std::move(address), std::move(owner), tls, world)->begin();
    }
    return {};
  }

  void sweep_now_and_then() {
    sweep.expires_after(kSweep);
    sweep.async_wait([this](boost::system::error_code error) {
      if (error) return;
      (void)executors.files.submit([this] { assets.sweep(); });
      sweep_now_and_then();
    });
  }

  /// Certificates that were renewed are used; where they are none the last ones go on.
  void look_at_certificates() {
    if (!certificates) return;
    look.expires_after(kLook);
    look.async_wait([this](boost::system::error_code error) {
      if (error) return;
      if (certificates->changed()) {
        (void)executors.files.submit([this] { load_certificates(); });
      }
      look_at_certificates();
    });
  }

  /// What is amiss is told once. Files that were read while they were being written, say, are read
  /// again with the next look.
  void load_certificates() {
    const TlsContext::Stamps stamps = certificates->stamps();
    auto fresh = certificates->load();
    std::string trouble = fresh ? std::string() : fresh.error().message;
    const core::MutexLock lock(certificates_mutex);
    if (fresh) {
      io->post([this, context = std::move(*fresh)] { tls = context; });
      certificates->taken(stamps);
    } else if (trouble != certificates_trouble) {
      farm::log(farm::LogLevel::warning, trouble + ": HTTP goes on with the last certificate");
    }
    certificates_trouble = std::move(trouble);
  }

  void run() {
    for (;;) {
      try {
        network.run();
        return;
      } catch (const std::exception& error) {
        // One request less, not the farm: without memory, most likely.
        farm::log(farm::LogLevel::error, std::string("a web request broke off: ") + error.what());
      }
    }
  }

  farm::ByteBudget bodies{ConnectionWorld::kMostBytes, ConnectionWorld::kMostBytesOfOne};
  farm::ByteBudget answers{ConnectionWorld::kMostBytes, ConnectionWorld::kMostBytesOfOne};
  // The network is there before all that belongs to it, and ends after it.
  asio::io_context network{1};
  Meters& meters;
  Authority& authority;
  Authenticator authenticator;
  std::shared_ptr<IoHandle> io;
  OperationRoutes operations;
  AssetsApi assets;
  PicturesApi pictures;
  LiveApi live;
  Router router;
  ConnectionWorld world;
  std::optional<TlsContext> certificates;  ///< none: plain text
  TlsContext::Context tls;                 ///< of those who come from now on
  core::Mutex certificates_mutex;
  std::string certificates_trouble HYADES_GUARDED_BY(certificates_mutex);  ///< as it was told
  std::deque<Door> doors;
  uint16_t port = 0;  ///< of all of them
  asio::steady_timer sweep;
  asio::steady_timer look;
  std::thread thread;
  Executors executors;  ///< ends first: its threads use all of the above
};

WebServer::WebServer(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}

WebServer::~WebServer() {
  if (!parts_) return;
  parts_->network.stop();
  if (parts_->thread.joinable()) parts_->thread.join();
  parts_->io->close();
  parts_->pictures.close();
  parts_->world.open.clear();
}

std::vector<std::string> WebServer::routes() const {
  std::vector<std::string> all;
  for (const Router::Entry& route : parts_->router.routes()) {
    all.push_back(route.method + " " + route.pattern);
  }
  return all;
}

core::Result<std::unique_ptr<WebServer>> WebServer::start(const farm::Listen& listen,
                                                          Controller& controller,
                                                          Authority& authority,
                                                          std::vector<std::string> names,
                                                          Serves serves) {
  auto door = farm::open_door(listen);  // its rules are ours
  if (!door) return door.error();
  const bool secure = !listen.cert_file.empty();
  auto parts = std::make_unique<Parts>(controller, authority, std::move(names), secure, serves);
  if (secure) {
    parts->certificates.emplace(listen);
    const TlsContext::Stamps stamps = parts->certificates->stamps();
    auto tls = parts->certificates->load();
    if (!tls) return tls.error();
    parts->certificates->taken(stamps);
    parts->tls = std::move(*tls);
  }
  if (core::Status bound = parts->listen(listen.address); !bound) return bound.error();
  std::unique_ptr<WebServer> server(new WebServer(std::move(parts)));
  Parts& running = *server->parts_;
  running.authenticator.set_port(running.port);
  server->url_ = (secure ? "https://" : "http://") +
                 listen.address.substr(0, listen.address.rfind(':') + 1) +
                 std::to_string(running.port);
  for (Parts::Door& one : running.doors) running.accept(one);
  if (serves == Serves::everything) {
    running.live.begin();
    running.sweep_now_and_then();
  }
  running.look_at_certificates();
  running.thread = std::thread([&running] { running.run(); });
  return server;
}

}  // namespace hyades::coordinator
