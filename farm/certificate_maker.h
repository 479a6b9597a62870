#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"

namespace hyades::farm {

// A farm's own certificates, for those who have no authority to ask: X.509 v3, keys on the curve
// P-256, signed with ECDSA and SHA-256. (Ed25519 is not taken by all that speaks TLS, gRPC's
// BoringSSL and browsers among them.)

/// Makes DIR/ca.pem and DIR/ca.key, which signs the others: good for `days`, for nothing but
/// signing. `name`: what the certificate calls itself. An error where one of them is there already,
/// or cannot be written; then neither is.
core::Status make_authority(const std::string& folder, const std::string& name, int days);

/// What a certificate is for.
struct CertificateRequest {
  std::string name;              ///< 1 to 64 letters, digits, '-', '_', '.'; also of the files
  std::vector<std::string> dns;  ///< names by which a server is reached; "*.farm.example" too
  std::vector<std::string> ips;  ///< addresses by which it is
  bool server = false;           ///< may be shown by servers
  bool client = false;           ///< may be shown by clients and workers
  int days = 365;
};

/// Makes DIR/NAME.pem (the certificate, then the authority's) and DIR/NAME.key, signed by
/// DIR/ca.key; it ends with the authority's at the latest. A server without names is reached by
/// `name`. An error where one of the two is there already or cannot be written, and where the
/// authority is not there or has ended.
core::Status issue_certificate(const std::string& folder, const CertificateRequest& request);

}  // namespace hyades::farm
