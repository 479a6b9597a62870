#include "farm/certificate_maker.h"

#include <arpa/inet.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <memory>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <openssl/bn.h>
#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/x509v3.h>

#include "farm/openssl_objects.h"
#include "farm/small_file.h"
#include "farm/tls_files.h"

namespace hyades::farm {
namespace {

constexpr int kSerialBits = 127;     // RFC 5280, 4.1.2.2: positive, at most 20 bytes
constexpr long kClockSkew = 5 * 60;  // seconds by which others' clocks may be behind
constexpr int kMostDays = 36'500;
constexpr size_t kLongestName = 64;  // of a common name

using Number = std::unique_ptr<BIGNUM, Release<BN_free>>;

core::Error failed(const char* what) {
  const unsigned long code = ERR_get_error();
  ERR_clear_error();
  const char* reason = ERR_reason_error_string(code);
  return {fmt::format("{}: {}", what, reason != nullptr ? reason : "OpenSSL does not say why")};
}

bool is_made_of(const std::string& text, std::string_view besides) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [&](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           besides.find(c) != std::string_view::npos;
  });
}

bool is_ip(const std::string& text) {
  in6_addr parsed{};
  return inet_pton(AF_INET, text.c_str(), &parsed) == 1 ||
         inet_pton(AF_INET6, text.c_str(), &parsed) == 1;
}

core::Status check_days(int days) {
  if (days >= 1 && days <= kMostDays) return {};
  return core::Error{fmt::format("days: expected 1 to {}", kMostDays)};
}

/// A certificate without extensions and signature.
core::Result<Certificate> begin(const std::string& name, EVP_PKEY* key, int days) {
  Certificate made(X509_new());
  const Number serial(BN_new());
  if (!made || !serial ||
      BN_rand(serial.get(), kSerialBits, BN_RAND_TOP_ONE, BN_RAND_BOTTOM_ANY) != 1 ||
      BN_to_ASN1_INTEGER(serial.get(), X509_get_serialNumber(made.get())) == nullptr ||
      X509_set_version(made.get(), X509_VERSION_3) != 1 ||
      X509_gmtime_adj(X509_getm_notBefore(made.get()), -kClockSkew) == nullptr ||
      X509_time_adj_ex(X509_getm_notAfter(made.get()), days, 0, nullptr) == nullptr ||
      X509_set_pubkey(made.get(), key) != 1 ||
      X509_NAME_add_entry_by_txt(X509_get_subject_name(made.get()), "CN", MBSTRING_UTF8,
                                 reinterpret_cast<const unsigned char*>(name.data()),
                                 static_cast<int>(name.size()), -1, 0) != 1) {
    return failed("a certificate cannot be made");
  }
  return made;
}

/// `issuer` may be the certificate itself. The values are ours, or were checked.
core::Status extend(X509* made, X509* issuer,
                    const std::vector<std::pair<int, std::string>>& extensions) {
  X509V3_CTX context;
  X509V3_set_ctx_nodb(&context);
  X509V3_set_ctx(&context, issuer, made, nullptr, nullptr, 0);
  for (const auto& [kind, value] : extensions) {
    X509_EXTENSION* extension = X509V3_EXT_conf_nid(nullptr, &context, kind, value.c_str());
    const bool added = extension != nullptr && X509_add_ext(made, extension, -1) == 1;
    X509_EXTENSION_free(extension);
    if (!added) return failed("a certificate cannot be extended");
  }
  return {};
}

core::Result<std::string> text_of(const Bio& bio, bool written) {
  if (!written) return failed("PEM cannot be written");
  char* data = nullptr;
  const long size = BIO_get_mem_data(bio.get(), &data);
  return std::string(data, static_cast<size_t>(size));
}

core::Result<std::string> pem_of(X509* certificate) {
  const Bio bio(BIO_new(BIO_s_mem()));
  return text_of(bio, bio && PEM_write_bio_X509(bio.get(), certificate) == 1);
}

core::Result<std::string> pem_of(EVP_PKEY* key) {
  const Bio bio(BIO_new(BIO_s_mem()));
  return text_of(bio, bio && PEM_write_bio_PKCS8PrivateKey(bio.get(), key, nullptr, nullptr, 0,
                                                           nullptr, nullptr) == 1);
}

/// Both files or neither; the certificate is for everybody to read.
core::Status write_pair(const std::string& stem, const std::string& cert, EVP_PKEY* key) {
  const auto secret = pem_of(key);
  if (!secret) return secret.error();
  if (core::Status written = write_secret(stem + ".key", *secret); !written) return written;
  core::Status written = write_secret(stem + ".pem", cert);
  if (!written) {
    (void)::unlink((stem + ".key").c_str());
    return written;
  }
  constexpr mode_t kForAll = 0644;
  (void)::chmod((stem + ".pem").c_str(), kForAll);
  return {};
}

core::Result<std::string> names_of(const CertificateRequest& request) {
  std::string names;
  const auto add = [&](const std::string& name) { names += (names.empty() ? "" : ",") + name; };
  for (const std::string& dns : request.dns) {
    const std::string plain = dns.starts_with("*.") ? dns.substr(2) : dns;
    if (!is_made_of(plain, "-_.") || dns.size() > 253) {
      return core::Error{"dns: expected a host's name, not '" + dns + "'"};
    }
    add("DNS:" + dns);
  }
  for (const std::string& ip : request.ips) {
    if (!is_ip(ip)) return core::Error{"ip: expected an IPv4 or IPv6 address, not '" + ip + "'"};
    add("IP:" + ip);
  }
  if (names.empty() && request.server) {
    add((is_ip(request.name) ? "IP:" : "DNS:") + request.name);
  }
  return names;
}

}  // namespace

core::Status make_authority(const std::string& folder, const std::string& name, int days) {
  if (core::Status sane = check_days(days); !sane) return sane;
  if (!is_made_of(name, "-_. ") || name.size() > kLongestName) {
    return core::Error{"name: expected 1 to 64 letters, digits, spaces, '-', '_' or '.'"};
  }
  std::error_code unmade;
  std::filesystem::create_directories(folder, unmade);
  if (unmade) return core::Error{folder + ": cannot be made: " + unmade.message()};
  const Key key(EVP_EC_gen("P-256"));
  if (!key) return failed("a key cannot be made");
  auto made = begin(name, key.get(), days);
  if (!made) return made.error();
  X509* const cert = made->get();
  if (X509_set_issuer_name(cert, X509_get_subject_name(cert)) != 1) {
    return failed("a certificate cannot be made");
  }
  if (core::Status extended = extend(cert, cert,
                                     {{NID_basic_constraints, "critical,CA:TRUE,pathlen:0"},
                                      {NID_key_usage, "critical,keyCertSign,cRLSign"},
                                      {NID_subject_key_identifier, "hash"}});
      !extended) {
    return extended;
  }
  if (X509_sign(cert, key.get(), EVP_sha256()) == 0) return failed("it cannot be signed");
  const auto text = pem_of(cert);
  return text ? write_pair(folder + "/ca", *text, key.get()) : core::Status(text.error());
}

core::Status issue_certificate(const std::string& folder, const CertificateRequest& request) {
  if (core::Status sane = check_days(request.days); !sane) return sane;
  if (!is_made_of(request.name, "-_.") || request.name.size() > kLongestName ||
      request.name.starts_with('.') || request.name == "ca") {
    return core::Error{
        "name: expected 1 to 64 letters, digits, '-', '_' or '.', and not 'ca', which is taken"};
  }
  if (!request.server && !request.client) {
    return core::Error{"expected --server, --client or both: who shows the certificate"};
  }
  const auto names = names_of(request);
  if (!names) return names.error();
  const auto signer = read_key_pair(folder + "/ca.pem", folder + "/ca.key");
  if (!signer) {
    return core::Error{signer.error().message + " ('hyades certs init' makes an authority)"};
  }
  const Bio cert_text(BIO_new_mem_buf(signer->cert.data(), static_cast<int>(signer->cert.size())));
  const Bio key_text(BIO_new_mem_buf(signer->key.data(), static_cast<int>(signer->key.size())));
  const Certificate authority(PEM_read_bio_X509(cert_text.get(), nullptr, nullptr, nullptr));
  const Key signing(PEM_read_bio_PrivateKey(key_text.get(), nullptr, nullptr, nullptr));
  if (!authority || !signing) return failed("the authority cannot be read");
  if (X509_check_ca(authority.get()) != 1) {
    return core::Error{folder + "/ca.pem: is not an authority's certificate: it may sign none"};
  }
  const ASN1_TIME* const end = X509_get0_notAfter(authority.get());
  if (X509_cmp_current_time(end) <= 0) {
    return core::Error{folder + "/ca.pem: has ended: make another authority in another folder"};
  }
  const Key key(EVP_EC_gen("P-256"));
  if (!key) return failed("a key cannot be made");
  auto made = begin(request.name, key.get(), request.days);
  if (!made) return made.error();
  X509* const cert = made->get();
  if (ASN1_TIME_compare(X509_get0_notAfter(cert), end) > 0 && X509_set1_notAfter(cert, end) != 1) {
    return failed("a certificate cannot be made");
  }
  if (X509_set_issuer_name(cert, X509_get_subject_name(authority.get())) != 1) {
    return failed("a certificate cannot be made");
  }
  const std::string usage = std::string(request.server ? "serverAuth" : "") +
                            (request.server && request.client ? "," : "") +
                            (request.client ? "clientAuth" : "");
  std::vector<std::pair<int, std::string>> extensions = {
      {NID_basic_constraints, "critical,CA:FALSE"},
      {NID_key_usage, "critical,digitalSignature"},
      {NID_ext_key_usage, usage},
      {NID_subject_key_identifier, "hash"},
      {NID_authority_key_identifier, "keyid:always"}};
  if (!names->empty()) extensions.emplace_back(NID_subject_alt_name, *names);
  if (core::Status extended = extend(cert, authority.get(), extensions); !extended) return extended;
  if (X509_sign(cert, signing.get(), EVP_sha256()) == 0) return failed("it cannot be signed");
  const auto text = pem_of(cert);
  if (!text) return text.error();
  return write_pair(folder + "/" + request.name, *text + signer->cert, key.get());
}

}  // namespace hyades::farm
