#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "coordinator/services/connection_gate.h"
#include "core/base/result.h"
#include "farm/channel.h"

namespace hyades::coordinator {

class Authority;
class Controller;

/// The coordinator's gRPC server: services over a controller.
class Server {
 public:
  struct Options {
    /// A connection on which no call is open for so long is ended. Workers hold a stream as long as
    /// they are there, and clients connect again with their next call: what is ended is nobody's.
    std::chrono::milliseconds idle = std::chrono::minutes(5);
    /// How long the one message of a call that is admitted may be on its way, and its answer.
    std::chrono::milliseconds request_patience = std::chrono::minutes(2);
    /// Bytes that wait for their readers, in all and with one token: answers, streams' messages,
    /// and what workers are told, where that is more than 64 KiB.
    uint64_t waiting = uint64_t{512} << 20U;
    uint64_t waiting_of_one = uint64_t{128} << 20U;
    ConnectionGate::Limits gate{};
  };

  /// Listens; an error where the address is taken or not this machine's. `controller` and
  /// `authority`, which says who may come in, outlive the server.
  static core::Result<std::unique_ptr<Server>> start(const farm::Door& door, Controller& controller,
                                                     Authority& authority, const Options& options);
  static core::Result<std::unique_ptr<Server>> start(const farm::Door& door, Controller& controller,
                                                     Authority& authority) {
    return start(door, controller, authority, {});
  }

  /// Ends all calls and stops listening.
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// HOST:PORT as bound.
  const std::string& address() const { return address_; }
  /// How many connections there are.
  ConnectionGate::Count connections() const;

 private:
  struct Parts;
  explicit Server(std::unique_ptr<Parts> parts);

  std::unique_ptr<Parts> parts_;
  std::string address_;
};

}  // namespace hyades::coordinator
