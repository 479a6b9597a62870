#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "farm/channel.h"

namespace hyades::coordinator {

class Authority;
class Controller;

/// Which routes a server has.
enum class Serves {
  everything,  ///< the dashboard and the API
  health,      ///< /healthz, /readyz and /metrics alone: for a place that strangers cannot crowd
};

/// The coordinator's HTTP server: the dashboard and the API of openapi.yaml over a controller.
///
/// One thread does all that concerns connections, so that thousands of them cost no more than what
/// they ask for; pools of threads do what may wait for the disk, as for gRPC.
class WebServer {
 public:
  /// Listens at listen.address, with its certificate and token (farm::open_door has the rules). An
  /// error where they do not hold together, or the address is taken or not this machine's.
  /// `controller` and `authority`, which says who may come in, outlive the server. `names`: by
  /// which browsers may reach it where no token guards, beside those that no stranger can have
  /// (Authenticator::check).
  static core::Result<std::unique_ptr<WebServer>> start(const farm::Listen& listen,
                                                        Controller& controller,
                                                        Authority& authority,
                                                        std::vector<std::string> names = {},
                                                        Serves serves = Serves::everything);

  /// Breaks off all connections and stops listening.
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  /// "http://HOST:PORT", or https: what it listens on.
  const std::string& url() const { return url_; }
  /// Its routes: "GET /api/v1/jobs/{job}", ...
  std::vector<std::string> routes() const;

 private:
  struct Parts;
  explicit WebServer(std::unique_ptr<Parts> parts);

  std::unique_ptr<Parts> parts_;
  std::string url_;
};

}  // namespace hyades::coordinator
