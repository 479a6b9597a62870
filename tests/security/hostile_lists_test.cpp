// Lists that a hostile coordinator lets have no end, or far more in them than they take to send.
#include <string>
#include <vector>

#include "cli/client/farm_client.h"
#include "tests/cli/client/client_testing.h"

namespace hyades::cli {
namespace {

using HostileLists = Client;

TEST_F(HostileLists, OfEmptyRowsAreNotParsed) {
  add_job("a");
  farm_.workers.resize(250'000);
  const Ran ran = run(workers_command, at({}));
  EXPECT_EQ(ran.status, kFailed);
  EXPECT_TRUE(has(ran.err, "too many parts")) << ran.err;
  EXPECT_EQ(farm_.calls, 1) << "to ask again would not help";

  v1::WatchEvent& told = farm_.events.emplace_back(event(v1::JOB_STATE_RUNNING, 0));
  for (int i = 0; i < 250'000; ++i) told.add_changed();
  const Ran watched = run(watch_command, at({"1"}));
  EXPECT_EQ(watched.status, kFailed);
  EXPECT_TRUE(has(watched.err, "too many parts")) << watched.err;
}

TEST_F(HostileLists, OfAsManyAsAFarmMayHaveCome) {
  farm_.workers.resize(20'000);
  EXPECT_EQ(run(workers_command, at({"--names"})).status, kDone);
}

}  // namespace
}  // namespace hyades::cli
