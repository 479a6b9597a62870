#include "coordinator/web/standby_server.h"

#include <chrono>
#include <cstddef>
#include <optional>
#include <thread>
#include <utility>

#include <boost/asio/io_context.hpp>

#include "coordinator/meters/meters.h"
#include "coordinator/web/connection.h"
#include "coordinator/web/routes.h"
#include "coordinator/web/web_door.h"
#include "farm/wire_status.h"

namespace hyades::coordinator {
namespace {

constexpr const char* kText = "text/plain; charset=utf-8";
/// Certificates that are read again are all that there is to read.
constexpr size_t kThreads = 1;
constexpr size_t kMostWaiting = 10;

/// What it answers itself.
std::optional<WebReply> own_answer(const WebRequest& request) {
  if (request.method != "GET" || request.path.size() != 1) return std::nullopt;
  if (request.path[0] == "healthz") return text_reply("well\n", kText);
  if (request.path[0] == "readyz") return text_reply("stands by\n", kText);
  if (request.path[0] == "metrics") return text_reply(standby_metrics(), kMetricsType);
  return std::nullopt;
}

/// The same target there, asked for in the same way and with the same body.
WebReply send_on(const WebRequest& request, const std::string& leader) {
  if (leader.empty()) {
    return error_reply(farm::retry_later(
        grpc::StatusCode::UNAVAILABLE,
        "this coordinator stands by, and none leads at the moment: try again soon",
        std::chrono::seconds(1)));
  }
  WebReply there = empty_reply(307);
  there.headers = {{"Location", leader + request.target}, {"Cache-Control", "no-store"}};
  return there;
}

}  // namespace

struct StandbyServer::Parts {
  Parts(std::function<std::string()> url, bool secure)
      : leader_url(std::move(url)),
        io(std::make_shared<IoHandle>(network)),
        world{[this](const WebRequest& request, const OwnEnd&) { return admit(request); },
              {},
              {},
              [](const WebRequest& request, const Answer& answer) {
                answer(own_answer(request).value());
              },
              files,
              io,
              meters,
              bodies,
              answers,
              WebDoor::bounds(secure)},
        door(network, world) {
    world.one_request = true;
  }

  /// What is sent on is so before its body comes.
  ConnectionWorld::Admitted admit(const WebRequest& request) const {
    if (own_answer(request)) return {};
    return {0, send_on(request, leader_url())};
  }

  const std::function<std::string()> leader_url;
  farm::ByteBudget bodies{ConnectionWorld::kMostBytes, ConnectionWorld::kMostBytesOfOne};
  farm::ByteBudget answers{ConnectionWorld::kMostBytes, ConnectionWorld::kMostBytesOfOne};
  // The network is there before all that belongs to it, and ends after it.
  boost::asio::io_context network{1};
  Meters meters;  ///< nobody asks for them
  std::shared_ptr<IoHandle> io;
  ConnectionWorld world;
  WebDoor door;
  std::thread thread;
  farm::ThreadPool files{kThreads, kMostWaiting};  ///< ends first: its thread uses the above
};

StandbyServer::StandbyServer(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}

StandbyServer::~StandbyServer() {
  parts_->network.stop();
  if (parts_->thread.joinable()) parts_->thread.join();
  parts_->io->close();
  parts_->world.open.clear();
}

const std::string& StandbyServer::url() const { return parts_->door.url(); }

core::Result<std::unique_ptr<StandbyServer>> StandbyServer::start(
    const farm::Listen& listen, std::function<std::string()> leader_url) {
  auto parts = std::make_unique<Parts>(std::move(leader_url), !listen.cert_file.empty());
  if (core::Status opened = parts->door.open(listen); !opened) return opened.error();
  std::unique_ptr<StandbyServer> server(new StandbyServer(std::move(parts)));
  Parts& running = *server->parts_;
  running.door.begin();
  running.thread = std::thread([&running] { running.door.run(); });
  return server;
}

}  // namespace hyades::coordinator
