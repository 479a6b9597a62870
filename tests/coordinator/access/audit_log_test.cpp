// Who did what: lines that are only added to.
#include "coordinator/access/audit_log.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <thread>
#include <vector>

#include "tests/support/temp_folder.h"

namespace hyades::coordinator {
namespace {

const Caller kAlice = {"9f3a01c2", "alice", v1::ROLE_SUBMITTER, "ipv4:10.0.0.7:4312"};

class Audit : public ::testing::Test {
 protected:
  void SetUp() override { open({.folder = folder.path().string()}); }
  void open(const AuditOptions& options) {
    log.reset();
    auto opened = AuditLog::open(options);
    ASSERT_TRUE(opened.ok()) << opened.error().message;
    log = std::move(*opened);
  }
  std::vector<v1::AuditEntry> entries() {
    log->flush();
    std::vector<v1::AuditEntry> all;
    auto reader = log->read();
    while (auto entry = reader.next()) all.push_back(std::move(*entry));
    return all;
  }
  test::TempFolder folder;
  std::unique_ptr<AuditLog> log;
};

TEST_F(Audit, WhatIsNotedIsReadAgain) {
  log->note(kAlice, "job.cancel", "7", grpc::Status::OK, "job: 7");
  log->note(kAlice, "job.delete", "8", {grpc::StatusCode::NOT_FOUND, "there is no job 8\n"}, "");
  open({.folder = folder.path().string()});
  const auto all = entries();
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].name(), "alice");
  EXPECT_EQ(all[0].token_id(), "9f3a01c2");
  EXPECT_EQ(all[0].role(), v1::ROLE_SUBMITTER);
  EXPECT_EQ(all[0].address(), "ipv4:10.0.0.7:4312");
  EXPECT_EQ(all[0].deed(), "job.cancel");
  EXPECT_EQ(all[0].target(), "7");
  EXPECT_EQ(all[0].result(), "ok");
  EXPECT_EQ(all[0].detail(), "job: 7");
  EXPECT_GT(all[0].time_ms(), 0);
  EXPECT_EQ(all[1].result(), "not_found");
  EXPECT_EQ(all[1].detail(), "there is no job 8\n") << "a line is a line";
  const auto mode = std::filesystem::status(folder.file("audit.jsonl")).permissions();
  EXPECT_EQ(mode, std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
}

TEST_F(Audit, FilesAreRotatedAndTheOldestGoes) {
  open({.folder = folder.path().string(), .most_bytes = 2000, .most_files = 3});
  for (int i = 0; i < 60; ++i) {
    log->note(kAlice, "job.cancel", std::to_string(i), grpc::Status::OK, {});
    log->flush();
  }
  const auto all = entries();
  ASSERT_FALSE(all.empty());
  EXPECT_LT(all.size(), 60U);
  for (size_t i = 1; i < all.size(); ++i) {
    EXPECT_EQ(std::stoi(all[i].target()), std::stoi(all[i - 1].target()) + 1);
  }
  EXPECT_EQ(all.back().target(), "59");
  EXPECT_TRUE(std::filesystem::exists(folder.file("audit.2.jsonl")));
  EXPECT_FALSE(std::filesystem::exists(folder.file("audit.3.jsonl")));
  for (const char* name : {"audit.jsonl", "audit.1.jsonl", "audit.2.jsonl"}) {
    EXPECT_LE(std::filesystem::file_size(folder.file(name)), 2000U) << name;
  }
}

TEST_F(Audit, ACutOrForeignLineSpoilsNoOther) {
  log->note(kAlice, "job.pause", "1", grpc::Status::OK, {});
  log.reset();
  std::ofstream(folder.file("audit.jsonl"), std::ios::app)
      << "garbage\n[1]\n{\"time_ms\": \"x\", \"deed\": 5}\n"
      << std::string(100'000, 'x') << "\n"
      << "{\"time_ms\": 12, \"deed\": \"job.re";
  open({.folder = folder.path().string()});
  log->note(kAlice, "job.resume", "1", grpc::Status::OK, {});
  const auto all = entries();
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].deed(), "job.pause");
  EXPECT_EQ(all[1].deed(), "job.resume");
}

TEST_F(Audit, RefusalsThatComeThickAndFastAreCounted) {
  const grpc::Status why = {grpc::StatusCode::UNAUTHENTICATED, "no token"};
  const Caller stranger = {{}, {}, v1::ROLE_UNSPECIFIED, "ipv4:10.0.0.9:1"};
  for (int i = 0; i < 1000; ++i) log->refuse(stranger, "job.list", why);
  log->refuse({{}, {}, v1::ROLE_UNSPECIFIED, "ipv4:10.0.0.8:1"}, "job.list", why);
  open({.folder = folder.path().string()});
  uint64_t times = 0;
  const auto all = entries();
  for (const v1::AuditEntry& entry : all) times += std::max<uint64_t>(entry.times(), 1);
  EXPECT_EQ(times, 1001U) << "none is forgotten";
  EXPECT_LT(all.size(), 20U);
}

/// How many entries stand for how many deeds, of those in this log.
std::pair<size_t, uint64_t> counted(const std::vector<v1::AuditEntry>& entries,
                                    const std::string& log) {
  std::pair<size_t, uint64_t> counted{};
  for (const v1::AuditEntry& entry : entries) {
    if (entry.log() != log) continue;
    counted.first += 1;
    counted.second += std::max<uint64_t>(entry.times(), 1);
  }
  return counted;
}

// Two thousand at once, then one a second: nobody pushes out what others did by his own deeds.
TEST_F(Audit, DeedsOfOneSubmitterThatComeThickAndFastAreCounted) {
  for (int i = 0; i < 6000; ++i) log->note(kAlice, "job.pause", "7", grpc::Status::OK, {});
  open({.folder = folder.path().string()});
  const auto [lines, deeds] = counted(entries(), "audit");
  EXPECT_EQ(deeds, 6000U) << "none is forgotten";
  EXPECT_GE(lines, 2000U);
  EXPECT_LT(lines, 3000U);
}

TEST_F(Audit, AllThatAnOperatorDoesIsNotedOneByOne) {
  Caller operator_ = kAlice;
  operator_.role = v1::ROLE_OPERATOR;
  for (int i = 0; i < 3000; ++i) log->note(operator_, "job.pause", "7", grpc::Status::OK, {});
  open({.folder = folder.path().string()});
  EXPECT_EQ(counted(entries(), "audit").first, 3000U);
}

TEST_F(Audit, WhatFailedIsAmongTheRefusalsAndCounted) {
  const grpc::Status gone = {grpc::StatusCode::NOT_FOUND, "no such job"};
  log->note(kAlice, "job.delete", "7", grpc::Status::OK, {});
  for (int i = 0; i < 1000; ++i) log->note(kAlice, "job.delete", "8", gone, {});
  open({.folder = folder.path().string()});
  const auto all = entries();
  EXPECT_EQ(counted(all, "audit"), std::pair(size_t{1}, uint64_t{1}));
  const auto [lines, failures] = counted(all, "refusals");
  EXPECT_EQ(failures, 1000U);
  EXPECT_LT(lines, 20U);
}

/// One of so many networks: 2001:db8:: and what follows, each a /64 of its own.
Caller stranger(int network) {
  char address[64];
  std::snprintf(address, sizeof address, "[2001:db8:0:%x::1]:5000", network);
  return {{}, {}, v1::ROLE_UNSPECIFIED, address};
}

const grpc::Status kNoToken = {grpc::StatusCode::UNAUTHENTICATED, "no token"};

TEST_F(Audit, ADeedStaysWhateverStrangersFromManyAddressesAreRefused) {
  open({.folder = folder.path().string(), .most_bytes = 4000, .most_files = 2});
  log->note(kAlice, "job.delete", "7", grpc::Status::OK, {});
  for (int round = 0; round < 10; ++round) {
    for (int network = 0; network < 3000; ++network) {
      log->refuse(stranger(network), "job.list", kNoToken);
    }
    log->flush();
  }
  open({.folder = folder.path().string(), .most_bytes = 4000, .most_files = 2});
  const auto all = entries();
  ASSERT_GT(all.size(), 20U) << "refusals are kept as well, as far as there is room";
  EXPECT_EQ(all[0].deed(), "job.delete") << "and nothing is gone that is older than they";
  EXPECT_EQ(all[0].target(), "7");
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    EXPECT_LE(entry.file_size(), 4000U + (64U << 10U)) << entry.path();
  }
  EXPECT_TRUE(std::filesystem::exists(folder.file("refusals.3.jsonl")));
  EXPECT_FALSE(std::filesystem::exists(folder.file("refusals.4.jsonl")));
  EXPECT_FALSE(std::filesystem::exists(folder.file("audit.1.jsonl")));
}

TEST_F(Audit, AddressesWithoutEndShareOneLimit) {
  uint64_t calls = 0;
  for (int network = 0; network < 20'000; ++network, ++calls) {
    log->refuse(stranger(network), "job.list", kNoToken);
    if (network % 2000 == 0) log->flush();
  }
  open({.folder = folder.path().string()});
  const auto all = entries();
  // One of each of the first thousand, ten of all others, and some that stand for the rest.
  EXPECT_GE(all.size(), 1000U);
  EXPECT_LE(all.size(), 1100U);
  uint64_t times = 0;
  bool told = false;
  for (const v1::AuditEntry& entry : all) {
    times += std::max<uint64_t>(entry.times(), 1);
    told = told ||
           (entry.times() > 1'000 && entry.detail().find("several addresses") != std::string::npos);
  }
  EXPECT_EQ(times, calls) << "none is forgotten";
  EXPECT_TRUE(told) << "what stands for many addresses says so";
}

TEST_F(Audit, ActionsHaveRoomWhileRefusalsWaitForTheDisk) {
  log.reset();
  const std::string pipe = folder.file("refusals.jsonl");
  std::filesystem::remove(pipe);
  // A file that takes nothing until somebody reads.
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  open({.folder = folder.path().string(), .most_waiting = 50});
  for (int network = 0; network < 900; ++network) {
    for (int i = 0; i < 3; ++i) log->refuse(stranger(network), "job.list", kNoToken);
  }
  log->note(kAlice, "job.delete", "7", grpc::Status::OK, {});
  const int reader = ::open(pipe.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  ASSERT_GE(reader, 0);
  std::atomic<bool> stop{false};
  std::string refused;
  std::thread drain([&] {
    std::vector<char> bytes(1U << 16U);
    for (;;) {
      const bool last = stop;
      const ssize_t got = ::read(reader, bytes.data(), bytes.size());
      if (got > 0) {
        refused.append(bytes.data(), static_cast<size_t>(got));
      } else if (last) {
        return;
      } else {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    }
  });
  log->flush();
  for (int i = 0; i < 20; ++i) log->refuse(stranger(5000), "job.list", kNoToken);
  log.reset();
  stop = true;
  drain.join();
  ::close(reader);
  std::ifstream actions(folder.file("audit.jsonl"));
  std::string line;
  EXPECT_TRUE(std::getline(actions, line)) << "the action is lost";
  EXPECT_NE(line.find("job.delete"), std::string::npos) << line;
  EXPECT_NE(refused.find("audit.lost"), std::string::npos) << "it was no flood";
}

TEST_F(Audit, AllKindsAreReadInOrderOfTime) {
  const auto pause = [] { std::this_thread::sleep_for(std::chrono::milliseconds(3)); };
  log->upload(kAlice, "file.upload", "ab12", "7 bytes");
  pause();
  log->note(kAlice, "job.submit", "1", grpc::Status::OK, {});
  pause();
  log->refuse(stranger(1), "job.list", kNoToken);
  pause();
  log->note(kAlice, "job.cancel", "1", grpc::Status::OK, {});
  pause();
  log->upload(kAlice, "file.upload", "cd34", "8 bytes");
  std::vector<std::string> actions;
  for (const v1::AuditEntry& entry : entries()) actions.push_back(entry.deed());
  EXPECT_EQ(actions, (std::vector<std::string>{"file.upload", "job.submit", "job.list",
                                               "job.cancel", "file.upload"}));
  EXPECT_TRUE(std::filesystem::exists(folder.file("uploads.jsonl")));
}

TEST_F(Audit, AFileThatCannotBePutAsideGrows) {
  open({.folder = folder.path().string(), .most_bytes = 400, .most_files = 2});
  log->note(kAlice, "job.cancel", "1", grpc::Status::OK, {});
  log->flush();
  std::filesystem::create_directories(folder.file("audit.1.jsonl/in the way"));
  for (int i = 0; i < 30; ++i) log->note(kAlice, "job.cancel", "2", grpc::Status::OK, {});
  EXPECT_EQ(entries().size(), 31U);
}

TEST(AuditLog, AFolderThatIsNotThereIsTold) {
  EXPECT_FALSE(AuditLog::open({.folder = "/nonexistent/here"}).ok());
}

}  // namespace
}  // namespace hyades::coordinator
