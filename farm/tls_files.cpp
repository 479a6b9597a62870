#include "farm/tls_files.h"

#include <openssl/err.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/x509.h>

#include <memory>
#include <utility>

#include <fmt/format.h>

#include "farm/openssl_objects.h"
#include "farm/small_file.h"

namespace hyades::farm {
namespace {

Bio open_text(const std::string& text) {
  return Bio(BIO_new_mem_buf(text.data(), static_cast<int>(text.size())));
}

/// Nobody is asked for a pass phrase: `asked`, a bool, tells that one is needed.
int no_pass_phrase(char* /*buffer*/, int /*size*/, int /*writing*/, void* asked) {
  *static_cast<bool*>(asked) = true;
  return -1;
}

/// The first certificate in the text of `file`; all others are looked at.
core::Result<Certificate> first_certificate(const std::string& file, const std::string& text) {
  const Bio bio = open_text(text);
  Certificate first;
  ERR_clear_error();
  for (int count = 0;; ++count) {
    bool asked = false;
    Certificate next(PEM_read_bio_X509(bio.get(), nullptr, no_pass_phrase, &asked));
    if (next) {
      if (!first) first = std::move(next);
      continue;
    }
    const bool at_end = ERR_GET_REASON(ERR_peek_last_error()) == PEM_R_NO_START_LINE;
    ERR_clear_error();
    if (!at_end)
      return core::Error{fmt::format("{}: certificate {} in it is damaged", file, count + 1)};
    break;
  }
  if (first) return first;
  return core::Error{file +
                     ": holds no certificate; expected PEM text (-----BEGIN CERTIFICATE-----)"};
}

core::Result<Key> private_key(const std::string& file, const std::string& text) {
  const Bio bio = open_text(text);
  bool asked = false;
  Key key(PEM_read_bio_PrivateKey(bio.get(), nullptr, no_pass_phrase, &asked));
  ERR_clear_error();
  if (key) return key;
  if (asked) {
    return core::Error{file +
                       ": the key in it is encrypted; expected one without a pass phrase "
                       "(openssl pkey -in ENCRYPTED -out PLAIN)"};
  }
  return core::Error{file +
                     ": holds no private key that can be read; expected PEM text "
                     "(-----BEGIN PRIVATE KEY-----)"};
}

}  // namespace

core::Result<std::string> read_certificates(const std::string& file) {
  auto text = read_small_file(file);
  if (!text) return text;
  if (const auto first = first_certificate(file, *text); !first) return first.error();
  return text;
}

core::Result<KeyPair> read_key_pair(const std::string& cert_file, const std::string& key_file) {
  auto cert_text = read_small_file(cert_file);
  if (!cert_text) return cert_text.error();
  auto key_text = read_small_file(key_file);
  if (!key_text) return key_text.error();
  const auto certificate = first_certificate(cert_file, *cert_text);
  if (!certificate) return certificate.error();
  const auto key = private_key(key_file, *key_text);
  if (!key) return key.error();
  const bool fit = X509_check_private_key(certificate->get(), key->get()) == 1;
  ERR_clear_error();
  if (!fit) {
    return core::Error{key_file + ": is not the key of the certificate in " + cert_file +
                       " (of several the first counts)"};
  }
  return KeyPair{std::move(*cert_text), std::move(*key_text)};
}

}  // namespace hyades::farm
