#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/job/parse.h"
#include "core/job/scene_document.h"
#include "test_assets.h"

namespace hyades::core {
namespace {

using testing::HasSubstr;

struct ReadObjects {
  Job job;
  std::string complaints;
};

ReadObjects read_objects(const std::string& text, AssetResolver& assets) {
  Diagnostics diagnostics;
  ReadObjects reading;
  reading.job = parse_job("hyades: 1\n" + text, "job.yaml", assets, diagnostics);
  reading.complaints = diagnostics.to_string();
  return reading;
}

/// A scene with a material, a picture beside it, and a light, as an importer would tell it.
std::string robot(const std::string& prefix) {
  return "materials: {" + prefix +
         "Skin: {type: lambert, color: {type: image, file: ../skin.png}}}\n" + "objects: {" +
         prefix + "body: {mesh: meshes/body.ply, material: " + prefix + "Skin}}\n" + "lights: {" +
         prefix + "eye: {type: point, at: [0, 2, 0]}}\n" +
         "camera: {fov: 12}\nframes: {range: 1-48}\n";
}

MemoryAssets with_robot() {
  MemoryAssets assets;
  assets.add("in/skin.png", "picture");
  assets.add("in/robot.glb.files/meshes/body.ply", "mesh");
  assets.add("in/robot.glb.files/scene,prefix=a,fps=30.yaml", robot("a."));
  assets.add("in/robot.glb.files/scene,prefix=g.b,fps=30,animation=Slow%20walk.yaml",
             robot("g.b."));
  assets.add("in/robot.glb.files/scene,fps=30.yaml", robot(""));
  return assets;
}

TEST(SceneDocument, ItsReferenceSaysWhatIsWanted) {
  const SceneDocument all{"x/robot.glb", "crowd.a b", 29.97F, "Walk, 100 %", true};
  const auto back = document_of(reference_of(all));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->scene, all.scene);
  EXPECT_EQ(back->prefix, all.prefix);
  EXPECT_EQ(back->fps, all.fps);
  EXPECT_EQ(back->animation, all.animation);
  EXPECT_TRUE(back->loop);
  EXPECT_FALSE(document_of(reference_of({"a.glb", "", 24.0F, "Walk"}))->loop);
  for (const char* other :
       {"robot.glb", "robot.glb.files/meshes/a.ply", "robot.glb.files/scene,fps=x.yaml",
        "robot.glb.files/scene,fps=-1.yaml", "robot.glb.files/scene,who=me.yaml",
        "robot.glb.files/scene,loop=1.yaml", "robot.glb.files/scene,prefix=%2.yaml", "scene.yaml",
        "robot.files.yaml"}) {
    EXPECT_FALSE(document_of(other)) << other;
  }
}

TEST(SceneObjects, AreGroupsOfWhatTheSceneHas) {
  MemoryAssets assets = with_robot();
  const ReadObjects r = read_objects(
      "frames: {range: 1-2, fps: 30}\n"
      "objects: {a: {gltf: in/robot.glb, at: [1, 0, 0], override: {Skin: {roughness: 0.7}}}}\n",
      assets);
  ASSERT_EQ(r.complaints, "");
  ASSERT_EQ(r.job.objects.size(), 1U);
  const ObjectDesc& group = r.job.objects[0];
  EXPECT_EQ(group.shape, "group");
  ASSERT_EQ(group.children.size(), 1U);
  EXPECT_EQ(group.children[0].name, "a.body");
  EXPECT_EQ(group.children[0].mesh, "in/robot.glb.files/meshes/body.ply");
  // The material as it is, and as it is overridden: 'Skin' means the scene's.
  ASSERT_EQ(r.job.materials.size(), 2U);
  ASSERT_EQ(group.overrides.size(), 1U);
  EXPECT_EQ(group.overrides[0].first, "a.Skin");
  ASSERT_FALSE(r.job.textures.empty());
  EXPECT_EQ(std::get<textures::Image>(r.job.textures[0].kind).file, "in/skin.png");
  EXPECT_NE(r.job.camera.fov.at({}), 12.0F) << "the camera is the job's";
  EXPECT_EQ(r.job.frames.last, 2);
}

TEST(SceneObjects, TheirLightsMoveWithTheObjectsAroundThem) {
  MemoryAssets assets = with_robot();
  const ReadObjects r = read_objects(
      "frames: {fps: 30}\n"
      "objects: {g: {at: [0, 0, 5], transform: [{scale: 2}], group: {objects: {\n"
      "  b: {gltf: in/robot.glb, animation: Slow walk, transform: [{rotate_x: 90}]}}}}}\n",
      assets);
  ASSERT_EQ(r.complaints, "");
  ASSERT_EQ(r.job.lights.size(), 1U);
  EXPECT_EQ(r.job.lights[0].name, "g.b.eye");
  using Kind = TransformStep::Kind;
  std::vector<Kind> kinds;
  for (const TransformStep& step : r.job.lights[0].transform) kinds.push_back(step.kind);
  EXPECT_EQ(kinds, (std::vector<Kind>{Kind::rotate_x, Kind::scale, Kind::translate}));
}

TEST(SceneObjects, AWholeSceneIsIncluded) {
  MemoryAssets assets = with_robot();
  const ReadObjects r = read_objects("include: in/robot.glb\nframes: {fps: 30}\n", assets);
  ASSERT_EQ(r.complaints, "");
  EXPECT_EQ(r.job.camera.fov.at({}), 12.0F);
  EXPECT_EQ(r.job.frames.last, 48);
  EXPECT_EQ(r.job.lights.size(), 1U);
}

TEST(SceneObjects, InGroupsThatAreInstanced) {
  MemoryAssets assets = with_robot();
  assets.add("in/robot.glb.files/scene,prefix=crowd.a,fps=24.yaml", robot("crowd.a."));
  const ReadObjects r = read_objects(
      "groups: {crowd: {objects: {a: {gltf: in/robot.glb}}}}\n"
      "objects: {x: {instance: crowd}, y: {instance: crowd, at: [1, 0, 0]}}\n",
      assets);
  ASSERT_EQ(r.complaints, "");
  EXPECT_EQ(r.job.groups.at(0).objects.at(0).children.at(0).name, "crowd.a.body");
  EXPECT_TRUE(r.job.lights.empty());
}

TEST(SceneObjects, ComplaintsNameTheKeyAndTheScene) {
  MemoryAssets assets = with_robot();
  const auto complaints = [&](const std::string& text) {
    return read_objects(text, assets).complaints;
  };
  EXPECT_EQ(complaints("objects: {a: {gltf: in/gone.glb}}\n"),
            "job.yaml:2:21: gltf: in/gone.glb.files/scene,prefix=a,fps=24.yaml: no such file\n");
  EXPECT_EQ(complaints("objects: {a: {gltf: in/robot.obj}}\n"),
            "job.yaml:2:21: gltf is 'in/robot.obj', expected a file whose name ends in .glb\n");
  EXPECT_EQ(complaints("objects: {a: {gltf: in/robot.glb, shape: box}}\n"),
            "job.yaml:2:35: the object has both 'gltf' and 'shape', expected one of them\n");
  EXPECT_EQ(complaints("frames: {fps: 30}\nobjects: {a: {gltf: in/robot.glb, radius: 3}}\n"),
            "job.yaml:3:35: unknown key 'radius' in object 'a'; it belongs to cylinder, disk or "
            "sphere\n");
  EXPECT_THAT(complaints("objects: {a: {gltf: in/robot.glb, animation: [1]}}\n"),
              HasSubstr("animation is a list of 1, expected the name of an animation"));
  EXPECT_EQ(complaints("objects: {a: {gltf: in/robot.glb, loop: often}}\n"),
            "job.yaml:2:41: loop is 'often', expected true or false\n");
  EXPECT_EQ(complaints("objects: {a: {obj: in/chair.obj, loop: true}}\n"),
            "job.yaml:2:34: loop is for scenes of glTF, but this is obj: in/chair.obj\n");
  assets.add("in/robot.glb.files/scene,prefix=g.b,fps=24.yaml", robot("g.b."));
  EXPECT_EQ(complaints("groups: {g: {objects: {b: {gltf: in/robot.glb}}}}\n"
                       "objects: {g: {group: {objects: {b: {gltf: in/robot.glb}}}}}\n"),
            "job.yaml:3:43: gltf: another object brings this scene under the name 'g.b' too, "
            "expected names that differ\n");
  assets.add("in/bad.glb.files/scene,prefix=a,fps=24.yaml", "objects: {a.x: {shape: bawl}}\n");
  EXPECT_THAT(complaints("objects: {a: {gltf: in/bad.glb}}\n"), HasSubstr("in/bad.glb: shape"))
      << "lines of what importers make are nobody's business";
}

}  // namespace
}  // namespace hyades::core
