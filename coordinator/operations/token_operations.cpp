// Who may do what.
#include <cstdint>
#include <utility>
#include <vector>

#include "coordinator/access/authority.h"
#include "coordinator/access/token.h"
#include "coordinator/operations/operation.h"
#include "core/base/wall_clock.h"

namespace hyades::coordinator {
namespace {

constexpr uint64_t kMostOfSignIn = 4U << 10U;

grpc::Status who_am_i(Backend& at, const v1::WhoAmIRequest&, v1::WhoAmIResponse& response,
                      const Caller& caller) {
  response.set_role(caller.role);
  response.set_name(caller.name);
  response.set_token_id(caller.token_id);
  response.set_guarded(at.authority.guarded());
  response.set_expires_ms(caller.term.expires_ms);
  response.set_warn_ms(caller.term.warn_ms);
  return grpc::Status::OK;
}

HttpForm session_form(const v1::WhoAmIRequest&, const v1::WhoAmIResponse& response) {
  farm::Json json = farm::to_json(response);
  json.erase("warn_ms");
  json["expiring"] =
      farm::expiry_warning({response.expires_ms(), response.warn_ms()}, core::wall_ms());
  return {std::move(json)};
}

grpc::Status create_token(Backend& at, const v1::CreateTokenRequest& request,
                          v1::CreateTokenResponse& response) {
  StoredToken row;
  const grpc::Status made = at.authority.create(request, *response.mutable_secret(), row);
  if (made.ok()) *response.mutable_token() = to_wire(row);
  return made;
}

grpc::Status list_tokens(Backend& at, const v1::ListTokensRequest&,
                         v1::ListTokensResponse& response) {
  for (const StoredToken& token : at.authority.tokens()) *response.add_tokens() = to_wire(token);
  return grpc::Status::OK;
}

grpc::Status revoke_token(Backend& at, const v1::RevokeTokenRequest& request,
                          v1::RevokeTokenResponse& response) {
  StoredToken row;
  const grpc::Status done = at.authority.revoke(request.id(), row);
  if (done.ok()) *response.mutable_token() = to_wire(row);
  return done;
}

}  // namespace

// clang-format off
std::vector<Operation> token_operations() {
  return {
      {{"session", v1::ROLE_UNSPECIFIED, true}, "", {}, {},
       {{.path = "POST /api/v1/session", .most_bytes = kMostOfSignIn},
        {.path = "DELETE /api/v1/session", .most_bytes = kMostOfSignIn}}},
      {{"whoami", v1::ROLE_VIEWER, true}, "Admin/WhoAmI", Runs::at_once, who_am_i,
       {{.path = "GET /api/v1/session", .show = session_form}}},
      {{"token.create", v1::ROLE_ADMIN, false, true}, "Admin/CreateToken", Runs::in_store, create_token},
      {{"token.list", v1::ROLE_ADMIN}, "Admin/ListTokens", Runs::at_once, list_tokens},
      {{"token.revoke", v1::ROLE_ADMIN, false, true}, "Admin/RevokeToken", Runs::in_store, revoke_token},
      {{"audit.read", v1::ROLE_ADMIN}, "Admin/Audit", Runs::in_files},
  };
}
// clang-format on

}  // namespace hyades::coordinator
