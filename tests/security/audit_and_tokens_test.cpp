// Who guesses tokens, and who would have it that something was never done.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "coordinator/access/audit_chain.h"
#include "coordinator/access/audit_log.h"
#include "tests/coordinator/web/web_world.h"
#include "tests/support/temp_folder.h"

namespace hyades::coordinator {
namespace {

namespace fs = std::filesystem;

class AuditChainTest : public ::testing::Test {
 protected:
  void note(const std::vector<std::string>& deeds) const {
    auto log = AuditLog::open({.folder = folder_.path().string(), .most_bytes = 1500});
    ASSERT_TRUE(log);
    Caller caller;
    caller.name = "ada";
    caller.address = "192.0.2.7:5000";
    for (const std::string& deed : deeds) {
      (*log)->note(caller, deed, "7", grpc::Status::OK, {});
      (*log)->flush();  // so that files turn in between
    }
  }
  /// What is wrong with which deed.
  std::vector<std::string> wrong() const {
    auto log = AuditLog::open({.folder = folder_.path().string(), .most_bytes = 1500});
    std::vector<std::string> all;
    AuditChains chains;
    AuditLog::Reader reader = (*log)->read();
    while (const auto entry = reader.next()) {
      if (const std::string what = chains.add(*entry); !what.empty()) all.push_back(entry->deed());
    }
    entries_ = chains.ends().contains("audit") ? chains.ends().at("audit").entries : 0;
    return all;
  }
  std::vector<std::string> lines() const {
    std::ifstream file(path());
    std::vector<std::string> all;
    for (std::string line; std::getline(file, line);) all.push_back(line);
    return all;
  }
  void write(const std::vector<std::string>& lines) const {
    std::ofstream file(path());
    for (const std::string& line : lines) file << line << "\n";
  }
  std::string path() const { return folder_.file("audit.jsonl"); }

  test::TempFolder folder_;
  mutable uint64_t entries_ = 0;
};

TEST_F(AuditChainTest, HoldsOverFilesAndStarts) {
  note({"job.submit", "job.pause", "job.resume", "job.cancel", "job.retry", "job.delete"});
  note({"token.create", "token.revoke"});
  EXPECT_TRUE(fs::exists(folder_.file("audit.1.jsonl"))) << "one file is no test";
  EXPECT_EQ(wrong(), std::vector<std::string>());
  EXPECT_EQ(entries_, 8U);
}

TEST_F(AuditChainTest, TellsOfLinesThatWereChangedLeftOutAndPutIn) {
  note({"job.submit", "job.cancel", "job.delete"});
  const std::vector<std::string> was = lines();
  ASSERT_EQ(was.size(), 3U);
  std::string changed = was[1];
  changed.replace(changed.find("ada"), 3, "bob");
  write({was[0], changed, was[2]});
  EXPECT_EQ(wrong(), std::vector<std::string>{"job.delete"});
  write({was[0], was[2]});
  EXPECT_EQ(wrong(), std::vector<std::string>{"job.delete"});
  write({was[0], was[1], was[1], was[2]});
  EXPECT_EQ(wrong(), std::vector<std::string>{"job.cancel"});
  std::string bare = was[1];
  bare.replace(bare.find("\"previous\":\""), 12 + 64, "\"previous\":\"");
  write({was[0], bare, was[2]});
  EXPECT_FALSE(wrong().empty());
  write(was);
  EXPECT_EQ(wrong(), std::vector<std::string>());
}

TEST_F(AuditChainTest, LinesOfOlderCoordinatorsAreFollowedOn) {
  write({R"({"deed":"job.submit","name":"ada","result":"ok","time_ms":5,"times":1})",
         R"({"deed":"job.pause","name":"ada","result":"ok","time_ms":6,"times":1})"});
  note({"job.cancel"});
  EXPECT_EQ(wrong(), std::vector<std::string>());
  EXPECT_EQ(entries_, 3U);
  std::vector<std::string> all = lines();
  all[1].replace(all[1].find("ada"), 3, "bob");
  write(all);
  EXPECT_EQ(wrong(), std::vector<std::string>{"job.cancel"});
}

TEST(SignIns, AreThrottledByAddress) {
  WebWorld world;
  world.farm.token = std::string(40, 't');
  world.start();
  std::string text;
  StoredToken row;
  ASSERT_TRUE(world.farm.authority->create("root", v1::ROLE_ADMIN, 0, text, row).ok());
  const auto sign_in = [&](const std::string& token) {
    return world.client->post("/api/v1/session", farm::Json({{"token", token}}).dump()).status;
  };
  int refused = 0;
  for (int i = 0; i < 60; ++i) {
    const int status = sign_in("hyades-deadbeef-" + std::to_string(i));
    EXPECT_TRUE(status == 401 || status == 503) << status;
    refused += status == 503 ? 1 : 0;
  }
  EXPECT_GT(refused, 30);
  EXPECT_EQ(sign_in(text), 204) << "who has a token comes in all the same";
}

}  // namespace
}  // namespace hyades::coordinator
