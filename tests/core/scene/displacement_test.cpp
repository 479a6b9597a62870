#include "core/scene/displacement.h"

#include <gtest/gtest.h>

#include <string>

#include "core/geometry/closed_mesh.h"
#include "core/job/parse.h"
#include "core/scene/build_scene.h"
#include "core/scene/flatten.h"
#include "tests/core/job/test_assets.h"

namespace hyades::core {
namespace {

/// 2 x 2 around the origin, facing up, without and with uv (u along x, 0..1).
constexpr const char* kPlain =
    "v -1 0 1\nv 1 0 1\nv 1 0 -1\nv -1 0 -1\n"
    "f 1 2 3 4\n";
constexpr const char* kMapped =
    "v -1 0 1\nv 1 0 1\nv 1 0 -1\nv -1 0 -1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
    "f 1/1 2/2 3/3 4/4\n";
constexpr const char* kTetrahedron =
    "v 1 1 1\nv 1 -1 -1\nv -1 1 -1\nv -1 -1 1\nf 1 2 3\nf 1 3 4\nf 1 4 2\nf 2 4 3\n";

constexpr const char* kTextures = R"yaml(
materials: {rock: {type: lambert}}
textures:
  slope: {type: gradient}
  bumps: {type: fbm3d, scale: 3, octaves: 2}
  world: {type: fbm3d, scale: 3, octaves: 2, mapping: {type: world}}
  churn: {type: fbm4d, scale: 3, octaves: 2, time: "= t"}
)yaml";

class DisplacedObjects : public testing::Test {
 protected:
  DisplacedObjects() : cache_(assets_) {
    assets_.add("plain.obj", kPlain);
    assets_.add("plane.obj", kMapped);
    assets_.add("solid.obj", kTetrahedron);
  }

  /// Reads a job of these objects.
  const Job& read(const std::string& objects) {
    Diagnostics diagnostics;
    job_ = parse_job("hyades: 1\nframes: 1-10\n" + std::string(kTextures) + objects, "d.yaml",
                     assets_, diagnostics);
    complaints_ = diagnostics.to_string();
    return job_;
  }

  std::shared_ptr<const Scene> scene_of(int32_t frame) {
    EXPECT_EQ(complaints_, "");
    auto scene = build_scene(job_, frame, cache_);
    error_ = scene ? "" : scene.error().message;
    return scene ? *scene : nullptr;
  }

  static std::shared_ptr<const TriangleMesh> mesh_of(const Scene& scene, uint32_t object) {
    return scene.world->placement(object).shape.mesh;
  }

  MemoryAssets assets_;
  SceneCache cache_;
  Job job_;
  std::string complaints_;
  std::string error_;
};

TEST_F(DisplacedObjects, MovesByHeightTimesTheTextureAboveItsMiddle) {
  read(
      "objects: {a: {mesh: plane.obj, displacement: {texture: slope, height: 0.5, midlevel: 0.25, "
      "max_edge: 0.2}}}\n");
  const auto scene = scene_of(1);
  ASSERT_NE(scene, nullptr) << error_;
  const auto mesh = mesh_of(*scene, 0);
  EXPECT_GT(mesh->triangles.size(), 200U);
  EXPECT_EQ(scene->triangles, mesh->triangles.size());
  for (size_t i = 0; i < mesh->positions.size(); ++i) {
    const Vec3& p = mesh->positions[i];
    EXPECT_NEAR(p.y, 0.5F * (0.5F * (p.x + 1.0F) - 0.25F), 1e-5F);
  }
}

TEST_F(DisplacedObjects, WithoutHeightAreTheMeshItself) {
  read(
      "objects:\n"
      "  a: {mesh: plane.obj}\n"
      "  b: {mesh: plane.obj, displacement: {texture: slope, height: 0, budget: 1}}\n");
  const auto scene = scene_of(1);
  ASSERT_NE(scene, nullptr) << error_;
  EXPECT_EQ(mesh_of(*scene, 0), mesh_of(*scene, 1));
}

TEST_F(DisplacedObjects, AreSharedByEqualObjectsAndByInstancesOfAnyLook) {
  const std::string how = "displacement: {texture: bumps, height: 0.2, max_edge: 0.2}";
  read("groups: {g: {objects: {x: {mesh: plain.obj, material: rock, " + how +
       "}}}}\n"
       "objects:\n"
       "  a: {mesh: plain.obj, " +
       how +
       "}\n"
       "  b: {mesh: plain.obj, at: [3, 0, 0], " +
       how +
       "}\n"
       "  c: {instance: g, at: [6, 0, 0], override: {rock: {color: 0.9}}}\n"
       "  d: {mesh: plain.obj, displacement: {texture: bumps, height: 0.3, max_edge: 0.2}}\n");
  const auto scene = scene_of(1);
  ASSERT_NE(scene, nullptr) << error_;
  EXPECT_EQ(mesh_of(*scene, 0), mesh_of(*scene, 1));
  EXPECT_EQ(mesh_of(*scene, 0), mesh_of(*scene, 2));
  EXPECT_NE(mesh_of(*scene, 0), mesh_of(*scene, 3));
}

TEST_F(DisplacedObjects, ByTheWorldDependOnThePlace) {
  const std::string how = "displacement: {texture: world, height: 0.2, max_edge: 0.2}";
  read(
      "objects:\n"
      "  a: {mesh: plain.obj, " +
      how +
      "}\n"
      "  b: {mesh: plain.obj, at: [3.3, 0, 0], " +
      how +
      "}\n"
      "  c: {mesh: plain.obj, " +
      how + "}\n");
  const auto scene = scene_of(1);
  ASSERT_NE(scene, nullptr) << error_;
  EXPECT_NE(mesh_of(*scene, 0)->positions, mesh_of(*scene, 1)->positions);
  EXPECT_EQ(mesh_of(*scene, 0), mesh_of(*scene, 2));
}

TEST_F(DisplacedObjects, AreKeptFromFrameToFrameWhileNothingChanges) {
  read(
      "objects:\n"
      "  still: {mesh: plain.obj, displacement: {texture: bumps, max_edge: 0.2}}\n"
      "  grows: {mesh: plain.obj, displacement: {texture: bumps, height: \"= t\", max_edge: 0.2}}\n"
      "  boils: {mesh: plain.obj, displacement: {texture: churn, max_edge: 0.2}}\n");
  EXPECT_FALSE(displacement_changes(job_, job_.objects[0]));
  EXPECT_TRUE(displacement_changes(job_, job_.objects[1]));
  EXPECT_TRUE(displacement_changes(job_, job_.objects[2]));
  auto second = scene_of(2);
  ASSERT_NE(second, nullptr) << error_;
  const auto kept = mesh_of(*second, 0);
  const std::weak_ptr<const TriangleMesh> gone = mesh_of(*second, 1);
  const std::vector<Vec3> boiled = mesh_of(*second, 2)->positions;
  second.reset();
  const auto third = scene_of(3);
  ASSERT_NE(third, nullptr) << error_;
  EXPECT_EQ(mesh_of(*third, 0), kept);
  EXPECT_TRUE(gone.expired()) << "old heights must not pile up";
  EXPECT_NE(mesh_of(*third, 2)->positions, boiled);
  SceneCache fresh(assets_);
  const auto again = build_scene(job_, 3, fresh);
  ASSERT_TRUE(again);
  for (uint32_t i = 0; i < 3; ++i)
    EXPECT_EQ(mesh_of(**again, i)->positions, mesh_of(*third, i)->positions);
}

TEST_F(DisplacedObjects, OfClosedMeshesStayClosed) {
  read(
      "objects: {a: {mesh: solid.obj, displacement: {texture: bumps, height: 0.3, max_edge: "
      "0.05}}}\n");
  const auto scene = scene_of(1);
  ASSERT_NE(scene, nullptr) << error_;
  EXPECT_EQ(cache_.closure(mesh_of(*scene, 0)).open_edges, 0U);
}

TEST_F(DisplacedObjects, MoveOverTheFilmAsTheirPlacesDo) {
  read(
      "outputs: [{file: a.####.exr, layers: [motion]}]\n"
      "objects: {a: {mesh: plain.obj, at: [\"= t\", 0, 0], displacement: {texture: bumps, height: "
      "\"= t\", max_edge: 0.2}}}\n");
  const auto scene = scene_of(3);
  ASSERT_NE(scene, nullptr) << error_;
  EXPECT_GT(mesh_of(*scene, 0)->triangles.size(), 200U);
  ASSERT_EQ(scene->motion->to_world.size(), 1U);
  EXPECT_FLOAT_EQ(scene->motion->to_world[0][3].x, 3.0F / 24.0F);
}

TEST_F(DisplacedObjects, OverTheirBudgetAreRefused) {
  read(
      "objects: {rock: {mesh: plain.obj, displacement: {texture: bumps, max_edge: 0.001, budget: "
      "1000}}}\n");
  EXPECT_EQ(scene_of(1), nullptr);
  EXPECT_EQ(error_.find("d.yaml:10:"), 0U) << error_;
  EXPECT_NE(error_.find("object 'rock': displacement: it would have about "), std::string::npos)
      << error_;
  EXPECT_NE(error_.find(" triangles, more than its budget of 1000"), std::string::npos) << error_;
}

TEST_F(DisplacedObjects, ByUvNeedUv) {
  read("objects: {rock: {mesh: plain.obj, displacement: {texture: slope}}}\n");
  EXPECT_EQ(scene_of(1), nullptr);
  EXPECT_NE(error_.find("mapped by uv, of which the mesh 'plain.obj' has none"), std::string::npos)
      << error_;
}

TEST_F(DisplacedObjects, OfWhatCannotBeDisplacedAreRefused) {
  const auto complaint = [&](const std::string& object) {
    read("objects: {a: {" + object + "}}\n");
    return complaints_;
  };
  const std::string bumps = "displacement: {texture: bumps}";
  EXPECT_NE(complaint("shape: sphere, " + bumps)
                .find("object 'a' is a sphere, but displacement moves the triangles of a mesh"),
            std::string::npos)
      << complaints_;
  EXPECT_NE(complaint("group: {objects: {b: {shape: box}}}, " + bumps).find("is a group, but"),
            std::string::npos)
      << complaints_;
  EXPECT_NE(complaint("mesh: plain.obj, displacement: {texture: bump}").find("bump"),
            std::string::npos)
      << complaints_;
  EXPECT_NE(complaint("mesh: plain.obj, displacement: {height: 1}").find("texture"),
            std::string::npos)
      << complaints_;
  EXPECT_NE(complaint("mesh: plain.obj, displacement: {texture: bumps, max_edge: 0}")
                .find("max_edge is '0', expected a number above 0"),
            std::string::npos)
      << complaints_;
}

}  // namespace
}  // namespace hyades::core
