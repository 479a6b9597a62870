#include "core/scene/medium_stack.h"

#include <gtest/gtest.h>

#include <deque>
#include <vector>

#include "core/media/make_medium.h"
#include "core/scene/rank_bodies.h"

namespace hyades::core {
namespace {

Body body_of(uint32_t rank, float index, MediumPtr medium = nullptr) {
  Body body;
  body.rank = rank;
  body.index = index;
  body.medium = std::move(medium);
  body.open = index == 0.0F;
  return body;
}

MediumPtr some_medium() { return make_homogeneous(Rgb(0.0F), Rgb(1.0F), Rgb(0.0F), Phase()); }

TEST(MediumStack, TheHighestRankFillsThePlaceHoweverOneGotThere) {
  const MediumPtr air = some_medium();
  const Body water = body_of(0, 1.33F, some_medium());
  const Body glass = body_of(1, 1.5F, some_medium());
  const Body smoke = body_of(2, 0.0F, some_medium());
  for (const std::vector<const Body*>& order : {std::vector<const Body*>{&water, &glass, &smoke},
                                                {&smoke, &water, &glass},
                                                {&glass, &smoke, &water}}) {
    MediumStack stack(air.get());
    EXPECT_TRUE(stack.empty());
    EXPECT_EQ(stack.medium(), air.get());
    for (const Body* body : order) stack.enter(*body);
    EXPECT_EQ(stack.medium(), smoke.medium.get());
    EXPECT_TRUE(stack.open());
    EXPECT_EQ(stack.index_outside(nullptr), 1.5F);
    EXPECT_EQ(stack.index_outside(&glass), 1.33F);
    EXPECT_EQ(stack.index_outside(&water), 1.5F);
    EXPECT_TRUE(stack.hides(&water));
    EXPECT_FALSE(stack.hides(&glass)) << "smoke has no index";
    EXPECT_FALSE(stack.hides(&smoke));
    EXPECT_FALSE(stack.hides(nullptr));
    stack.leave(smoke);
    EXPECT_EQ(stack.medium(), glass.medium.get());
    EXPECT_FALSE(stack.open());
    stack.leave(glass);
    EXPECT_EQ(stack.medium(), water.medium.get());
    EXPECT_FALSE(stack.hides(&water));
    EXPECT_EQ(stack.index_outside(&water), 1.0F);
    stack.leave(water);
    EXPECT_EQ(stack.medium(), air.get());
  }
}

TEST(MediumStack, ForgivesSurfacesThatAreMissedOrMetTwice) {
  const Body water = body_of(0, 1.33F);
  const Body glass = body_of(1, 1.5F);
  MediumStack stack;
  stack.leave(glass);
  EXPECT_TRUE(stack.empty());
  stack.enter(glass);
  stack.enter(glass);
  stack.enter(water);
  stack.leave(glass);
  EXPECT_EQ(stack.index_outside(nullptr), 1.33F);
  stack.leave(water);
  EXPECT_TRUE(stack.empty());
}

TEST(MediumStack, OfTooManyBodiesForgetsTheLowest) {
  std::deque<Body> bodies;
  for (uint32_t i = 0; i < 100; ++i) bodies.push_back(body_of(i, 1.0F + static_cast<float>(i)));
  for (const bool upwards : {true, false}) {
    MediumStack stack;
    for (size_t i = 0; i < bodies.size(); ++i)
      stack.enter(bodies[upwards ? i : bodies.size() - 1 - i]);
    EXPECT_EQ(stack.index_outside(nullptr), 100.0F);
    for (size_t i = bodies.size(); i-- > 60;) stack.leave(bodies[i]);
    EXPECT_EQ(stack.index_outside(nullptr), 60.0F);
    for (const Body& body : bodies) stack.leave(body);
    EXPECT_TRUE(stack.empty());
  }
}

Bounds cube(float half, float x = 0.0F) {
  Bounds bounds;
  bounds.include(Vec3(x - half, -half, -half));
  bounds.include(Vec3(x + half, half, half));
  return bounds;
}

TEST(RankBodies, GoesByPriorityThenSizeThenOrder) {
  const Bounds any = cube(1.0F);  // bounds change when a body turns: they do not count
  const std::vector<BodyExtent> bodies = {{0, true, 1.0, any},
                                          {1, true, 99.0, any},
                                          {0, true, 1.0 - 1e-6, cube(2.0F)},
                                          {0, true, 0.5, cube(3.0F)},
                                          {-1, true, 0.1, any}};
  EXPECT_EQ(rank_bodies(bodies), (std::vector<uint32_t>{1, 4, 2, 3, 0}));
}

TEST(RankBodies, OnlyBodiesThatTouchAHigherOneMayBeHidden) {
  const std::vector<BodyExtent> bodies = {
      {0, true, 1.0, cube(1.0F)},          // touched by 1
      {1, true, 1.0, cube(1.0F, 2.0F)},    // the higher of the two
      {0, true, 1.0, cube(1.0F, 9.0F)},    // alone
      {0, false, 1.0, cube(1.0F)},         // null
      {0, true, 1.0, cube(0.5F, -20.0F)},  // touched by a null one
      {5, false, 1.0, cube(1.0F, -20.0F)}};
  EXPECT_EQ(may_be_hidden(bodies, rank_bodies(bodies)),
            (std::vector<bool>{true, false, false, false, false, false}));
}

}  // namespace
}  // namespace hyades::core
