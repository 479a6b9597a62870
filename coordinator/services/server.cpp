#include "coordinator/services/server.h"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include <grpcpp/resource_quota.h>
#include <grpcpp/server.h>
#include <grpcpp/server_builder.h>

#include "coordinator/access/listening.h"
#include "coordinator/controller/controller.h"
#include "coordinator/services/admission.h"
#include "coordinator/services/call_meter.h"
#include "coordinator/services/service.h"
#include "farm/wire.h"

namespace hyades::coordinator {
namespace {

constexpr int kKeepaliveMs = 20'000;
constexpr int kKeepaliveTimeoutMs = 10'000;
constexpr std::chrono::milliseconds kLastWords{200};
/// What has come over all connections and is not dealt with yet: beyond it windows close, and then
/// calls are broken off.
constexpr size_t kMostReceivedBytes = size_t{512} << 20U;
/// Calls at once on one connection; a worker has one and its downloads, a client one or two, and a
/// client that has more waits for their end. gRPC has one bound for strangers and others.
constexpr int kMostCalls = 50;

}  // namespace

struct Server::Parts {
  Parts(Controller& controller, Authority& authority, bool workers_show, const Options& options)
      : gate(options.gate),
        admission(
            authority, workers_show,
            [this](const std::string& address) { return gate.own_end_to(address); },
            [this](const Caller& caller) {
              gate.mark_known(caller.address, caller.token_id, caller.worker);
            },
            [this](const std::string& address) { gate.mark_unknown(address); }),
        waiting(options.waiting, options.waiting_of_one),
        service({controller, authority}, admission, executors, options.request_patience, waiting) {
    add_job_streams(service);
    add_film_stream(service);
    add_asset_streams(service);
    add_audit_stream(service);
    add_worker_stream(service);
  }

  ConnectionGate gate;
  Admission admission;
  Executors executors;
  farm::ByteBudget waiting;
  Service service;
  std::unique_ptr<grpc::experimental::ExternalConnectionAcceptor> acceptor;
  std::unique_ptr<grpc::Server> server;
};

Server::Server(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}

Server::~Server() {
  parts_->gate.close();
  parts_->server->Shutdown(std::chrono::system_clock::now() + kLastWords);
  parts_->server->Wait();
}

ConnectionGate::Count Server::connections() const { return parts_->gate.count(); }

core::Result<std::unique_ptr<Server>> Server::start(const farm::Door& door, Controller& controller,
                                                    Authority& authority, const Options& options) {
  auto listening = listen_at({door.address});
  if (!listening) return listening.error();
  const uint16_t port = listening->port;
  auto parts = std::make_unique<Parts>(controller, authority, door.workers_show, options);
  grpc::ServerBuilder builder;
  using Builder = grpc::ServerBuilder::experimental_type;
  parts->acceptor = builder.experimental().AddExternalConnectionAcceptor(
      Builder::ExternalConnectionType::FROM_FD, door.credentials);
  builder.RegisterService(&parts->service);
  builder.experimental().SetInterceptorCreators(count_calls(controller.meters(), parts->gate));
  builder.SetMaxReceiveMessageSize(static_cast<int>(farm::kMaxResultBytes));
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIME_MS, kKeepaliveMs);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, kKeepaliveTimeoutMs);
  builder.AddChannelArgument(GRPC_ARG_HTTP2_MIN_RECV_PING_INTERVAL_WITHOUT_DATA_MS,
                             static_cast<int>(farm::kLeastPingInterval.count()));
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_PERMIT_WITHOUT_CALLS, 1);
  builder.AddChannelArgument(GRPC_ARG_MAX_CONCURRENT_STREAMS, kMostCalls);
  // Keepalive keeps what is answered at the other end, and anybody may answer.
  builder.AddChannelArgument(GRPC_ARG_MAX_CONNECTION_IDLE_MS,
                             static_cast<int>(options.idle.count()));
  // A megabyte may be unpacked to a thousand: gRPC looks at the length only then. Films are packed
  // by their own codec, which is told how much it may unpack.
  builder.AddChannelArgument(GRPC_ARG_ENABLE_PER_MESSAGE_DECOMPRESSION, 0);
  builder.SetCompressionAlgorithmSupportStatus(GRPC_COMPRESS_DEFLATE, false);
  builder.SetCompressionAlgorithmSupportStatus(GRPC_COMPRESS_GZIP, false);
  builder.SetResourceQuota(grpc::ResourceQuota("hyades").Resize(kMostReceivedBytes));
  parts->server = builder.BuildAndStart();
  if (!parts->server) return core::Error{door.address + ": gRPC cannot serve there"};
  std::unique_ptr<Server> server(new Server(std::move(parts)));
  server->address_ = door.address.substr(0, door.address.rfind(':') + 1) + std::to_string(port);
  controller.farm().listens_at(server->address_);
  auto& acceptor = *server->parts_->acceptor;
  const core::Status open =
      server->parts_->gate.open(std::move(*listening), [&acceptor](int socket) {
        grpc::experimental::ExternalConnectionAcceptor::NewConnectionParameters connection;
        connection.fd = socket;
        acceptor.HandleNewConnection(&connection);
      });
  if (!open) return open.error().in(door.address);
  return server;
}

}  // namespace hyades::coordinator
