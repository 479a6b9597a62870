#include "farm/tls_files.h"

#include <gtest/gtest.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/x509.h>

#include <fstream>
#include <functional>
#include <memory>
#include <string>

#include "farm/channel.h"
#include "tests/support/temp_folder.h"

namespace hyades::farm {
namespace {

std::string pem_of(const std::function<void(BIO*)>& write) {
  const std::unique_ptr<BIO, decltype(&BIO_free)> bio(BIO_new(BIO_s_mem()), &BIO_free);
  write(bio.get());
  char* bytes = nullptr;
  const long size = BIO_get_mem_data(bio.get(), &bytes);
  return {bytes, static_cast<size_t>(size)};
}

/// A certificate that signs itself, and its key.
struct Made {
  std::string cert;
  std::string key;
  std::string encrypted;  ///< the same key, with a pass phrase

  Made() {
    const std::unique_ptr<EVP_PKEY, decltype(&EVP_PKEY_free)> own(EVP_EC_gen("P-256"),
                                                                  &EVP_PKEY_free);
    const std::unique_ptr<X509, decltype(&X509_free)> x509(X509_new(), &X509_free);
    X509_gmtime_adj(X509_getm_notBefore(x509.get()), 0);
    X509_gmtime_adj(X509_getm_notAfter(x509.get()), 3600);
    X509_set_pubkey(x509.get(), own.get());
    X509_sign(x509.get(), own.get(), EVP_sha256());
    cert = pem_of([&](BIO* bio) { PEM_write_bio_X509(bio, x509.get()); });
    key = pem_of([&](BIO* bio) {
      PEM_write_bio_PrivateKey(bio, own.get(), nullptr, nullptr, 0, nullptr, nullptr);
    });
    encrypted = pem_of([&](BIO* bio) {
      const unsigned char phrase[] = "secret";
      PEM_write_bio_PrivateKey(bio, own.get(), EVP_aes_128_cbc(), phrase, 6, nullptr, nullptr);
    });
  }
};

class TlsFiles : public ::testing::Test {
 protected:
  std::string put(const char* name, const std::string& text) const {
    std::ofstream(folder_.file(name)) << text;
    return folder_.file(name);
  }
  /// Every error names the file that is wrong.
  static void expect(const std::string& error, const std::string& file, const char* words) {
    EXPECT_EQ(error.find(file + ": "), 0U) << error;
    EXPECT_NE(error.find(words), std::string::npos) << error;
  }
  void expect_ca(const std::string& file, const char* words) const {
    const auto read = read_certificates(file);
    ASSERT_FALSE(read.ok()) << file;
    expect(read.error().message, file, words);
    Peer peer;
    peer.ca_file = file;
    const auto channel = connect(peer);  // of clients and workers
    ASSERT_FALSE(channel.ok()) << file;
    EXPECT_EQ(channel.error().message, read.error().message);
    Listen listen;
    listen.cert_file = put("good.pem", made_.cert);
    listen.key_file = put("good.key", made_.key);
    EXPECT_TRUE(open_door(listen).ok());
    listen.ca_file = file;
    const auto door = open_door(listen);
    ASSERT_FALSE(door.ok()) << file;
    EXPECT_EQ(door.error().message, read.error().message);
  }

  test::TempFolder folder_;
  Made made_;
};

TEST_F(TlsFiles, SignersHaveToBeThere) {
  const Made other;
  EXPECT_TRUE(read_certificates(put("ca.pem", made_.cert)).ok());
  EXPECT_TRUE(read_certificates(put("two.pem", "a remark\n" + made_.cert + other.cert)).ok());
  expect_ca(folder_.file("gone.pem"), "there is no such file");
  expect_ca(folder_.file(""), "cannot be read");
  expect_ca(put("empty.pem", ""), "holds no certificate");
  expect_ca(put("key-only.pem", made_.key), "-----BEGIN CERTIFICATE-----");
  expect_ca(put("token", "0123456789abcdef0123\n"), "holds no certificate");
  std::string cut = other.cert;
  cut.erase(cut.size() / 2, 40);
  expect_ca(put("cut.pem", made_.cert + cut), "certificate 2 in it is damaged");
}

TEST_F(TlsFiles, ACertificateAndItsKeyBelongTogether) {
  const Made other;
  const std::string cert = put("cert.pem", made_.cert);
  const auto wrong = [&](const std::string& cert_file, const std::string& key_file) {
    const auto pair = read_key_pair(cert_file, key_file);
    return pair ? "no error" : pair.error().message;
  };
  EXPECT_TRUE(read_key_pair(cert, put("key.pem", made_.key)).ok());
  EXPECT_TRUE(
      read_key_pair(put("chain.pem", made_.cert + other.cert), folder_.file("key.pem")).ok());
  const std::string others = put("other.pem", other.key);
  expect(wrong(cert, others), others, cert.c_str());
  expect(wrong(cert, put("secret.pem", made_.encrypted)), folder_.file("secret.pem"),
         "without a pass phrase");
  expect(wrong(cert, put("junk.pem", "junk")), folder_.file("junk.pem"), "holds no private key");
  expect(wrong(cert, folder_.file("gone.pem")), folder_.file("gone.pem"), "no such file");
  expect(wrong(others, folder_.file("key.pem")), others, "holds no certificate");
}

}  // namespace
}  // namespace hyades::farm
