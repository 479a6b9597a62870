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

/// Tells who asks over HTTP: by the tokens of gRPC, or by the session of a browser. No page of
/// another site may act in the name of a person whose browser reaches the coordinator.
class Authenticator {
 public:
  /// `names`: those by which browsers may reach the coordinator, besides the names that no stranger
  /// can have (see check()). `secure`: it speaks TLS. `authority` outlives it.
  Authenticator(Authority& authority, std::vector<std::string> names, bool secure);

  /// Names the cookie by the port that the coordinator listens on: browsers send a machine's
  /// cookies to all its ports.
  void set_port(uint16_t port);

  /// OK, with who asks in `caller`, by a connection with that end of ours; or UNAUTHENTICATED. A
  /// request that another site's page has made is PERMISSION_DENIED. So is, where no token guards,
  /// one that came by a name which a stranger may have led here (DNS rebinding). No stranger can
  /// have an address, a name without a dot, one below .local, .localhost, .internal or home.arpa,
  /// or this machine's own name; other names have to be among `names`.
  grpc::Status check(const WebRequest& request, const OwnEnd& own, Caller& caller) const;

  /// Opens a session for who shows this token: the value of the header Set-Cookie; or nothing, with
  /// the reason in `why`.
  std::optional<std::string> open_session(const WebRequest& request, const std::string& token,
                                          grpc::Status& why);
  /// Ends the session of the request, if it has one, with all streams that are open in it. The
  /// value of the header Set-Cookie that makes the browser forget it.
  std::string end_session(const WebRequest& request);

 private:
  grpc::Status admit_session(std::string_view session, Caller& caller) const;
  grpc::Status check_site(const WebRequest& request) const;
  bool is_ours(std::string_view host) const;
  bool came_by_tls(const WebRequest& request) const;
  std::string cookie_of(const WebRequest& request) const;

  Authority& authority_;
  Sessions sessions_;
  std::vector<std::string> names_;
  bool secure_;
  std::string cookie_ = "hyades_session=";
};

}  // namespace hyades::coordinator
