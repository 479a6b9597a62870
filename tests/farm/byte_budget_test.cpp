// Whose bytes there may be how many of.
#include "farm/byte_budget.h"

#include <optional>

#include <gtest/gtest.h>

namespace hyades::farm {
namespace {

using Share = ByteBudget::Share;

TEST(ByteBudget, NobodyTakesAll) {
  ByteBudget budget(100, 40);
  Share ada(budget, {"ada"});
  ada.hold(30);
  EXPECT_TRUE(budget.has_room({"ada"}, 10));
  EXPECT_FALSE(budget.has_room({"ada"}, 11));
  Share bob(budget, {"bob"});
  bob.hold(40);
  EXPECT_TRUE(budget.has_room({"carl"}, 30));
  EXPECT_FALSE(budget.has_room({"carl"}, 31)) << "all together";
  ada.hold(10);
  EXPECT_TRUE(budget.has_room({"carl"}, 40));
  EXPECT_TRUE(budget.has_room({"ada"}, 30));
}

TEST(ByteBudget, WhatIsHeldIsWhatThereIsRoomFor) {
  ByteBudget budget(100, 40);
  Share ada(budget, {"ada"});
  Share bob(budget, {"bob"});
  Share carl(budget, {"carl"});
  EXPECT_TRUE(ada.try_hold(40));
  EXPECT_FALSE(ada.try_hold(41));
  EXPECT_TRUE(bob.try_hold(40));
  EXPECT_FALSE(carl.try_hold(21));
  EXPECT_TRUE(carl.try_hold(20)) << "nothing was held of what did not fit";
  EXPECT_FALSE(carl.try_hold(21));
  EXPECT_TRUE(ada.try_hold(39)) << "less has always room";
  EXPECT_TRUE(carl.try_hold(21));
}

TEST(ByteBudget, WhatIsLargerThanWasThoughtCountsWhole) {
  ByteBudget budget(100, 40);
  std::optional<Share> ada(std::in_place, budget, ByteBudget::Owner{"ada"});
  ada->hold(90);
  EXPECT_FALSE(budget.has_room({"ada"}, 1));
  EXPECT_FALSE(budget.has_room({"bob"}, 11));
  ada.reset();
  EXPECT_TRUE(budget.has_room({"ada"}, 40)) << "a holder that is gone holds nothing";
  EXPECT_TRUE(budget.has_room({"bob"}, 40));
}

TEST(ByteBudget, OneMachineLeavesRoomForOthersOfItsName) {
  ByteBudget budget(400, 200);
  Share one(budget, {"joining", "1"});
  EXPECT_FALSE(one.try_hold(51));
  EXPECT_TRUE(one.try_hold(50)) << "a quarter of its name's";
  Share two(budget, {"joining", "2"});
  Share three(budget, {"joining", "3"});
  Share four(budget, {"joining", "4"});
  for (Share* other : {&two, &three, &four}) EXPECT_TRUE(other->try_hold(50));
  EXPECT_FALSE(budget.has_room({"joining", "5"}, 1)) << "machines share what their name has";
  EXPECT_TRUE(budget.has_room({"ada"}, 200)) << "whoever has a name alone has all of it";
  one.hold(0);
  EXPECT_TRUE(budget.has_room({"joining", "5"}, 50));
}

}  // namespace
}  // namespace hyades::farm
