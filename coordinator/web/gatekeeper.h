#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "coordinator/access/authority.h"
#include "coordinator/web/exchange.h"

namespace hyades::coordinator {

/// Who comes in over HTTP. The same tokens as over gRPC; besides, no page of another site may act
/// in the name of a person whose browser reaches the coordinator.
class Gatekeeper {
 public:
  /// `shared_token`: that of --token-file, or empty. `loopback`: listens on this machine only.
  /// `secure`: TLS. `authority` outlives it.
  Gatekeeper(Authority& authority, std::string shared_token, bool loopback, bool secure);

  /// OK and who asks; UNAUTHENTICATED; or PERMISSION_DENIED for requests that another site's page
  /// has made, or that came by a name which is not this machine's (DNS rebinding; only where
  /// nothing else guards).
  grpc::Status check(const WebRequest& request, Caller& caller) const;

  /// The header Set-Cookie of a session for who shows this token; or why there is none.
  std::optional<std::string> open_session(const std::string& token, grpc::Status& why) const;
  /// The header that ends it.
  std::string end_session() const;

 private:
  grpc::Status admit_session(std::string_view session, Caller& caller) const;
  std::string sign(const std::string& id, const std::string& until) const;
  grpc::Status check_site(const WebRequest& request) const;

  Authority& authority_;
  std::string shared_token_;
  std::string key_;  ///< that signs sessions of all other tokens: of this process alone
  bool loopback_;
  bool secure_;
};

}  // namespace hyades::coordinator
