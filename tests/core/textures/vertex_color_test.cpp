#include <gtest/gtest.h>

#include "core/geometry/mesh.h"
#include "core/textures/make_texture.h"
#include "core/textures/mapping.h"

namespace hyades::core {
namespace {

/// A triangle with colours and second coordinates, and a point in it.
struct Triangle {
  Triangle() {
    mesh.positions = {{0, 0, 0}, {2, 0, 0}, {0, 1, 1}};
    mesh.triangles = {{0, 1, 2}};
    mesh.colors = {{1, 0, 0, 0.2F}, {0, 1, 0, 0.6F}, {0, 0, 1, 1}};
    mesh.second_uvs = {{0, 0}, {1, 0.5F}, {0.25F, 2}};
    point.mesh = &mesh;
    point.world_to_object = Mat4(1.0F);
    point.world_to_object[0].x = 4.0F;  // the object is a quarter as long in the world
    move(0.3F, 0.5F);
  }

  void move(float u, float v) {
    point.barycentrics = {u, v};
    const Vec3 object = mesh.positions[1] * u + mesh.positions[2] * v;
    point.position = object * Vec3(0.25F, 1.0F, 1.0F);
  }

  TexturePoint at() const {
    return {Vec2(0.0F), transform_point(point.world_to_object, point.position), point.position,
            &point};
  }

  TriangleMesh mesh;
  SurfacePoint point;
};

TEST(VertexColor, IsInterpolated) {
  const Triangle triangle;
  const TexturePtr texture = make_vertex_color_texture();
  const Rgb color = texture->color(triangle.at());
  EXPECT_NEAR(color.x, 0.2F, 1e-6F);
  EXPECT_NEAR(color.y, 0.3F, 1e-6F);
  EXPECT_NEAR(color.z, 0.5F, 1e-6F);
  EXPECT_NEAR(texture->alpha(triangle.at()), 0.2F * 0.2F + 0.3F * 0.6F + 0.5F, 1e-6F);
}

TEST(VertexColor, IsWhiteWhereThereIsNone) {
  const TexturePtr texture = make_vertex_color_texture();
  EXPECT_EQ(texture->color(TexturePoint()), Rgb(1.0F));
  EXPECT_EQ(texture->alpha(TexturePoint()), 1.0F);
  Triangle triangle;
  triangle.mesh.colors.clear();
  EXPECT_EQ(texture->color(triangle.at()), Rgb(1.0F));
}

TEST(VertexColor, GradientsLeadAlongTheTriangle) {
  Triangle triangle;
  const TexturePtr texture = make_vertex_color_texture();
  const Vec4 weights(0.3F, -1.0F, 2.0F, 0.7F);
  const auto here = texture->gradient(triangle.at(), weights);
  const Vec3 from = triangle.at().object;
  for (const Vec2 step : {Vec2(0.1F, 0.0F), Vec2(0.0F, 0.1F), Vec2(-0.1F, 0.2F)}) {
    triangle.move(0.3F + step.x, 0.5F + step.y);
    const auto there = texture->gradient(triangle.at(), weights);
    EXPECT_NEAR(there.value - here.value, glm::dot(here.d_object, triangle.at().object - from),
                1e-5F);
  }
}

TEST(Mapping, TheSecondCoordinatesAreTheMeshsOwn) {
  Triangle triangle;
  MappingDesc desc;
  desc.space = MappingSpace::second_uv;
  desc.scale = Vec3(2.0F, 3.0F, 1.0F);
  desc.offset = Vec3(0.1F, 0.0F, 0.0F);
  EXPECT_TRUE(desc.flat());
  const TexturePoint here = triangle.at();
  const MappedPoint first(desc, here);
  EXPECT_NEAR(first.coordinate().x, 2.0F * (0.3F + 0.5F * 0.25F) + 0.1F, 1e-6F);
  EXPECT_NEAR(first.coordinate().y, 3.0F * (0.3F * 0.5F + 1.0F), 1e-6F);
  const Vec3 world = here.world;
  const Vec3 object = here.object;
  const Vec3 derivative(0.7F, -0.4F, 0.0F);
  ScalarGradient gradient;
  first.add_gradient(derivative, gradient);
  for (const Vec2 step : {Vec2(0.1F, 0.0F), Vec2(0.0F, 0.1F), Vec2(-0.1F, 0.2F)}) {
    Triangle moved;
    moved.move(0.3F + step.x, 0.5F + step.y);
    const TexturePoint there = moved.at();
    const Vec3 change = MappedPoint(desc, there).coordinate() - first.coordinate();
    const Vec3 told = first.step(there.world - world, triangle.point);
    EXPECT_LT(glm::length(change - told), 1e-5F);
    EXPECT_NEAR(glm::dot(gradient.d_object, there.object - object), glm::dot(derivative, change),
                1e-5F);
  }
}

}  // namespace
}  // namespace hyades::core
