#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

#include "core/geometry/build_thresholds.h"
#include "core/geometry/world.h"
#include "tests/support/random.h"
#include "tests/support/tested_class.h"

/// What the tests of this room share: matrices, meshes and worlds.
namespace hyades::test {

/// Uniform in a box.
inline core::Vec3 in_box(Random& random, const core::Vec3& low, const core::Vec3& high) {
  const float x = random.uniform(low.x, high.x);
  const float y = random.uniform(low.y, high.y);
  return {x, y, random.uniform(low.z, high.z)};
}

inline size_t pick(Random& random, size_t count) {
  return static_cast<size_t>(random.bits() % count);
}

inline core::Mat4 translation(const core::Vec3& by) {
  core::Mat4 m(1.0F);
  m[3] = core::Vec4(by, 1.0F);
  return m;
}

inline core::Mat4 scaling(const core::Vec3& by) {
  core::Mat4 m(1.0F);
  for (int i = 0; i < 3; ++i) m[i][i] = by[i];
  return m;
}

/// Some rotation: columns are an orthonormal basis.
inline core::Mat4 random_rotation(Random& random) {
  const core::Vec3 x = random.direction();
  const core::Vec3 y = glm::normalize(glm::cross(x, random.direction()));
  return {core::Vec4(x, 0.0F), core::Vec4(y, 0.0F), core::Vec4(glm::cross(x, y), 0.0F),
          core::Vec4(0.0F, 0.0F, 0.0F, 1.0F)};
}

/// An octahedron refined `levels` times, its corners on the sphere of radius 1.
inline std::shared_ptr<core::TriangleMesh> make_ball(int levels) {
  using core::Vec3;
  auto mesh = std::make_shared<core::TriangleMesh>();
  mesh->name = "ball";
  // Every face is split on its own: equal midpoints have equal bits, so the surface is closed.
  std::vector<std::array<Vec3, 3>> faces;
  for (const float x : {1.0F, -1.0F}) {
    for (const float y : {1.0F, -1.0F}) {
      for (const float z : {1.0F, -1.0F}) {
        const std::array<Vec3, 3> f{Vec3(x, 0, 0), Vec3(0, y, 0), Vec3(0, 0, z)};
        faces.push_back(x * y * z > 0.0F ? f : std::array<Vec3, 3>{f[0], f[2], f[1]});
      }
    }
  }
  const auto middle = [](const Vec3& a, const Vec3& b) {
    const glm::dvec3 m = glm::dvec3(a) + glm::dvec3(b);
    return Vec3(m / std::sqrt(glm::dot(m, m)));
  };
  for (int i = 0; i < levels; ++i) {
    std::vector<std::array<Vec3, 3>> finer;
    for (const auto& f : faces) {
      const Vec3 ab = middle(f[0], f[1]);
      const Vec3 bc = middle(f[1], f[2]);
      const Vec3 ca = middle(f[2], f[0]);
      finer.insert(finer.end(), {{f[0], ab, ca}, {ab, f[1], bc}, {ca, bc, f[2]}, {ab, bc, ca}});
    }
    faces = std::move(finer);
  }
  for (const auto& f : faces) {
    const auto first = static_cast<uint32_t>(mesh->positions.size());
    mesh->positions.insert(mesh->positions.end(), f.begin(), f.end());
    mesh->triangles.push_back({first, first + 1, first + 2});
  }
  core::finish_mesh(*mesh);
  return mesh;
}

inline core::Placement place(std::shared_ptr<const core::TriangleMesh> mesh,
                             std::vector<core::Mat4> to_world = {core::Mat4(1.0F)}) {
  core::Placement p;
  p.shape.mesh = std::move(mesh);
  p.to_world = std::move(to_world);
  return p;
}

inline core::Placement place(core::Shape::Kind kind, float radius, float height,
                             std::vector<core::Mat4> to_world = {core::Mat4(1.0F)}) {
  core::Placement p;
  p.shape.kind = kind;
  p.shape.radius = radius;
  p.shape.height = height;
  p.to_world = std::move(to_world);
  return p;
}

/// Instances every mesh that repeats or changes, and shares all that stands still.
inline constexpr core::BuildThresholds kInstanceAll{0, 0};

inline std::shared_ptr<const core::World> build(std::vector<core::Placement> placements,
                                                const core::BuildThresholds& thresholds = {}) {
  core::GeometryCache cache;
  auto world = core::build_world(std::move(placements), cache, tested_class(), thresholds);
  EXPECT_TRUE(world.ok()) << (world.ok() ? "" : world.error().message);
  return world.ok() ? *world : nullptr;
}

}  // namespace hyades::test
