// TLS over real gRPC: who is believed, who is not, and workers that show certificates.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include <openssl/pem.h>
#include <openssl/x509.h>

#include "farm/certificate_maker.h"
#include "farm/openssl_objects.h"
#include "farm/small_file.h"
#include "hyades/v1/admin.grpc.pb.h"
#include "tests/coordinator/services/farm_world.h"

namespace hyades::coordinator {
namespace {

class Secured : public ::testing::Test {
 protected:
  void SetUp() override {
    make("certs");
    make("elsewhere");
    farm::CertificateRequest server;
    server.name = "farm";
    server.ips = {"127.0.0.1"};
    server.server = true;
    ASSERT_TRUE(farm::issue_certificate(certs, server).ok());
    world.how.cert_file = certs + "/farm.pem";
    world.how.key_file = certs + "/farm.key";
  }
  void make(const std::string& folder) const {
    ASSERT_TRUE(farm::make_authority(world.folder.file(folder), folder, 10).ok());
    farm::CertificateRequest client;
    client.name = "node";
    client.client = true;
    ASSERT_TRUE(farm::issue_certificate(world.folder.file(folder), client).ok());
  }
  void start() {
    world.start();
    std::string text;
    StoredToken row;
    ASSERT_TRUE(world.authority->create("root", v1::ROLE_ADMIN, 0, text, row).ok());
    ASSERT_TRUE(world.authority->create("node", v1::ROLE_WORKER, 0, worker, row).ok());
    admin = text;
  }
  /// What `token` hears over a connection of its own.
  grpc::Status ask(const farm::Peer& peer, const std::string& token,
                   std::chrono::milliseconds timeout = 10s) const {
    const auto channel = farm::connect(peer);
    EXPECT_TRUE(channel.ok()) << (channel ? "" : channel.error().message);
    if (!channel) return grpc::Status::CANCELLED;
    const auto stub = v1::Admin::NewStub(*channel);
    grpc::ClientContext context;
    farm::prepare(context, token, timeout);
    v1::WhoAmIResponse me;
    return stub->WhoAmI(&context, {}, &me);
  }
  farm::Peer peer() const {
    farm::Peer peer;
    peer.address = world.address;
    peer.ca_file = certs + "/ca.pem";
    return peer;
  }
  std::string trouble(const farm::Peer& with) const {
    const grpc::Status status = ask(with, admin);
    EXPECT_EQ(status.error_code(), grpc::StatusCode::UNAVAILABLE);
    return farm::tls_trouble(status.error_message(), with).value_or(status.error_message());
  }

  FarmWorld world;
  const std::string certs = world.folder.file("certs");
  std::string admin;
  std::string worker;
};

TEST_F(Secured, OnlyTheRightAuthorityNameAndTokenComeTogether) {
  start();
  EXPECT_TRUE(ask(peer(), admin).ok()) << ask(peer(), admin).error_message();
  EXPECT_EQ(ask(peer(), "").error_code(), grpc::StatusCode::UNAUTHENTICATED);
  farm::Peer wrong = peer();
  wrong.ca_file = world.folder.file("elsewhere/ca.pem");
  EXPECT_NE(trouble(wrong).find("not signed by"), std::string::npos) << trouble(wrong);
  wrong = peer();
  wrong.address = "localhost" + world.address.substr(world.address.rfind(':'));
  EXPECT_NE(trouble(wrong).find("for another name"), std::string::npos) << trouble(wrong);
  wrong = peer();
  wrong.ca_file.clear();
  EXPECT_FALSE(ask(wrong, admin).ok()) << "plain text";
}

TEST_F(Secured, ACertificateThatHasEndedIsNotBelieved) {
  const auto read = [&](const std::string& name) {
    return *farm::read_small_file(certs + "/" + name);
  };
  const std::string cert_text = read("farm.pem");
  const std::string key_text = read("ca.key");
  const farm::Bio cert_bio(BIO_new_mem_buf(cert_text.data(), static_cast<int>(cert_text.size())));
  const farm::Bio key_bio(BIO_new_mem_buf(key_text.data(), static_cast<int>(key_text.size())));
  const farm::Certificate cert(PEM_read_bio_X509(cert_bio.get(), nullptr, nullptr, nullptr));
  const farm::Key key(PEM_read_bio_PrivateKey(key_bio.get(), nullptr, nullptr, nullptr));
  X509_gmtime_adj(X509_getm_notBefore(cert.get()), -7200);
  X509_gmtime_adj(X509_getm_notAfter(cert.get()), -3600);
  ASSERT_NE(X509_sign(cert.get(), key.get(), EVP_sha256()), 0);
  const farm::Bio out(BIO_new(BIO_s_mem()));
  ASSERT_EQ(PEM_write_bio_X509(out.get(), cert.get()), 1);
  char* data = nullptr;
  const long size = BIO_get_mem_data(out.get(), &data);
  std::ofstream(certs + "/farm.pem") << std::string(data, static_cast<size_t>(size));
  start();
  EXPECT_NE(trouble(peer()).find("not valid today"), std::string::npos) << trouble(peer());
}

TEST_F(Secured, WorkersShowCertificatesWhereTheyAreAskedTo) {
  world.how.worker_ca_file = certs + "/ca.pem";
  start();
  EXPECT_TRUE(ask(peer(), admin).ok()) << "people need none";
  const grpc::Status bare = ask(peer(), worker);
  EXPECT_EQ(bare.error_code(), grpc::StatusCode::UNAUTHENTICATED);
  EXPECT_NE(bare.error_message().find("--tls-cert"), std::string::npos) << bare.error_message();
  farm::Peer showing = peer();
  showing.cert_file = certs + "/node.pem";
  showing.key_file = certs + "/node.key";
  EXPECT_TRUE(ask(showing, worker).ok()) << ask(showing, worker).error_message();
  showing.cert_file = world.folder.file("elsewhere/node.pem");
  showing.key_file = world.folder.file("elsewhere/node.key");
  EXPECT_FALSE(ask(showing, worker).ok()) << "another's";
}

TEST_F(Secured, CertificatesAreTakenUpWhenTheyChange) {
  start();
  ASSERT_TRUE(ask(peer(), admin).ok());
  // Another authority's from now on: who trusts the first one is refused, who trusts it gets in.
  const std::string other = world.folder.file("elsewhere");
  farm::CertificateRequest server;
  server.name = "farm";
  server.ips = {"127.0.0.1"};
  server.server = true;
  ASSERT_TRUE(farm::issue_certificate(other, server).ok());
  std::filesystem::rename(other + "/farm.key", certs + "/farm.key");
  std::filesystem::rename(other + "/farm.pem", certs + "/farm.pem");
  farm::Peer renewed = peer();
  renewed.ca_file = other + "/ca.pem";
  EXPECT_TRUE(eventually([&] { return ask(renewed, admin, 1s).ok(); }));
  EXPECT_FALSE(ask(peer(), admin, 1s).ok());
}

}  // namespace
}  // namespace hyades::coordinator
