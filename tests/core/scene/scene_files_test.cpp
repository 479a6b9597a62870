#include "core/scene/scene_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <string>
#include <thread>

#include "core/base/parallel.h"
#include "core/job/parse.h"
#include "core/scene/build_scene.h"
#include "tests/core/job/test_assets.h"

namespace hyades::core {
namespace {

using testing::ElementsAre;
using testing::Pair;

constexpr std::chrono::seconds kLong{20};
constexpr const char* kObjTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

MATCHER_P2(Asked, file, how, "") { return arg.file == file && arg.how == how; }

/// Counts who opens what; `meet` files wait in open() until all of them are being opened.
class WatchedAssets : public MemoryAssets {
 public:
  explicit WatchedAssets(size_t meet = 0) : meet_(meet) {}

  Result<Bytes> open(const std::string& reference, const std::string& from = {}) override {
    {
      std::unique_lock lock(mutex_);
      ++opened_[reference];
      ++inside_;
      wake_.notify_all();
      if (!wake_.wait_for(lock, kLong, [&] { return inside_ >= meet_; })) alone_ = true;
    }
    return MemoryAssets::open(reference, from);
  }

  std::map<std::string, int> opened() const { return opened_; }
  bool somebody_was_alone() const { return alone_; }

 private:
  const size_t meet_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::map<std::string, int> opened_;
  size_t inside_ = 0;
  bool alone_ = false;
};

Job parsed(const std::string& text, AssetResolver& assets) {
  Diagnostics diagnostics;
  const Job job = parse_job("hyades: 1\n" + text, "files.yaml", assets, diagnostics);
  EXPECT_TRUE(diagnostics.empty()) << diagnostics.to_string();
  return job;
}

/// A job of `count` meshes, m0.obj, m1.obj, ...
Job job_of_meshes(int count) {
  Job job;
  for (int i = 0; i < count; ++i) {
    ObjectDesc object;
    object.name = "o" + std::to_string(i);
    object.shape = "mesh";
    object.mesh = "m" + std::to_string(i) + ".obj";
    job.objects.push_back(object);
  }
  return job;
}

TEST(SceneFiles, AreWhatTheSceneShows) {
  MemoryAssets assets;
  for (const char* file : {"a.obj", "b.obj", "unused.obj"}) assets.add(file, kObjTriangle);
  for (const char* file :
       {"bark.png", "leaf.png", "bump.png", "unused.png", "lamp.exr", "film.png", "sky.hdr"}) {
    assets.add(file, "never decoded here");
  }
  const Job job = parsed(R"yaml(
textures:
  bark: {type: image, file: bark.png, color_space: linear}
  leaf: {type: image, file: leaf.png}
  rough: {type: image, file: bump.png}
  both: {type: checker, a: leaf, b: bark}
  unused: {type: image, file: unused.png}
materials:
  wood: {type: lambert, color: both, bump: {texture: rough}}
  pane: {type: dielectric, roughness: unused}
  mixed: {type: mix, first: wood, second: wood}
groups:
  twig: {objects: {a: {mesh: a.obj}, b: {mesh: b.obj, normals: flat}}}
  tree: {objects: {t: {instance: twig}}}
  never: {objects: {a: {mesh: unused.obj}}}
objects:
  one: {instance: tree, material: mixed}
  two: {instance: tree, material: mixed}
  three: {mesh: a.obj}
lights:
  lamp: {type: point, image: lamp.exr}
  bulb: {type: point, image: lamp.exr}
  plain: {type: point}
  film: {type: projector, image: film.png}
environment: {image: sky.hdr}
)yaml",
                         assets);
  const SceneFiles files = files_of_scene(job);
  EXPECT_THAT(files.meshes,
              ElementsAre(Asked("a.obj", MeshNormals::file), Asked("b.obj", MeshNormals::flat)));
  EXPECT_THAT(files.images, ElementsAre(Asked("leaf.png", ImageUse{}),
                                        Asked("bark.png", ImageUse{ColorSpace::linear}),
                                        Asked("bump.png", ImageUse{})));
  EXPECT_THAT(files.light_maps,
              ElementsAre(Asked("lamp.exr", LightMap::luminance), Asked("film.png", LightMap::gobo),
                          Asked("sky.hdr", LightMap::excess)));
}

TEST(SceneFiles, AreWhatDisplacesMeshes) {
  MemoryAssets assets;
  for (const char* file : {"rock.obj", "flat.obj"}) assets.add(file, kObjTriangle);
  for (const char* file : {"cracks.png", "none.png"}) assets.add(file, "never decoded here");
  const Job job = parsed(R"yaml(
textures:
  cracks: {type: image, file: cracks.png, color_space: linear}
  deep: {type: invert, input: cracks}
  none: {type: image, file: none.png}
objects:
  rock: {mesh: rock.obj, normals: smooth, displacement: {texture: deep, height: "= t"}}
  flat: {mesh: flat.obj, displacement: {texture: none, height: 0}}
)yaml",
                         assets);
  const SceneFiles files = files_of_scene(job);
  EXPECT_THAT(files.meshes, ElementsAre(Asked("rock.obj", MeshNormals::file),
                                        Asked("flat.obj", MeshNormals::file)));
  EXPECT_THAT(files.images, ElementsAre(Asked("cracks.png", ImageUse{ColorSpace::linear})));
}

TEST(SceneFiles, LoadSeveralAtOnce) {
  if (hardware_threads() < 2) GTEST_SKIP() << "needs two processors";
  WatchedAssets assets(2);
  for (int i = 0; i < 8; ++i) assets.add("m" + std::to_string(i) + ".obj", kObjTriangle);
  const Job job = job_of_meshes(8);
  SceneCache cache(assets);
  ASSERT_TRUE(load_files(job, std::nullopt, cache));
  EXPECT_FALSE(assets.somebody_was_alone());
  const auto scene = build_scene(job, 1, cache);
  ASSERT_TRUE(scene);
  EXPECT_EQ((*scene)->triangles, 8U);
  for (const auto& [file, times] : assets.opened()) EXPECT_EQ(times, 1) << file;
  EXPECT_EQ(assets.opened().size(), 8U);
}

TEST(SceneFiles, ErrorsComeInTheOrderOfTheDocument) {
  MemoryAssets assets;
  const Job job = job_of_meshes(8);
  // The first bad one takes the longest to be found out.
  std::string late;
  for (int i = 0; i < 20'000; ++i) late += "v 0 0 0\n";
  for (int i = 0; i < 8; ++i) assets.add("m" + std::to_string(i) + ".obj", kObjTriangle);
  assets.add("m3.obj", late + "f 1 2 x\n");
  assets.add("m5.obj", "f 1 2 3\n");
  for (int again = 0; again < 2; ++again) {
    SceneCache cache(assets);
    const auto scene = build_scene(job, 1, cache);
    ASSERT_FALSE(scene);
    EXPECT_THAT(scene.error().message, testing::StartsWith("object 'o3': m3.obj"));
    EXPECT_THAT(scene.error().message, testing::HasSubstr("\nobject 'o5': m5.obj"));
  }
}

TEST(SceneFiles, EveryBrokenOneIsNamedWithItsPlaceInTheDocument) {
  MemoryAssets assets;
  assets.add("good.obj", kObjTriangle);
  assets.add("idx.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
  assets.add("nan.obj", "v 0 nan 0\n");
  assets.add("bark.png", "no picture");
  assets.add("sky.hdr", "no picture");
  // In the order of the document, though the sky and the picture are asked for last.
  const Job job = parsed(R"yaml(
environment: {image: sky.hdr}
textures: {bark: {type: image, file: bark.png}}
materials: {wood: {type: lambert, color: bark}}
objects:
  fine: {mesh: good.obj}
  a: {mesh: idx.obj, material: wood}
  again: {mesh: idx.obj}
  b: {mesh: nan.obj}
)yaml",
                         assets);
  SceneCache cache(assets);
  const auto scene = build_scene(job, 1, cache);
  ASSERT_FALSE(scene);
  const std::string said = scene.error().message + "\n";
  EXPECT_THAT(said,
              testing::MatchesRegex("files.yaml:3:[0-9]+: environment: sky.hdr: .*\n"
                                    "files.yaml:4:[0-9]+: texture 'bark': bark.png: .*\n"
                                    "files.yaml:8:[0-9]+: object 'a': idx.obj: line 4: .*\n"
                                    "files.yaml:10:[0-9]+: object 'b': nan.obj: line 1: .*\n"));
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 4) << said;
}

TEST(SceneErrors, NameTheObjectAndItsPlaceInTheDocument) {
  MemoryAssets assets;
  const Job job = parsed(R"yaml(
groups:
  pair:
    objects:
      near: {shape: sphere}
      far: {shape: rectangle, at: [3e12, 0, 0]}
objects:
  ground: {shape: rectangle}
  one: {instance: pair}
)yaml",
                         assets);
  SceneCache cache(assets);
  const auto scene = build_scene(job, 1, cache);
  ASSERT_FALSE(scene);
  EXPECT_THAT(scene.error().message,
              testing::MatchesRegex("files.yaml:7:[0-9]+: object 'one/far': it reaches beyond a "
                                    "distance of 1e12 m"));
}

TEST(SceneErrors, AllObjectsThatReachTooFarAreTold) {
  MemoryAssets assets;
  const Job job = parsed(R"yaml(
objects:
  a: {shape: sphere, at: [3e12, 0, 0]}
  b: {shape: sphere}
  c: {shape: sphere, radius: 1e13}
)yaml",
                         assets);
  SceneCache cache(assets);
  const auto scene = build_scene(job, 1, cache);
  ASSERT_FALSE(scene);
  EXPECT_THAT(scene.error().message, testing::MatchesRegex("files.yaml:4:.*object 'a': .*\n"
                                                           "files.yaml:6:.*object 'c': .*"));
}

TEST(SceneErrors, FocusOnAnObjectBehindTheCameraIsRefused) {
  MemoryAssets assets;
  const Job job = parsed(R"yaml(
frames: 1-3
camera: {look_from: [0, 0, 5], look_at: [0, 0, 0], focus: ball}
objects:
  ball: {shape: sphere, at: [0, 0, "= frame > 2.5 ? 7 : 0"]}
outputs: [{file: a.#.png}]
)yaml",
                         assets);
  SceneCache cache(assets);
  EXPECT_TRUE(build_scene(job, 1, cache));
  const auto scene = build_scene(job, 3, cache);
  ASSERT_FALSE(scene);
  EXPECT_EQ(scene.error().message,
            "files.yaml:4:59: focus is on the object 'ball', whose centre lies 2 m behind the "
            "camera at frame 3, expected one in front of it");
}

TEST(SceneFiles, OneThatIsBeingLoadedHoldsUpNoOther) {
  // The second and third file are opened while the first one is still being read.
  WatchedAssets assets(3);
  for (int i = 0; i < 3; ++i) assets.add("m" + std::to_string(i) + ".obj", kObjTriangle);
  SceneCache cache(assets);
  std::vector<std::thread> threads;
  for (int i = 0; i < 3; ++i) {
    threads.emplace_back([&cache, i] {
      EXPECT_TRUE(cache.mesh("m" + std::to_string(i) + ".obj", MeshNormals::file));
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_FALSE(assets.somebody_was_alone());
}

TEST(SceneFiles, WhoAsksForTheSameFileGetsTheSameMesh) {
  WatchedAssets assets;
  assets.add("m0.obj", kObjTriangle);
  SceneCache cache(assets);
  std::vector<std::shared_ptr<const TriangleMesh>> meshes(8);
  std::vector<std::thread> threads;
  for (auto& mesh : meshes) {
    threads.emplace_back([&cache, &mesh] { mesh = *cache.mesh("m0.obj", MeshNormals::file); });
  }
  for (std::thread& thread : threads) thread.join();
  for (const auto& mesh : meshes) EXPECT_EQ(mesh, meshes[0]);
  EXPECT_THAT(assets.opened(), ElementsAre(Pair("m0.obj", 1)));
}

TEST(SceneFiles, WhatCouldNotBeLoadedIsTriedAgain) {
  MemoryAssets assets;
  SceneCache cache(assets);
  EXPECT_FALSE(cache.mesh("m0.obj", MeshNormals::file));
  assets.add("m0.obj", kObjTriangle);
  EXPECT_TRUE(cache.mesh("m0.obj", MeshNormals::file));
}

TEST(SceneFiles, PartsOfAMeshAreReadFromOneFileOnce) {
  WatchedAssets assets;
  assets.add("two.obj", std::string(kObjTriangle) + "usemtl glass\nf 1 2 3\nf 3 2 1\n");
  const Job job = parsed(R"yaml(
objects:
  all: {mesh: two.obj}
  rest: {mesh: two.obj, part: default}
  pane: {mesh: two.obj, part: glass, normals: smooth}
)yaml",
                         assets);
  SceneCache cache(assets);
  const auto scene = build_scene(job, 1, cache);
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_EQ((*scene)->triangles, 6U);
  EXPECT_EQ((*cache.mesh("two.obj", {MeshNormals::file, "glass"}))->triangles.size(), 2U);
  EXPECT_LE(assets.opened()["two.obj"],
            3);  // by the check of the job, for all of it, for its parts
  const auto gone = cache.mesh("two.obj", {MeshNormals::file, "clay"});
  ASSERT_FALSE(gone);
  EXPECT_EQ(gone.error().message, "two.obj: it has no material 'clay'; there is default or glass");
}

}  // namespace
}  // namespace hyades::core
