#pragma once

#include <functional>
#include <memory>
#include <string>

#include "core/base/result.h"
#include "farm/channel.h"

namespace hyades::coordinator {

/// What answers at the HTTP address of a coordinator that stands by: GET /healthz, /readyz and
/// /metrics tell anybody that it does, and all else is sent on to the one that leads.
class StandbyServer {
 public:
  /// Listens as WebServer::start() does. `leader_url`: "http://HOST:PORT", or https, of the one
  /// that leads; empty while none is known, when all else is told to come again in a second. The
  /// network's thread calls it: it must not wait.
  static core::Result<std::unique_ptr<StandbyServer>> start(
      const farm::Listen& listen, std::function<std::string()> leader_url);

  /// Breaks off all connections and stops listening.
  ~StandbyServer();
  StandbyServer(const StandbyServer&) = delete;
  StandbyServer& operator=(const StandbyServer&) = delete;

  /// "http://HOST:PORT", or https: what it listens on.
  const std::string& url() const;

 private:
  struct Parts;
  explicit StandbyServer(std::unique_ptr<Parts> parts);

  std::unique_ptr<Parts> parts_;
};

}  // namespace hyades::coordinator
