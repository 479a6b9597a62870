// Copies of a group at many places: what rays find is what they find of placements one by one.
#include "core/geometry/point_instancer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <string>

#include "core/base/fp_mode.h"
#include "core/geometry/read_places.h"
#include "core/geometry/surface_point.h"
#include "tests/core/geometry/test_worlds.h"

namespace hyades::core {
namespace {

using test::Random;

PlaceMatrix place_of(const Mat4& m) { return {Vec3(m[0]), Vec3(m[1]), Vec3(m[2]), Vec3(m[3])}; }

/// Places in a box of half width `reach`, turned, and of sizes from 0.3 to 1.2, some mirrored.
std::vector<Mat4> some_places(size_t count, float reach) {
  Random random(3);
  std::vector<Mat4> places;
  for (size_t i = 0; i < count; ++i) {
    const float size = random.uniform(0.3F, 1.2F);
    const Vec3 scale(size, 0.8F * size, i % 3 == 0 ? -size : size);
    const Vec3 at = test::in_box(random, Vec3(-reach), Vec3(reach));
    places.push_back(test::translation(at) * test::random_rotation(random) * test::scaling(scale));
  }
  return places;
}

std::shared_ptr<const PointInstancer> instancer_of(const std::vector<Mat4>& places,
                                                   std::vector<Mat4> to_world = {Mat4(1.0F)}) {
  auto matrices = std::make_shared<std::vector<PlaceMatrix>>();
  for (const Mat4& m : places) matrices->push_back(place_of(m));
  auto instancer = std::make_shared<PointInstancer>();
  instancer->name = "places.ply";
  instancer->places = std::move(matrices);
  instancer->to_world = std::move(to_world);
  return instancer;
}

/// A ball of triangles beside a sphere and a tube.
std::vector<Placement> members() {
  auto ball = test::make_ball(2);
  compute_smooth_normals(*ball);
  for (const Vec3& p : ball->positions) ball->uvs.emplace_back(p.x + p.z, p.y);
  std::vector<Placement> all;
  all.push_back(
      test::place(ball, {test::translation({0.5F, 0.0F, 0.0F}) * test::scaling(Vec3(0.4F))}));
  all.push_back(
      test::place(Shape::Kind::sphere, 0.3F, 1.0F, {test::translation({-0.5F, 0.2F, 0.0F})}));
  all.push_back(
      test::place(Shape::Kind::cylinder, 0.1F, 0.7F, {test::translation({0.0F, 0.0F, 0.5F})}));
  return all;
}

std::vector<Placement> in_instancer(std::vector<Placement> all,
                                    const std::shared_ptr<const PointInstancer>& s) {
  for (Placement& p : all) p.instancer = s;
  return all;
}

Ray ray_at_copies(Random& random, float reach) {
  Ray ray;
  ray.origin = test::in_box(random, Vec3(-2.0F * reach), Vec3(2.0F * reach));
  ray.direction = random.direction();
  ray.time = random.uniform();
  return ray;
}

TEST(PointInstancer, RaysFindWhatTheyFindOfPlacementsOneByOne) {
  const FpMode mode;
  for (const bool moves : {false, true}) {
    std::vector<Mat4> outer = {test::translation({0.2F, -0.1F, 0.3F})};
    if (moves) outer.push_back(outer[0] * test::translation({0.5F, 0.2F, -0.3F}));
    const std::vector<Mat4> places = some_places(200, 6.0F);
    std::vector<Placement> mixed = {test::place(test::make_ball(1))};
    const auto copied = in_instancer(members(), instancer_of(places, outer));
    mixed.insert(mixed.end(), copied.begin(), copied.end());
    mixed.push_back(test::place(Shape::Kind::sphere, 0.5F, 1.0F, {test::translation({3, 3, 3})}));
    std::vector<Placement> single = {mixed.front()};
    for (const Mat4& place : places) {
      for (Placement p : members()) {
        const Mat4 inner = p.to_world[0];
        p.to_world.clear();
        for (const Mat4& m : outer) p.to_world.push_back(m * place * inner);
        single.push_back(p);
      }
    }
    single.push_back(mixed.back());
    const auto a = test::build(mixed);
    const auto b = test::build(single);
    Random random(17);
    size_t met = 0;
    size_t differ = 0;
    for (int i = 0; i < 20'000; ++i) {
      const Ray ray = ray_at_copies(random, 5.0F);
      SurfacePoint p;
      SurfacePoint q;
      const bool found = a->nearest(ray, RayKind::camera, p);
      if (found != b->nearest(ray, RayKind::camera, q)) {
        ++differ;  // past an edge
        continue;
      }
      ASSERT_EQ(a->occluded(ray), b->occluded(ray));
      if (!found) continue;
      ++met;
      const uint32_t expected = q.object == 0                   ? 0U
                                : q.object + 1 == single.size() ? 4U
                                                                : 1U + (q.object - 1U) % 3U;
      if (p.object != expected || p.primitive != q.primitive) {
        ++differ;
        continue;
      }
      ASSERT_NEAR(p.t, q.t, 1e-4F);
      ASSERT_LT(glm::length(p.position - q.position), 1e-4F);
      ASSERT_GT(glm::dot(p.ng, q.ng), 0.9999F);
      ASSERT_GT(glm::dot(p.ns, q.ns), 0.9999F);
      ASSERT_LT(glm::length(p.uv - q.uv), 1e-3F);
      ASSERT_LT(glm::length(p.dpdu - q.dpdu), 1e-2F * glm::length(q.dpdu));
      const Vec3 here = transform_point(p.world_to_object, p.position);
      ASSERT_LT(glm::length(here - transform_point(q.world_to_object, q.position)), 1e-3F);
      const auto hit = a->intersect(ray, RayKind::camera);
      ASSERT_TRUE(hit);
      const SurfacePoint again = a->surface(ray, *hit);
      ASSERT_EQ(std::memcmp(&again.position, &p.position, sizeof(Vec3)), 0);
      ASSERT_EQ(again.clearance, p.clearance);
      ASSERT_EQ(again.object, p.object);
    }
    EXPECT_GT(met, 2000U);
    EXPECT_LT(differ, 10U);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(a->bounds().lower[c], b->bounds().lower[c], 2.0F);
      EXPECT_NEAR(a->bounds().upper[c], b->bounds().upper[c], 2.0F);
    }
  }
}

TEST(PointInstancer, RaysLeaveTheirSurface) {
  const FpMode mode;
  // Far from each other, far from the middle of the world, and large.
  std::vector<Mat4> places;
  Random random(5);
  for (int i = 0; i < 50; ++i) {
    places.push_back(test::translation({1000.0F * static_cast<float>(i), -3e4F, 2e4F}) *
                     test::random_rotation(random) * test::scaling(Vec3(30.0F, 20.0F, 25.0F)));
  }
  std::vector<Placement> all = {
      test::place(test::make_ball(3)),
      test::place(Shape::Kind::sphere, 0.5F, 1.0F, {test::translation({5.0F, 0.0F, 0.0F})})};
  const auto world = test::build(in_instancer(all, instancer_of(places)));
  int met = 0;
  for (int i = 0; i < 40'000; ++i) {
    const Mat4& place = places[test::pick(random, places.size())];
    const float side = i % 2 == 0 ? 0.0F : 5.0F;
    const Vec3 middle = transform_point(place, Vec3(side, 0.0F, 0.0F));
    Ray ray;
    ray.origin = middle + 200.0F * random.direction();
    ray.direction = glm::normalize(middle + 12.0F * random.direction() - ray.origin);
    SurfacePoint on;
    if (!world->nearest(ray, RayKind::diffuse, on)) continue;
    ++met;
    Vec3 out = random.direction();
    if (glm::dot(out, on.ng) < 0.0F) out = -out;
    ASSERT_FALSE(world->occluded(spawn_ray(on, out, 50.0F))) << i << " object " << on.object;
  }
  EXPECT_GT(met, 20'000);
}

TEST(PointInstancer, RaysLeaveWhatIsFarFromTheMiddleOfItsCopy) {
  const FpMode mode;
  const Vec3 far(2e4F, -1e4F, 3e4F);
  Random random(6);
  std::vector<Mat4> places;
  for (int i = 0; i < 20; ++i) {
    places.push_back(test::translation({3.0F * static_cast<float>(i), 0.0F, 0.0F}) *
                     test::random_rotation(random) * test::translation(-far));
  }
  const std::vector<Placement> all = {
      test::place(test::make_ball(3), {test::translation(far)}),
  };
  const auto world = test::build(in_instancer(all, instancer_of(places)));
  int met = 0;
  for (int i = 0; i < 40'000; ++i) {
    const Vec3 middle(3.0F * static_cast<float>(test::pick(random, places.size())), 0.0F, 0.0F);
    Ray ray;
    ray.origin = middle + 5.0F * random.direction();
    ray.direction = glm::normalize(middle + 0.5F * random.direction() - ray.origin);
    SurfacePoint on;
    if (!world->nearest(ray, RayKind::diffuse, on)) continue;
    ++met;
    Vec3 out = random.direction();
    if (glm::dot(out, on.ng) < 0.0F) out = -out;
    ASSERT_FALSE(world->occluded(spawn_ray(on, out, 0.3F))) << i;
  }
  EXPECT_GT(met, 30'000);
}

TEST(PointInstancer, SeesTheMasksOfItsMembers) {
  const FpMode mode;
  std::vector<Placement> all = {test::place(test::make_ball(2))};
  all[0].seen_by = RayKind::scattered | RayKind::shadow;
  all[0].blocks_light = false;
  const auto world =
      test::build(in_instancer(all, instancer_of({Mat4(1.0F), test::translation({5, 0, 0})})));
  const Ray ray{{5.0F, 0.1F, 5.0F}, {0.0F, 0.0F, -1.0F}, kInfinity, 0.0F};
  EXPECT_FALSE(world->intersect(ray, RayKind::camera));
  EXPECT_TRUE(world->intersect(ray, RayKind::diffuse));
  EXPECT_FALSE(world->occluded(ray));
}

TEST(PointInstancer, FramesShareIt) {
  GeometryCache cache;
  const auto instancer = instancer_of(some_places(100, 5.0F));
  std::vector<Placement> all = in_instancer(members(), instancer);
  all.push_back(test::place(Shape::Kind::sphere, 1.0F, 1.0F));
  const auto first = build_world(all, cache, test::tested_class());
  ASSERT_TRUE(first);
  all.back().to_world = {test::translation({1.0F, 0.0F, 0.0F})};
  const auto second = build_world(all, cache, test::tested_class());
  ASSERT_TRUE(second);
  const size_t alone = (*first)->memory();
  EXPECT_NEAR(static_cast<double>((*second)->memory()), static_cast<double>(alone), 4096.0);
  EXPECT_EQ(&(*first)->placement(0), &(*second)->placement(0));
}

TEST(PointInstancer, OnesThatDifferAreNotShared) {
  const FpMode mode;
  GeometryCache cache;
  const auto height_at = [&](const std::vector<Placement>& all) {
    const auto world = build_world(all, cache, test::tested_class());
    EXPECT_TRUE(world);
    SurfacePoint p;
    const Ray ray{{0.0F, 20.0F, 0.0F}, {0.0F, -1.0F, 0.0F}, kInfinity, 0.0F};
    return (*world)->nearest(ray, RayKind::diffuse, p) ? p.position.y : -100.0F;
  };
  const auto ball = test::place(Shape::Kind::sphere, 1.0F, 1.0F);
  auto large = ball;
  large.shape.radius = 2.0F;
  const auto here = instancer_of({Mat4(1.0F)});
  const auto above = instancer_of({test::translation({0.0F, 5.0F, 0.0F})});
  EXPECT_FLOAT_EQ(height_at(in_instancer({ball}, here)), 1.0F);
  EXPECT_FLOAT_EQ(height_at(in_instancer({large}, here)), 2.0F);
  EXPECT_FLOAT_EQ(height_at(in_instancer({ball}, above)), 6.0F);
  EXPECT_FLOAT_EQ(height_at({ball}), 1.0F);
}

TEST(PointInstancer, PlacesThatLeadNowhereAreRefused) {
  const auto complaint = [](const Mat4& place) {
    GeometryCache cache;
    const auto world = build_world(in_instancer(members(), instancer_of({Mat4(1.0F), place})),
                                   cache, test::tested_class());
    return world ? std::string("none") : world.error().message;
  };
  Mat4 nowhere(1.0F);
  nowhere[2].y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_NE(complaint(nowhere).find("copy 1 of places.ply"), std::string::npos);
  EXPECT_NE(complaint(test::scaling({1.0F, 0.0F, 1.0F})).find("is flat"), std::string::npos);
  EXPECT_NE(complaint(test::scaling(Vec3(1e-7F))).find("is flat"), std::string::npos);
  EXPECT_NE(complaint(test::scaling(Vec3(1e14F))).find("1e12"), std::string::npos);
  EXPECT_EQ(complaint(test::scaling(Vec3(1e-4F))), "none");
}

// --- files of places -----------------------------------------------------------------------------

class OneFile : public AssetResolver {
 public:
  explicit OneFile(std::string text) : text_(std::make_shared<std::string>(std::move(text))) {}
  Result<Bytes> open(const std::string&, const std::string&) override {
    return Bytes{text_, std::as_bytes(std::span(*text_))};
  }

 private:
  std::shared_ptr<std::string> text_;
};

Result<std::shared_ptr<const std::vector<PlaceMatrix>>> read_copies(const std::string& text,
                                                                    size_t room = 0) {
  OneFile file(text);
  return read_places(file, "p.ply", room);
}

std::string complaint(const std::string& text, size_t room = 0) {
  const auto places = read_copies(text, room);
  return places ? "none" : places.error().message;
}

std::string ascii(const std::string& properties, const std::string& rows, int count = 1) {
  std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(count) + "\n";
  std::string word;
  for (const char c : properties + " ") {
    if (c != ' ') {
      word += c;
    } else {
      text += "property float " + word + "\n";
      word.clear();
    }
  }
  return text + "end_header\n" + rows + "\n";
}

TEST(Places, AreScaledThenTurnedThenMoved) {
  const auto places = read_copies(ascii("x y z scale_x scale_y scale_z qx qy qz qw scale",
                                        "1 2 3 2 3 4 0 0 1.4142136 1.4142136 10"));
  ASSERT_TRUE(places) << places.error().message;
  const PlaceMatrix& m = (*places)->front();  // a quarter turn around z
  EXPECT_LT(glm::length(m[0] - Vec3(0, 20, 0)), 1e-5F);
  EXPECT_LT(glm::length(m[1] - Vec3(-30, 0, 0)), 1e-5F);
  EXPECT_LT(glm::length(m[2] - Vec3(0, 0, 40)), 1e-5F);
  EXPECT_EQ(m[3], Vec3(1, 2, 3));
}

TEST(Places, GoThroughFilesToTheLastBit) {
  std::vector<PlaceMatrix> places;
  for (const Mat4& m : some_places(70'000, 50.0F)) places.push_back(place_of(m));
  const Bytes bytes = places_bytes(places);
  const auto back = read_copies(std::string(bytes.chars(), bytes.size()));
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_TRUE(**back == places);
  std::string damaged(bytes.chars(), bytes.size());
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(damaged.data() + damaged.size() - 48 * 7, &nan, 4);
  EXPECT_EQ(complaint(damaged), "p.ply: vertex 69993: a number of its matrix is not finite");
}

TEST(Places, Errors) {
  EXPECT_NE(complaint("v 1 2 3\n").find("no PLY file"), std::string::npos);
  EXPECT_NE(complaint(ascii("x y", "1 2")).find("no x, y and z"), std::string::npos);
  EXPECT_NE(complaint(ascii("x y z qx", "1 2 3 4")).find("all four"), std::string::npos);
  EXPECT_NE(complaint(ascii("x y z scale_x", "1 2 3 4")).find("all three"), std::string::npos);
  EXPECT_NE(complaint(ascii("m00 m01", "1 2")).find("all twelve"), std::string::npos);
  EXPECT_NE(complaint(ascii("x y z", "1 nan 3")).find("vertex 0: its position"), std::string::npos);
  EXPECT_NE(complaint(ascii("x y z scale", "1 2 3 inf")).find("its scale"), std::string::npos);
  EXPECT_NE(complaint(ascii("x y z qx qy qz qw", "1 2 3 0 0 0 0")).find("no direction"),
            std::string::npos);
  EXPECT_NE(complaint(ascii("x y z", "1 2 3", 2)).find("too short"), std::string::npos);
  EXPECT_NE(complaint(ascii("x y z", "", 0)).find("no places"), std::string::npos);
  EXPECT_NE(complaint(ascii("x y z", "1 2 3", 2'000'000'000)).find("too short"), std::string::npos);
}

TEST(Places, MoreThanThereIsRoomForIsToldBeforeAnyIsRead) {
  std::vector<PlaceMatrix> places(10'000, place_of(Mat4(1.0F)));
  const Bytes bytes = places_bytes(places);
  const std::string text(bytes.chars(), bytes.size());
  EXPECT_EQ(complaint(text, 10'000 * kBytesPerCopy), "none");
  EXPECT_EQ(complaint(text, 1'048'576),
            "p.ply: 10000 copies take about 1 MB, but there are 1 MB only");
}

}  // namespace
}  // namespace hyades::core
