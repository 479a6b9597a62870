// Certificates that change while they are read.
#include "coordinator/web/tls_context.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "farm/certificate_maker.h"
#include "tests/support/temp_folder.h"

namespace hyades::coordinator {
namespace {

std::string text_of(const std::string& path) {
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

class Certificates : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(farm::make_authority(folder.path().string(), "test", 2).ok());
    make("farm");
    make("renewed");
    listen.cert_file = folder.file("farm.pem");
    listen.key_file = folder.file("farm.key");
  }
  void make(const std::string& name) const {
    farm::CertificateRequest request;
    request.name = name;
    request.server = true;
    ASSERT_TRUE(farm::issue_certificate(folder.path().string(), request).ok());
  }
  void put(const std::string& name, const std::string& text) const {
    std::ofstream(folder.file(name)) << text;
  }

  test::TempFolder folder;
  farm::Listen listen;
};

TEST_F(Certificates, ThatWereReadAtABadMomentAreReadAgain) {
  TlsContext tls(listen);
  const TlsContext::Stamps first = tls.stamps();
  ASSERT_TRUE(tls.load().ok());
  tls.taken(first);
  EXPECT_FALSE(tls.changed());
  // Somebody writes into the file itself: at first half of it is there.
  const std::string whole = text_of(folder.file("renewed.pem"));
  put("farm.pem", whole.substr(0, whole.size() / 3));
  EXPECT_TRUE(tls.changed());
  EXPECT_FALSE(tls.load().ok());
  EXPECT_TRUE(tls.changed()) << "nothing was taken: it has to be looked at again";
  // The certificate is whole, its key is the old one still.
  put("farm.pem", whole);
  EXPECT_FALSE(tls.load().ok());
  EXPECT_TRUE(tls.changed());
  put("farm.key", text_of(folder.file("renewed.key")));
  const TlsContext::Stamps last = tls.stamps();
  EXPECT_TRUE(tls.load().ok());
  tls.taken(last);
  EXPECT_FALSE(tls.changed());
}

TEST_F(Certificates, ThatChangeAfterTheyWereReadAreReadAgain) {
  TlsContext tls(listen);
  const TlsContext::Stamps before = tls.stamps();
  ASSERT_TRUE(tls.load().ok());
  put("farm.pem", text_of(folder.file("renewed.pem")));
  put("farm.key", text_of(folder.file("renewed.key")));
  tls.taken(before);
  EXPECT_TRUE(tls.changed());
}

}  // namespace
}  // namespace hyades::coordinator
