#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "coordinator/web/exchange.h"

namespace hyades::coordinator {

/// Who may come in over HTTP. The same token as over gRPC opens everything; besides, no page of
/// another site may act in the name of a person whose browser reaches the coordinator.
class Gatekeeper {
 public:
  /// An empty token lets everybody in that is on this machine or was let on the network with
  /// --insecure. `loopback`: listens on this machine only. `secure`: TLS.
  Gatekeeper(std::string token, bool loopback, bool secure)
      : token_(std::move(token)), loopback_(loopback), secure_(secure) {}

  /// OK, UNAUTHENTICATED, or PERMISSION_DENIED for requests that another site's page has made, or
  /// that came by a name which is not this machine's (DNS rebinding; only where nothing else
  /// guards).
  grpc::Status check(const WebRequest& request) const;

  /// The header Set-Cookie of a session for who shows the right token.
  std::optional<std::string> open_session(const std::string& token) const;
  /// The header that ends it.
  std::string end_session() const;

 private:
  bool is_session(const std::string& cookies) const;
  std::string sign(const std::string& text) const;
  grpc::Status check_site(const WebRequest& request) const;

  std::string token_;
  bool loopback_;
  bool secure_;
};

}  // namespace hyades::coordinator
