#pragma once

#include <memory>
#include <string>

#include "core/base/result.h"
#include "farm/channel.h"

namespace hyades::coordinator {

class Authority;
class Brain;

/// The coordinator's gRPC server: services over a brain.
class Server {
 public:
  /// Listens; an error where the address is taken or not this machine's. `brain` and `authority`,
  /// which says who may come in, outlive the server.
  static core::Result<std::unique_ptr<Server>> start(const farm::Door& door, Brain& brain,
                                                     Authority& authority);

  /// Ends all calls and stops listening.
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// HOST:PORT as bound.
  const std::string& address() const { return address_; }

 private:
  struct Parts;
  explicit Server(std::unique_ptr<Parts> parts);

  std::unique_ptr<Parts> parts_;
  std::string address_;
};

}  // namespace hyades::coordinator
