#include "coordinator/services/admission.h"

#include <charconv>

#include <fmt/format.h>
#include <openssl/crypto.h>

#include "farm/channel.h"
#include "farm/wire.h"

namespace hyades::coordinator {

grpc::Status Admission::check(const grpc::CallbackServerContext& context) const {
  const auto& metadata = context.client_metadata();
  if (!token_.empty()) {
    const auto shown = metadata.find(farm::kTokenKey);
    const std::string expected = "Bearer " + token_;
    // In a time that does not depend on how much of the token is right.
    const bool right = shown != metadata.end() && shown->second.size() == expected.size() &&
                       CRYPTO_memcmp(shown->second.data(), expected.data(), expected.size()) == 0;
    if (!right) {
      return {grpc::StatusCode::UNAUTHENTICATED,
              shown == metadata.end()
                  ? "this coordinator wants its token with every call (--token-file)"
                  : "this is not the coordinator's token"};
    }
  }
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
  return grpc::Status::OK;
}

}  // namespace hyades::coordinator
