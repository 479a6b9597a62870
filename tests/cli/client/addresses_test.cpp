// Coordinators at several addresses: the commands find the one that leads.
#include <chrono>

#include "cli/client/farm_client.h"
#include "tests/cli/client/client_testing.h"
#include "tests/support/relay.h"

namespace hyades::cli {
namespace {

using std::chrono::seconds;

constexpr const char* kClosed = "127.0.0.1:1";

TEST_F(Client, ACommandFindsTheCoordinatorThatLeads) {
  const test::Relay silent;
  add_job("a");
  const auto begin = std::chrono::steady_clock::now();
  const std::string all = silent.address() + "," + kClosed + "," + farm_.address();
  const Ran ran = run(jobs_command, {"--names", "--coordinator", all});
  EXPECT_EQ(ran.status, kDone) << ran.err;
  EXPECT_EQ(ran.out, "a\n");
  EXPECT_EQ(ran.err, "") << "who stands by is nothing to tell of";
  EXPECT_LT(std::chrono::steady_clock::now() - begin, seconds(8)) << "3 s for the silent one";
}

TEST_F(Client, ACoordinatorThatFreezesInMidStreamIsLeftForTheNext) {
  test::Relay relay(farm_.address());
  add_job("tri");
  farm_.events = {event(v1::JOB_STATE_RUNNING, 50), event(v1::JOB_STATE_DONE, 100)};
  int first = 0;
  farm_.before_event = [&](size_t i) {
    if (i != 1 || first++ > 0) return;
    relay.freeze();
  };
  const auto begin = std::chrono::steady_clock::now();
  const Ran ran = run(watch_command, {"1", "--coordinator",
                                      relay.address() + "," + kClosed + "," + farm_.address()});
  EXPECT_EQ(ran.status, kDone) << ran.err;
  EXPECT_TRUE(has(ran.err, "job 1 is done")) << ran.err;
  EXPECT_GE(first, 2) << "it was asked again";
  EXPECT_LT(std::chrono::steady_clock::now() - begin, seconds(12)) << "4 s to notice";
}

TEST_F(Client, ACallToAFrozenCoordinatorGoesToTheNextBeforeItsTimeIsOver) {
  test::Relay relay(farm_.address());
  add_job("a");
  ClientOptions options;
  options.peer.address = relay.address() + "," + farm_.address();
  const auto client = FarmClient::open(options);
  ASSERT_TRUE(client.ok());
  v1::ListJobsResponse jobs;
  ASSERT_FALSE((*client)->call("Jobs/List", v1::ListJobsRequest(), jobs));
  relay.freeze();
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_FALSE((*client)->call("Jobs/List", v1::ListJobsRequest(), jobs));
  EXPECT_EQ(jobs.jobs_size(), 1);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, seconds(8)) << "of 20 s";
}

TEST_F(Client, NobodyAtAnyOfTheAddressesIsSaidInOneLine) {
  const auto begin = std::chrono::steady_clock::now();
  const Ran ran =
      run(jobs_command, {"--coordinator", "127.0.0.1:1,127.0.0.1:2", "--patience", "5"});
  EXPECT_EQ(ran.status, kNoAnswer);
  EXPECT_TRUE(has(ran.err, "no coordinator answers at 127.0.0.1:1,127.0.0.1:2 (Connection"))
      << ran.err;
  EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1);
  // For a moment none of several leads: that is waited for.
  EXPECT_GT(std::chrono::steady_clock::now() - begin, seconds(4));
}

TEST_F(Client, WhatIsAmissWithTlsIsNotHiddenByOneThatStandsBy) {
  const test::Relay hangs_up(kClosed);
  const Ran ran =
      run(jobs_command, {"--coordinator", hangs_up.address() + "," + kClosed, "--patience", "1"});
  EXPECT_EQ(ran.status, kNoAnswer);
  EXPECT_TRUE(has(ran.err, "cannot speak with the coordinator at " + hangs_up.address() +
                               ": it hangs up at once"))
      << ran.err;
}

TEST_F(Client, EachOfSeveralAddressesIsLookedAt) {
  for (const auto& [addresses, wrong] :
       {std::pair("127.0.0.1:1,127.0.0.1", "not '127.0.0.1'"), std::pair("127.0.0.1:1,", "not ''"),
        std::pair("x:99999,127.0.0.1:1", "not 'x:99999'")}) {
    const Ran ran = run(jobs_command, {"--coordinator", addresses});
    EXPECT_EQ(ran.status, kBadArguments) << addresses;
    EXPECT_TRUE(has(ran.err, "expected HOST:PORT")) << ran.err;
    EXPECT_TRUE(has(ran.err, wrong)) << ran.err;
  }
}

}  // namespace
}  // namespace hyades::cli
