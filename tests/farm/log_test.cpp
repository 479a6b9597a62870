#include "farm/log.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

namespace hyades::farm {
namespace {

using nlohmann::json;

TEST(Log, TextIsForPeople) {
  EXPECT_EQ(log_line("hyades worker", LogFormat::text, 0, LogLevel::info, "working", {}),
            "hyades worker: working");
  EXPECT_EQ(log_line("p", LogFormat::text, 0, LogLevel::warning, "a unit failed",
                     {7, -3, "0,32 batches 0-3", "host/1"}),
            "p: WARNING: a unit failed (job 7, frame -3, unit 0,32 batches 0-3, worker host/1)");
}

TEST(Log, JsonHasTheIdsAsFields) {
  const std::string line =
      log_line("hyades coordinator", LogFormat::json, 1'700'000'000'045, LogLevel::error,
               "a \"film\"\nwas refused", {7, 3, "0,32 batches 0-3", "host/1"});
  EXPECT_EQ(line.find('\n'), std::string::npos);
  const json read = json::parse(line);
  EXPECT_EQ(read["time"], "2023-11-14T22:13:20.045Z");
  EXPECT_EQ(read["level"], "error");
  EXPECT_EQ(read["program"], "hyades coordinator");
  EXPECT_EQ(read["text"], "a \"film\"\nwas refused");
  EXPECT_EQ(read["job"], 7);
  EXPECT_EQ(read["frame"], 3);
  EXPECT_EQ(read["unit"], "0,32 batches 0-3");
  EXPECT_EQ(read["worker"], "host/1");
  const json bare = json::parse(log_line("p", LogFormat::json, 0, LogLevel::info, "x", {}));
  EXPECT_FALSE(bare.contains("job"));
  EXPECT_FALSE(bare.contains("worker"));
}

TEST(Log, NobodyForgesALine) {
  const std::string nasty = "x\n2026 forged\x1B[31m\xFF";
  const std::string text = log_line("p", LogFormat::text, 0, LogLevel::info, nasty, {});
  EXPECT_EQ(text.find('\n'), std::string::npos);
  EXPECT_EQ(text.find('\x1B'), std::string::npos);
  EXPECT_TRUE(
      json::accept(log_line("p", LogFormat::json, 0, LogLevel::info, nasty, {1, 2, nasty, nasty})));
}

TEST(Log, NamesThatAreWrongAreTold) {
  EXPECT_EQ(*read_log_level("warning"), LogLevel::warning);
  EXPECT_EQ(*read_log_format("json"), LogFormat::json);
  EXPECT_NE(read_log_level("loud").error().message.find("debug, info"), std::string::npos);
  EXPECT_NE(read_log_format("xml").error().message.find("text or json"), std::string::npos);
}

TEST(Log, LinesOfManyThreadsDoNotMix) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  const int standard_error = ::dup(STDERR_FILENO);
  ::dup2(ends[1], STDERR_FILENO);
  set_log("p", {LogLevel::info, LogFormat::json});
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([] {
      for (int i = 0; i < 30; ++i) {
        log(LogLevel::debug, "is not told");
        log(LogLevel::info, "twelve words, to make the line somewhat longer than a few bytes");
        log_later(LogLevel::info, "said by another thread", {1, 2, {}, "w"});
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  FILE* read = ::fdopen(ends[0], "r");
  char line[1000];
  // What is said later comes when it comes; all of it fits into the pipe.
  constexpr int kLines = 4 * 30 * 2;
  for (int i = 0; i < kLines && std::fgets(line, sizeof line, read) != nullptr; ++i) {
    EXPECT_TRUE(json::accept(std::string(line))) << line;
  }
  ::dup2(standard_error, STDERR_FILENO);
  ::close(standard_error);
  ::close(ends[1]);
  set_log("p");
  EXPECT_EQ(std::fgets(line, sizeof line, read), nullptr) << line;
  std::fclose(read);
}

}  // namespace
}  // namespace hyades::farm
