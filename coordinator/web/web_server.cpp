#include "coordinator/web/web_server.h"

#include <chrono>
#include <functional>
#include <optional>
#include <thread>
#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>

#include "coordinator/access/authority.h"
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
#include "coordinator/web/web_door.h"
#include "farm/wire.h"

namespace hyades::coordinator {
namespace {

constexpr std::chrono::seconds kSweep{30};

}  // namespace

struct WebServer::Parts {
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
              WebDoor::bounds(secure)},
        door(network, world),
        sweep(network) {
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

  void sweep_now_and_then() {
    sweep.expires_after(kSweep);
    sweep.async_wait([this](boost::system::error_code error) {
      if (error) return;
      (void)executors.files.submit([this] { assets.sweep(); });
      sweep_now_and_then();
    });
  }

  farm::ByteBudget bodies{ConnectionWorld::kMostBytes, ConnectionWorld::kMostBytesOfOne};
  farm::ByteBudget answers{ConnectionWorld::kMostBytes, ConnectionWorld::kMostBytesOfOne};
  // The network is there before all that belongs to it, and ends after it.
  boost::asio::io_context network{1};
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
  WebDoor door;
  boost::asio::steady_timer sweep;
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
  const bool secure = !listen.cert_file.empty();
  auto parts = std::make_unique<Parts>(controller, authority, std::move(names), secure, serves);
  if (core::Status opened = parts->door.open(listen); !opened) return opened.error();
  std::unique_ptr<WebServer> server(new WebServer(std::move(parts)));
  Parts& running = *server->parts_;
  running.authenticator.set_port(running.door.port());
  server->url_ = running.door.url();
  running.door.begin();
  if (serves == Serves::everything) {
    running.live.begin();
    running.sweep_now_and_then();
  }
  running.thread = std::thread([&running] { running.door.run(); });
  return server;
}

}  // namespace hyades::coordinator
