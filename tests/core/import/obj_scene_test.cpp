#include "core/import/obj/read_obj_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

}  // namespace
}  // namespace hyades::core
