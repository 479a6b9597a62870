#include "import/obj/read_obj_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "core/job/yaml_build.h"
#include "core/job/yaml_writer.h"
#include "tests/core/job/test_assets.h"

namespace hyades::core {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

SceneSections scene_of(MemoryAssets& files, const std::string& name) {
  const auto scene = read_obj_scene(files, name);
  EXPECT_TRUE(scene) << (scene ? "" : scene.error().message);
  if (!scene) return {YamlMap().node(), {}, {}};
  return *(*scene)->sections({});
}

TEST(ObjScene, ShowsTheColoursOfItsVertices) {
  MemoryAssets files;
  files.add("a.obj", "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nf 1 2 3\n");
  files.add("a.ply",
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
            "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
            "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
            "0 0 0 255 0 0\n1 0 0 0 255 0\n0 1 0 0 0 255\n3 0 1 2\n");
  for (const char* name : {"a.obj", "a.ply"}) {
    const SceneSections scene = scene_of(files, name);
    EXPECT_THAT(write_yaml(*scene.sections),
                HasSubstr("mesh: {type: lambert, color: {type: vertex-color}}"));
    EXPECT_THAT(scene.notes, IsEmpty());
  }
}

constexpr const char* kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

TEST(ObjScene, ALineMayNameSeveralLibraries) {
  MemoryAssets files;
  files.add("a.obj",
            std::string(kTriangle) +
                "mtllib one.mtl two words.mtl\nusemtl red\nf 1 2 3\nusemtl blue\nf 3 2 1\n");
  files.add("one.mtl", "newmtl red\nKd 1 0 0\n");
  files.add("two words.mtl", "newmtl blue\nKd 0 0 1\n");
  const SceneSections scene = scene_of(files, "a.obj");
  EXPECT_THAT(scene.notes, IsEmpty());
  EXPECT_THAT(write_yaml(*scene.sections), HasSubstr("[1, 0, 0]"));
  EXPECT_THAT(write_yaml(*scene.sections), HasSubstr("[0, 0, 1]"));
}

TEST(ObjScene, TellsWhatItLeavesOut) {
  MemoryAssets files;
  files.add("a.obj",
            std::string(kTriangle) +
                "mtllib a.mtl\nusemtl red\nf 1 2 3\nusemtl gone\nf 3 2 1\nf 1 2\nl 1 2\np 3\n");
  files.add("a.mtl", "newmtl red\nKd 1 0 0\nnewmtl red\nKd 0 2 0\n");
  const SceneSections scene = scene_of(files, "a.obj");
  EXPECT_THAT(scene.notes,
              testing::UnorderedElementsAre(
                  HasSubstr("no library has a material 'gone'"), HasSubstr("3 points, lines"),
                  HasSubstr("newmtl of this name before"), HasSubstr("Kd above 1")));
}

/// Counts which files are opened.
class CountedAssets : public MemoryAssets {
 public:
  Result<Bytes> open(const std::string& reference, const std::string& from) override {
    ++opened[resolve_reference(reference, from)];
    return MemoryAssets::open(reference, from);
  }
  bool exists(const std::string& reference) override {
    return MemoryAssets::open(reference, {}).ok();
  }

  std::map<std::string, int> opened;
};

/// Exporters name it before every group of faces.
TEST(ObjScene, ALibraryThatIsNamedAgainIsReadOnce) {
  CountedAssets files;
  std::string text = "mtllib ./a.mtl\nmtllib b.mtl\nmtllib";
  for (int i = 0; i < 1000; ++i) text += " a.mtl";
  files.add("a.obj", text + "\n" + kTriangle + "usemtl red\nf 1 2 3\nusemtl blue\nf 3 2 1\n");
  files.add("a.mtl", "newmtl red\nKd 1 0 0\n");
  files.add("b.mtl", "newmtl red\nKd 0.5 0 0\nnewmtl blue\nKd 0 0 1\n");
  const SceneSections scene = scene_of(files, "a.obj");
  EXPECT_EQ(files.opened["a.mtl"], 1);
  EXPECT_EQ(files.opened["b.mtl"], 1);
  EXPECT_THAT(scene.notes, testing::ElementsAre(HasSubstr(
                               "a.mtl: line 1: material 'red' is there for the second time")));
  EXPECT_THAT(write_yaml(*scene.sections), HasSubstr("color: [1, 0, 0]"));
}

}  // namespace
}  // namespace hyades::core
