#pragma once

#include <string>

#include "core/base/result.h"

namespace hyades::farm {

/// A certificate, with those that lead from it to its signer, and its private key: PEM texts.
struct KeyPair {
  std::string cert;
  std::string key;
};

/// The PEM text of a file of signers' certificates. An error that names the file where it cannot be
/// read, holds no certificate, or a damaged one.
core::Result<std::string> read_certificates(const std::string& file);

/// The PEM texts of a certificate and its key. An error that names what is wrong of either: as
/// above, no key, a key with a pass phrase, or a key of another certificate.
core::Result<KeyPair> read_key_pair(const std::string& cert_file, const std::string& key_file);

}  // namespace hyades::farm
