#include "coordinator/services/admission.h"

#include <charconv>
#include <cstdint>
#include <string_view>

#include <fmt/format.h>
#include <grpcpp/security/auth_context.h>

#include "coordinator/access/address.h"
#include "farm/channel.h"
#include "farm/wire.h"

namespace hyades::coordinator {

grpc::Status Admission::check(const grpc::CallbackServerContext& context, const Rule& rule,
                              Caller& caller) const {
  grpc::Status admitted = admit(context, rule, caller);
  const bool refused = admitted.error_code() == grpc::StatusCode::UNAUTHENTICATED ||
                       admitted.error_code() == grpc::StatusCode::PERMISSION_DENIED;
  if (AuditLog* log = authority_.audit(); log != nullptr && refused) {
    log->refuse(caller, rule.action, admitted);
  }
  return admitted;
}

grpc::Status Admission::admit(const grpc::CallbackServerContext& context, const Rule& rule,
                              Caller& caller) const {
  caller.address = address_of_peer(context.peer());
  const auto& metadata = context.client_metadata();
  const auto shown = metadata.find(farm::kTokenKey);
  const grpc::Status known = authority_.admit(
      shown == metadata.end() ? std::string_view()
                              : std::string_view(shown->second.data(), shown->second.size()),
      caller, [&] { return own_end_(caller.address); });
  if (!known.ok()) {
    unknown_(caller.address);
    return known;
  }
  known_(caller);
  uint32_t protocol = 0;
  const auto spoken = metadata.find(farm::kProtocolKey);
  if (spoken != metadata.end()) {
    std::from_chars(spoken->second.data(), spoken->second.data() + spoken->second.size(), protocol);
  }
  if (protocol < farm::kOldestProtocol) {
    return {grpc::StatusCode::FAILED_PRECONDITION,
            fmt::format("the caller speaks protocol {}, this coordinator {} to {}", protocol,
                        farm::kOldestProtocol, farm::kProtocol)};
  }
  if (const grpc::Status allowed = allow(caller, rule); !allowed.ok()) return allowed;
  const bool works =
      caller.role == v1::ROLE_WORKER || rule.action == std::string_view("worker.attend");
  if (works && workers_show_ && !context.auth_context()->IsPeerAuthenticated()) {
    return {grpc::StatusCode::UNAUTHENTICATED,
            "workers show a certificate here: --tls-cert FILE --tls-key FILE ('hyades certs issue "
            "--client' makes one)"};
  }
  return grpc::Status::OK;
}

}  // namespace hyades::coordinator
