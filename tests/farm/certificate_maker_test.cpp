// A farm's own certificates, read back with OpenSSL.
#include "farm/certificate_maker.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>

#include <openssl/pem.h>
#include <openssl/x509v3.h>

#include "farm/openssl_objects.h"
#include "farm/small_file.h"
#include "farm/tls_files.h"
#include "tests/support/temp_folder.h"

namespace hyades::farm {
namespace {

Certificate read(const std::string& file) {
  const std::string text = *read_small_file(file);
  const Bio bio(BIO_new_mem_buf(text.data(), static_cast<int>(text.size())));
  return Certificate(PEM_read_bio_X509(bio.get(), nullptr, nullptr, nullptr));
}

/// What OpenSSL finds wrong with the certificate, shown for `purpose`.
int verify(X509* cert, X509* authority, int purpose) {
  X509_STORE* trusted = X509_STORE_new();
  X509_STORE_add_cert(trusted, authority);
  X509_STORE_CTX* context = X509_STORE_CTX_new();
  X509_STORE_CTX_init(context, trusted, cert, nullptr);
  X509_STORE_CTX_set_purpose(context, purpose);
  X509_verify_cert(context);
  const int error = X509_STORE_CTX_get_error(context);
  X509_STORE_CTX_free(context);
  X509_STORE_free(trusted);
  return error;
}

mode_t mode_of(const std::string& file) {
  struct stat facts {};
  EXPECT_EQ(::stat(file.c_str(), &facts), 0) << file;
  return facts.st_mode & 0777U;
}

class Certificates : public ::testing::Test {
 protected:
  void SetUp() override {
    const core::Status made = make_authority(dir, "Some farm", 100);
    ASSERT_TRUE(made.ok()) << made.error().message;
  }
  CertificateRequest request(const std::string& name) const {
    CertificateRequest wanted;
    wanted.name = name;
    wanted.server = true;
    return wanted;
  }
  test::TempFolder folder;
  const std::string dir = folder.file("certs");
};

TEST_F(Certificates, AreSignedForTheirUseAndNames) {
  CertificateRequest wanted = request("host");
  wanted.dns = {"farm.example", "*.farm.example"};
  wanted.ips = {"10.0.0.7", "::1"};
  ASSERT_TRUE(issue_certificate(dir, wanted).ok());
  const Certificate authority = read(dir + "/ca.pem");
  const Certificate server = read(dir + "/host.pem");
  EXPECT_EQ(verify(server.get(), authority.get(), X509_PURPOSE_SSL_SERVER), X509_V_OK);
  EXPECT_NE(verify(server.get(), authority.get(), X509_PURPOSE_SSL_CLIENT), X509_V_OK);
  EXPECT_EQ(X509_check_host(server.get(), "farm.example", 0, 0, nullptr), 1);
  EXPECT_EQ(X509_check_host(server.get(), "a.farm.example", 0, 0, nullptr), 1);
  EXPECT_NE(X509_check_host(server.get(), "host", 0, 0, nullptr), 1);
  EXPECT_EQ(X509_check_ip_asc(server.get(), "10.0.0.7", 0), 1);
  EXPECT_EQ(X509_check_ip_asc(server.get(), "::1", 0), 1);
  EXPECT_NE(X509_check_ip_asc(server.get(), "10.0.0.8", 0), 1);
  EXPECT_TRUE(read_key_pair(dir + "/host.pem", dir + "/host.key").ok());

  CertificateRequest node = request("node-17");
  node.server = false;
  node.client = true;
  ASSERT_TRUE(issue_certificate(dir, node).ok());
  const Certificate client = read(dir + "/node-17.pem");
  EXPECT_EQ(verify(client.get(), authority.get(), X509_PURPOSE_SSL_CLIENT), X509_V_OK);
  EXPECT_NE(verify(client.get(), authority.get(), X509_PURPOSE_SSL_SERVER), X509_V_OK);
  // A leaf signs nothing.
  EXPECT_NE(verify(client.get(), server.get(), X509_PURPOSE_SSL_CLIENT), X509_V_OK);
  EXPECT_EQ(X509_check_ca(server.get()), 0);
}

TEST_F(Certificates, KeysAreForTheirOwnerAlone) {
  ASSERT_TRUE(issue_certificate(dir, request("host")).ok());
  EXPECT_EQ(mode_of(dir + "/ca.key"), 0600U);
  EXPECT_EQ(mode_of(dir + "/host.key"), 0600U);
  EXPECT_EQ(mode_of(dir + "/host.pem"), 0644U);
}

TEST_F(Certificates, NothingIsWrittenOver) {
  const std::string key = *read_small_file(dir + "/ca.key");
  const core::Status again = make_authority(dir, "Other farm", 100);
  ASSERT_FALSE(again.ok());
  EXPECT_NE(again.error().message.find("ca.key: is there already"), std::string::npos);
  EXPECT_EQ(*read_small_file(dir + "/ca.key"), key);
  std::ofstream(dir + "/host.pem") << "somebody's";
  EXPECT_FALSE(issue_certificate(dir, request("host")).ok());
  EXPECT_EQ(*read_small_file(dir + "/host.pem"), "somebody's");
  EXPECT_FALSE(std::filesystem::exists(dir + "/host.key")) << "both or neither";
}

TEST_F(Certificates, EndWithTheirAuthorityAtTheLatest) {
  CertificateRequest wanted = request("host");
  wanted.days = 5000;
  ASSERT_TRUE(issue_certificate(dir, wanted).ok());
  const Certificate host = read(dir + "/host.pem");
  const Certificate authority = read(dir + "/ca.pem");
  EXPECT_EQ(ASN1_TIME_compare(X509_get0_notAfter(host.get()), X509_get0_notAfter(authority.get())),
            0);
}

TEST_F(Certificates, NonsenseIsRefused) {
  const auto refused = [&](const CertificateRequest& wanted) {
    return !issue_certificate(dir, wanted).ok();
  };
  for (const char* name : {"", "../host", "a b", "ca", ".hidden", "a/b"}) {
    EXPECT_TRUE(refused(request(name))) << name;
  }
  CertificateRequest wanted = request("host");
  for (const char* dns : {"", "farm,IP:1.2.3.4", "a b", "*", "farm\nexample"}) {
    wanted.dns = {dns};
    EXPECT_TRUE(refused(wanted)) << dns;
  }
  wanted.dns.clear();
  wanted.ips = {"10.0.0"};
  EXPECT_TRUE(refused(wanted));
  wanted.ips.clear();
  wanted.days = 0;
  EXPECT_TRUE(refused(wanted));
  wanted.days = 10;
  wanted.server = false;
  EXPECT_TRUE(refused(wanted)) << "for nobody";
  EXPECT_FALSE(std::filesystem::exists(dir + "/host.key"));
  EXPECT_FALSE(issue_certificate(folder.file("nowhere"), request("host")).ok());
  EXPECT_FALSE(make_authority(folder.file("x"), "a\nb", 1).ok());
  // What is no authority signs nothing.
  ASSERT_TRUE(issue_certificate(dir, request("host")).ok());
  const std::string other = folder.file("other");
  std::filesystem::create_directories(other);
  std::filesystem::copy(dir + "/host.pem", other + "/ca.pem");
  std::filesystem::copy(dir + "/host.key", other + "/ca.key");
  EXPECT_FALSE(issue_certificate(other, request("leaf")).ok());
}

}  // namespace
}  // namespace hyades::farm
