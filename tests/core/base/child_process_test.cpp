#include "core/base/child_process.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <string>
#include <vector>

namespace hyades::core {
namespace {

using Clock = std::chrono::steady_clock;

Status always() { return {}; }

ChildProcess shell(const std::string& script) {
  auto child = ChildProcess::start("/bin/sh", {"-c", script});
  EXPECT_TRUE(child.ok());
  return std::move(*child);
}

TEST(ChildProcess, IsFedAndEnds) {
  ChildProcess child = shell("test $(wc -c) = 3000000");
  const std::vector<std::byte> bytes(1'000'000);
  for (int i = 0; i < 3; ++i) {
    const auto fed = child.feed(bytes, always);
    ASSERT_TRUE(fed.ok() && *fed);
  }
  EXPECT_EQ(child.fed(), 3'000'000U);
  const Status ended = child.finish(always);
  EXPECT_TRUE(ended.ok()) << ended.error().message;
}

TEST(ChildProcess, SaysWhyItFailed) {
  ChildProcess child = shell("echo no such codec >&2; exit 3");
  EXPECT_EQ(child.finish(always).error().message, "sh failed (3): no such codec");
  ChildProcess killed = shell("kill -9 $$");
  EXPECT_EQ(killed.finish(always).error().message, "sh was ended by signal 9");
  // Only the end of what it says, which is where the reason is.
  ChildProcess loud = shell("seq 100000; echo the end; exit 1");
  const std::string said = loud.finish(always).error().message;
  EXPECT_LT(said.size(), 1100U);
  EXPECT_TRUE(said.ends_with("100000\nthe end"));
}

TEST(ChildProcess, OneThatReadsNoMoreIsNoSignal) {
  ChildProcess child = shell("exec <&-; echo enough; exit 4");
  const std::vector<std::byte> bytes(10'000'000);
  const auto fed = child.feed(bytes, always);
  ASSERT_TRUE(fed.ok());
  EXPECT_FALSE(*fed);
  EXPECT_EQ(child.finish(always).error().message, "sh failed (4): enough");
}

TEST(ChildProcess, IsEndedWhenItMayNotGoOn) {
  const auto begin = Clock::now();
  const auto until = [&]() -> Status {
    if (Clock::now() < begin + std::chrono::milliseconds(100)) return {};
    return Error{"too slow"};
  };
  {
    ChildProcess child = shell("exec sleep 60");
    EXPECT_EQ(child.finish(until).error().message, "too slow");
    ChildProcess deaf = shell("exec sleep 60");
    const std::vector<std::byte> bytes(10'000'000);
    const auto fed = deaf.feed(bytes, until);
    ASSERT_FALSE(fed.ok());
    EXPECT_EQ(fed.error().message, "too slow");
  }
  EXPECT_LT(Clock::now() - begin, std::chrono::seconds(20));
}

TEST(ChildProcess, ArgumentsAreNoShellsBusiness) {
  auto child =
      ChildProcess::start("/bin/sh", {"-c", "test \"$1\" = '$(exit 1); *'", "sh", "$(exit 1); *"});
  ASSERT_TRUE(child.ok());
  EXPECT_TRUE(child->finish(always).ok());
  EXPECT_EQ(ChildProcess::start("/nowhere/at-all", {}).error().message,
            "at-all could not be started: No such file or directory");
}

TEST(FindProgram, LooksIntoPath) {
  EXPECT_TRUE(find_program("sh").has_value());
  EXPECT_FALSE(find_program("no-such-program-of-anybody").has_value());
  EXPECT_FALSE(find_program("").has_value());
}

}  // namespace
}  // namespace hyades::core
