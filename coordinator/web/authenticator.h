#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "coordinator/access/authority.h"
#include "coordinator/web/exchange.h"
#include "coordinator/web/sessions.h"

namespace hyades::coordinator {

/// Who comes in over HTTP. The same tokens as over gRPC; besides, no page of another site may act
/// in the name of a person whose browser reaches the coordinator.
class Authenticator {
 public:
  /// `names`: by which browsers may reach it besides those that no stranger can have (see
  /// check()). `secure`: TLS. `authority` outlives it.
  Authenticator(Authority& authority, std::vector<std::string> names, bool secure);

  /// Cookies are the same for all ports of a machine: a coordinator's are named by its own.
  void set_port(uint16_t port);

  /// OK and who asks; UNAUTHENTICATED; or PERMISSION_DENIED for requests that another site's page
  /// has made, or, where no token guards, that came by a name which a stranger may have led here
  /// (DNS rebinding). No stranger can have an address, a name without a dot, one below .local,
  /// .localhost, .internal or home.arpa, or this machine's own name; others have to be among
  /// `names`.
  grpc::Status check(const WebRequest& request, Caller& caller) const;

  /// The header Set-Cookie of a session for who shows this token; or why there is none.
  std::optional<std::string> open_session(const std::string& token, grpc::Status& why);
  /// Ends the session of the request, if it has one, with all that is open in it; the header that
  /// makes the browser forget it.
  std::string end_session(const WebRequest& request);

 private:
  grpc::Status admit_session(std::string_view session, Caller& caller) const;
  grpc::Status check_site(const WebRequest& request) const;
  bool is_ours(std::string_view host) const;

  Authority& authority_;
  Sessions sessions_;
  std::vector<std::string> names_;
  bool secure_;
  std::string cookie_ = "hyades_session=";
};

}  // namespace hyades::coordinator
