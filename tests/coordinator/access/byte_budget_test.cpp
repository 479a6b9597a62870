// Whose bytes there may be how many of.
#include "coordinator/access/byte_budget.h"

#include <gtest/gtest.h>

namespace hyades::coordinator {
namespace {

TEST(ByteBudget, NobodyTakesAll) {
  ByteBudget budget(100, 40);
  budget.take("ada", 30);
  EXPECT_TRUE(budget.has_room("ada", 10));
  EXPECT_FALSE(budget.has_room("ada", 11));
  budget.take("bob", 40);
  EXPECT_TRUE(budget.has_room("carl", 30));
  EXPECT_FALSE(budget.has_room("carl", 31)) << "all together";
  budget.give_back("ada", 20);
  EXPECT_TRUE(budget.has_room("carl", 40));
  EXPECT_TRUE(budget.has_room("ada", 30));
}

TEST(ByteBudget, WhatIsTakenIsWhatThereIsRoomFor) {
  ByteBudget budget(100, 40);
  EXPECT_TRUE(budget.try_take("ada", 40));
  EXPECT_FALSE(budget.try_take("ada", 1));
  EXPECT_TRUE(budget.try_take("bob", 40));
  EXPECT_FALSE(budget.try_take("carl", 21));
  EXPECT_TRUE(budget.try_take("carl", 20)) << "nothing was taken of what did not fit";
}

TEST(ByteBudget, WhatIsLargerThanWasThoughtCountsWhole) {
  ByteBudget budget(100, 40);
  budget.take("ada", 90);
  EXPECT_FALSE(budget.has_room("ada", 1));
  EXPECT_FALSE(budget.has_room("bob", 11));
  budget.give_back("ada", 90);
  EXPECT_TRUE(budget.has_room("ada", 40));
}

TEST(ByteBudget, StrangersOwnWhereTheyComeFrom) {
  const auto owner = [](const char* name, const char* address) {
    Caller caller;
    caller.name = name;
    caller.address = address;
    return ByteBudget::owner_of(caller);
  };
  EXPECT_EQ(owner("ada", "192.0.2.1:5000"), owner("ada", "192.0.2.2:5000"));
  EXPECT_NE(owner("ada", "192.0.2.1:5000"), owner("bob", "192.0.2.1:5000"));
  EXPECT_EQ(owner("", "192.0.2.1:5000"), owner("", "192.0.2.1:5001"));
  EXPECT_NE(owner("", "192.0.2.1:5000"), owner("", "192.0.2.2:5000"));
}

}  // namespace
}  // namespace hyades::coordinator
