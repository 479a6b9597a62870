#include "core/textures/mapping.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/textures/make_texture.h"
#include "tests/core/textures/gradients.h"
#include "tests/support/random.h"

namespace hyades::core {
namespace {

Mat4 some_transform() {
  Mat4 m(1.0F);
  m[0] = Vec4(0.8F, 0.3F, -0.1F, 0.0F);
  m[1] = Vec4(-0.2F, 1.1F, 0.4F, 0.0F);
  m[2] = Vec4(0.3F, -0.5F, 0.9F, 0.0F);
  m[3] = Vec4(0.2F, -0.4F, 0.6F, 1.0F);
  return m;
}

/// A place on an object that is turned, sheared and moved, whose uv go over its surface askew.
struct Surface {
  explicit Surface(test::Random& random) {
    point.ng = random.direction();
    point.ns = point.ng;
    const Vec3 other = random.direction();
    point.dpdu = 1.7F * glm::cross(point.ng, other);
    point.dpdv = 0.6F * glm::cross(point.ng, point.dpdu) + 0.4F * point.dpdu;
    point.world_to_object = some_transform();
    point.position = 3.0F * random.direction();
    point.uv = random.uniform2();
  }

  TexturePoint at(const Vec2& duv) const {
    const Vec3 world = point.position + duv.x * point.dpdu + duv.y * point.dpdv;
    return {point.uv + duv, transform_point(point.world_to_object, world), world, &point};
  }

  SurfacePoint point;
};

std::vector<MappingDesc> mappings() {
  std::vector<MappingDesc> all;
  for (const MappingSpace space : {MappingSpace::uv, MappingSpace::object, MappingSpace::world}) {
    for (const Projection projection :
         {Projection::none, Projection::planar, Projection::spherical, Projection::cylindrical}) {
      if (space == MappingSpace::uv && projection != Projection::none) continue;
      MappingDesc desc{space, projection, {2.0F, -1.5F, 0.7F}, {0.3F, 0.1F, 0.2F}, Mat4(1.0F)};
      all.push_back(desc);
      desc.transform = some_transform();
      all.push_back(desc);
    }
  }
  return all;
}

// What a step along the surface changes: coordinates there less those here.
TEST(Mapping, StepsAreDifferences) {
  test::Random random(31);
  for (const MappingDesc& desc : mappings()) {
    int near = 0;
    for (int i = 0; i < 200; ++i) {
      const Surface surface(random);
      const float h = 0x1p-9F;
      const Vec2 way(random.uniform(-1, 1), random.uniform(-1, 1));
      const Vec3 along = way.x * surface.point.dpdu + way.y * surface.point.dpdv;
      const Vec3 step = MappedPoint(desc, surface.at(Vec2(0.0F))).step(along, surface.point);
      const Vec3 difference = (MappedPoint(desc, surface.at(h * way)).coordinate() -
                               MappedPoint(desc, surface.at(-h * way)).coordinate()) /
                              (2.0F * h);
      near += glm::length(step - difference) < 0.02F * (1.0F + glm::length(step)) ? 1 : 0;
    }
    EXPECT_GE(near, 190) << static_cast<int>(desc.space) << static_cast<int>(desc.projection);
  }
}

TEST(Mapping, GradientsGoThroughIt) {
  test::Random random(32);
  for (const MappingDesc& desc : mappings()) {
    const auto texture =
        make_pattern_texture(make_constant_texture(Rgb(0.0F)), make_constant_texture(Rgb(1.0F)),
                             make_fractal_pattern(FractalKind::fbm, {.time = std::nullopt}), desc);
    for (int i = 0; i < 20; ++i) {
      const Surface surface(random);
      TexturePoint at = surface.at(Vec2(0.0F));
      const Vec3 place = transform_point(desc.transform,
                                         desc.space == MappingSpace::object ? at.object : at.world);
      // Around the axis differences see curves, not slopes.
      if (desc.projection != Projection::none && place.x * place.x + place.z * place.z < 0.3F)
        continue;
      if (desc.projection != Projection::none && std::abs(place.z) < 0.02F) continue;  // the seam
      expect_gradient(*texture, at, 0.03F);
    }
  }
}

// A spherical mapping gives a sphere the coordinates that it has by itself (core/geometry/shape.h),
// and a cylindrical one a cylinder's turn.
TEST(Mapping, SpheresAndCylindersAreTheShapesOwn) {
  test::Random random(33);
  for (int i = 0; i < 200; ++i) {
    const Vec2 uv = random.uniform2();
    const float rho = std::sin(kPi * uv.y);
    const Vec3 p(rho * std::cos(2 * kPi * uv.x), -std::cos(kPi * uv.y),
                 -rho * std::sin(2 * kPi * uv.x));
    MappingDesc desc;
    desc.projection = Projection::spherical;
    const Vec3 mapped = MappedPoint(desc, {.object = 5.0F * p}).coordinate();
    EXPECT_NEAR(mapped.x, uv.x, 1e-4F);
    EXPECT_NEAR(mapped.y, uv.y, 1e-5F);
    EXPECT_EQ(mapped.z, 0.0F);
    desc.projection = Projection::cylindrical;
    const Vec3 around = MappedPoint(desc, {.object = {2.0F * p.x, 7.0F, 2.0F * p.z}}).coordinate();
    EXPECT_NEAR(around.x, uv.x, 1e-4F);
    EXPECT_EQ(around.y, 7.0F);
  }
}

/// The two texture coordinates as a colour.
TexturePtr coordinates(const MappingDesc& mapping) {
  const TexturePtr black = make_constant_texture(Rgb(0.0F));
  MappingDesc turned = mapping;
  Mat4 swap(0.0F);
  swap[0].y = swap[1].x = swap[2].z = swap[3].w = 1.0F;
  turned.transform = swap * mapping.transform;
  return make_sum_texture(
      make_pattern_texture(black, make_constant_texture({1.0F, 0.0F, 0.0F}),
                           make_gradient_pattern(GradientShape::linear), mapping),
      make_pattern_texture(black, make_constant_texture({0.0F, 1.0F, 0.0F}),
                           make_gradient_pattern(GradientShape::linear), turned));
}

TEST(Triplanar, SidesSeeTheirOwnPlaneUpright) {
  std::array<TexturePtr, 3> planes;
  for (int axis = 0; axis < 3; ++axis) {
    MappingDesc desc;
    desc.projection = Projection::planar;
    desc.transform = plane_across(axis);
    planes[static_cast<size_t>(axis)] = coordinates(desc);
  }
  const auto texture = make_triplanar_texture(planes, {}, 0.5F);
  SurfacePoint surface;
  const auto seen = [&](const Vec3& normal) {
    surface.ns = normal;
    return texture->color({.object = {0.2F, 0.5F, -0.7F}, .surface = &surface});
  };
  EXPECT_EQ(seen({0, 0, 1}), Rgb(0.2F, 0.5F, 0.0F));
  EXPECT_EQ(seen({0, 0, -1}), Rgb(0.2F, 0.5F, 0.0F));
  EXPECT_EQ(seen({1, 0, 0}), Rgb(0.7F, 0.5F, 0.0F)) << "from +x, -z lies to the right";
  EXPECT_EQ(seen({0, 1, 0}), Rgb(0.2F, 0.7F, 0.0F)) << "from above, -z is up";
  const Rgb corner = seen(glm::normalize(Vec3(1.0F)));
  EXPECT_NEAR(corner.x, (0.2F + 0.7F + 0.2F) / 3.0F, 1e-5F);
  EXPECT_NEAR(corner.y, (0.5F + 0.5F + 0.7F) / 3.0F, 1e-5F);
  // The object is stretched along y: its slanted side faces more to y than the world's normal says.
  surface.world_to_object[1].y = 0.25F;
  const Rgb stretched = seen(glm::normalize(Vec3(0.0F, 1.0F, 1.0F)));
  EXPECT_EQ(stretched.y, 0.7F);
}

TEST(Triplanar, GradientsAreThoseOfWhatIsMixed) {
  std::array<TexturePtr, 3> planes;
  for (int axis = 0; axis < 3; ++axis) {
    planes[static_cast<size_t>(axis)] =
        make_pattern_texture(make_constant_texture(Rgb(0.0F)), make_constant_texture(Rgb(1.0F)),
                             make_fractal_pattern(FractalKind::fbm, {.time = std::nullopt}),
                             {.projection = Projection::planar, .transform = plane_across(axis)});
  }
  const auto texture = make_triplanar_texture(planes, {}, 1.0F);
  test::Random random(34);
  for (int i = 0; i < 50; ++i) {
    const Surface surface(random);
    expect_gradient(*texture, surface.at(Vec2(0.0F)), 0.02F);
  }
}

}  // namespace
}  // namespace hyades::core
