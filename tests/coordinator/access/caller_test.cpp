// For whom callers have bytes held.
#include "coordinator/access/caller.h"

#include <gtest/gtest.h>

namespace hyades::coordinator {
namespace {

TEST(Caller, StrangersOwnWhereTheyComeFrom) {
  const auto owner = [](const char* name, const char* address) {
    Caller caller;
    caller.name = name;
    caller.address = address;
    return owner_of(caller).name;
  };
  EXPECT_EQ(owner("ada", "192.0.2.1:5000"), owner("ada", "192.0.2.2:5000"));
  EXPECT_NE(owner("ada", "192.0.2.1:5000"), owner("bob", "192.0.2.1:5000"));
  EXPECT_EQ(owner("", "192.0.2.1:5000"), owner("", "192.0.2.1:5001"));
  EXPECT_NE(owner("", "192.0.2.1:5000"), owner("", "192.0.2.2:5000"));
}

TEST(Caller, MachinesWithTokensOfTheirOwnAreTold) {
  Caller caller;
  caller.name = "joining";
  caller.worker = "node-7";
  EXPECT_EQ(owner_of(caller).machine, "node-7");
  caller.worker.clear();
  EXPECT_EQ(owner_of(caller).machine, "");
}

}  // namespace
}  // namespace hyades::coordinator
