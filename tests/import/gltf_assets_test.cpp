// Khronos's sample models render as their names promise.

#include <gtest/gtest.h>

#include "core/import/gltf/read_gltf.h"
#include "tests/import/rendered_scene.h"
#include "tests/support/shared_assets.h"

namespace hyades::test {
namespace {

ScenePicture render_asset(const std::string& name, const SceneView& view) {
  const std::string folder = shared_file("assets/gltf");
  const auto files = core::make_file_resolver(folder);
  const auto source = core::read_gltf(*files, name + ".glb");
  if (!source) throw std::runtime_error(source.error().message);
  return render_scene(**source, view, folder, name);
}

#define NEEDS_ASSETS() HYADES_SKIP_WITHOUT(shared_file("assets/gltf"))

const char* const kEven = "environment: {color: 1}\n";

TEST(GltfAssets, BoxIsRed) {
  NEEDS_ASSETS();
  const ScenePicture picture =
      render_asset("Box", {.yaml = std::string(kEven) +
                                   "film: {size: [64, 64]}\n"
                                   "camera: {look_from: [1.5, 1.2, 2], look_at: [0, 0, 0]}\n"});
  const core::Rgb middle = picture.mean(28, 28, 36, 36);
  EXPECT_GT(middle.x, 5.0F * middle.y);
}

TEST(GltfAssets, BoxTexturedShowsItsPicture) {
  NEEDS_ASSETS();
  const ScenePicture picture =
      render_asset("BoxTextured", {.yaml = std::string(kEven) +
                                           "film: {size: [64, 64]}\n"
                                           "camera: {look_from: [0, 0, 2.5], look_at: [0, 0, 0], "
                                           "fov: 24}\n"});
  // Blue sky above, green grass below, the sun to the upper left.
  const core::Rgb sky = picture.mean(30, 12, 42, 18);
  const core::Rgb grass = picture.mean(28, 52, 36, 56);
  EXPECT_GT(sky.z, 2.0F * sky.x);
  EXPECT_GT(grass.y, 2.0F * grass.z);
}

}  // namespace
}  // namespace hyades::test
