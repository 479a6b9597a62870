#include <gtest/gtest.h>

#include <map>
#include <string>

#include "core/job/parse.h"
#include "core/scene/build_scene.h"
#include "core/scene/flatten.h"
#include "tests/core/job/test_assets.h"

namespace hyades::core {
namespace {

constexpr const char* kScene = R"(hyades: 1
materials:
  bark: {type: lambert, color: 0.2}
  leaf: {type: lambert, color: [0.1, 0.5, 0.1]}
  autumn: {type: lambert, color: [0.6, 0.3, 0.1]}
groups:
  tree: {objects: {trunk: {shape: box, material: bark}, crown: {shape: sphere, material: leaf}, nest: {shape: disk}}}
)";

class Overrides : public ::testing::Test {
 protected:
  /// The colours of objects by name.
  std::map<std::string, Rgb> colors(const std::string& objects) {
    Diagnostics diagnostics;
    const Job job = parse_job(kScene + objects, "job.yaml", assets_, diagnostics);
    EXPECT_EQ(diagnostics.to_string(), "");
    SceneCache cache(assets_);
    const auto flat = flatten_objects(job, 1, cache);
    std::map<std::string, Rgb> found;
    if (!flat) {
      ADD_FAILURE() << flat.error().message;
      return found;
    }
    for (const FlatObject& object : *flat) {
      for (const MaterialDesc& material : job.materials) {
        if (material.name == object.material)
          found[object.name] = std::get<LambertDesc>(material.kind).color.value.at(job.time_of(1));
      }
    }
    return found;
  }

  std::string complaint(const std::string& objects) {
    Diagnostics diagnostics;
    const Job job = parse_job(kScene + objects, "job.yaml", assets_, diagnostics);
    if (!diagnostics.empty()) return diagnostics.to_string();
    SceneCache cache(assets_);
    const auto scene = build_scene(job, 1, cache);
    return scene ? "" : scene.error().message;
  }

  MemoryAssets assets_;
};

TEST_F(Overrides, ChangeKeysOfOneInstanceOnly) {
  auto found = colors(
      "objects: {a: {instance: tree}, b: {instance: tree, override: {bark: {color: 0.9}, leaf: "
      "autumn}}}\n");
  EXPECT_EQ(found["a/trunk"], Rgb(0.2F));
  EXPECT_EQ(found["b/trunk"], Rgb(0.9F));
  EXPECT_EQ(found["a/crown"], Rgb(0.1F, 0.5F, 0.1F));
  EXPECT_EQ(found["b/crown"], Rgb(0.6F, 0.3F, 0.1F));
}

TEST_F(Overrides, ReachMaterialsThatAreInherited) {
  auto found =
      colors("objects: {a: {instance: tree, material: bark, override: {bark: {color: 0.7}}}}\n");
  EXPECT_EQ(found["a/nest"], Rgb(0.7F));
  EXPECT_EQ(found["a/trunk"], Rgb(0.7F));
}

TEST_F(Overrides, TheOutermostCounts) {
  auto found = colors(
      "objects: {a: {override: {leaf: autumn}, group: {objects: {b: {instance: tree, override: "
      "{leaf: bark}}}}}}\n");
  EXPECT_EQ(found["a/b/crown"], Rgb(0.6F, 0.3F, 0.1F));
}

TEST_F(Overrides, ComplainAboutWhatIsNotThere) {
  EXPECT_NE(complaint("objects: {a: {shape: box, material: bark, override: {leaf: autumn}}}\n")
                .find("overrides the material 'leaf', which nothing in it has"),
            std::string::npos);
  EXPECT_NE(complaint("objects: {a: {shape: box, override: {lef: autumn}}}\n")
                .find("names the material 'lef', which does not exist"),
            std::string::npos);
  EXPECT_NE(complaint("objects: {a: {shape: box, material: bark, override: {bark: {colour: 1}}}}\n")
                .find("colour"),
            std::string::npos);
  EXPECT_NE(complaint("objects: {a: {shape: box, material: bark, override: {bark: [1]}}}\n")
                .find("expected keys of the material 'bark'"),
            std::string::npos);
}

}  // namespace
}  // namespace hyades::core
