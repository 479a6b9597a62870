// Khronos's sample models render as their names promise.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "import/gltf/read_gltf.h"
#include "tests/import/rendered_scene.h"
#include "tests/support/moments.h"
#include "tests/support/shared_assets.h"

namespace hyades::test {
namespace {

ScenePicture render_asset(const std::string& name, const SceneView& view,
                          const std::string& suffix = {}) {
  const std::string folder = shared_file("assets/gltf");
  const auto files = core::make_file_resolver(folder);
  const auto source = core::read_gltf(*files, name + ".glb");
  if (!source) throw std::runtime_error(source.error().message);
  return render_scene(**source, view, folder, name + suffix);
}

#define NEEDS_ASSETS() HYADES_SKIP_WITHOUT(shared_file("assets/gltf"))

const std::string kEven = "environment: {color: 1}\n";

TEST(GltfAssets, BoxIsRed) {
  NEEDS_ASSETS();
  const ScenePicture picture = render_asset(
      "Box", {.yaml = kEven + "film: {size: [64, 64]}\n"
                              "camera: {look_from: [1.5, 1.2, 2], look_at: [0, 0, 0]}\n"});
  const core::Rgb middle = picture.mean(28, 28, 36, 36);
  EXPECT_GT(middle.x, 5.0F * middle.y);
}

TEST(GltfAssets, BoxTexturedShowsItsPicture) {
  NEEDS_ASSETS();
  const ScenePicture picture = render_asset(
      "BoxTextured", {.yaml = kEven + "film: {size: [64, 64]}\n"
                                      "camera: {look_from: [0, 0, 2.5], look_at: [0, 0, 0], "
                                      "fov: 24}\n"});
  // Blue sky above, green grass below.
  const core::Rgb sky = picture.mean(30, 12, 42, 18);
  const core::Rgb grass = picture.mean(28, 52, 36, 56);
  EXPECT_GT(sky.z, 2.0F * sky.x);
  EXPECT_GT(grass.y, 2.0F * grass.z);
}

/// One face of the cube of OrientationTest, and where on it the target of its arrow lies.
struct Face {
  const char* name;
  core::Vec3 out;
  core::Vec3 target;  ///< middle, from the face's middle
  core::Rgb color;
};

TEST(GltfAssets, OrientationTestsArrowsPointAtTheirTargets) {
  NEEDS_ASSETS();
  const std::array<Face, 6> faces = {{{"X1", {1, 0, 0}, {0, 2.95F, -2.13F}, {1, 0, 0}},
                                      {"X2", {-1, 0, 0}, {0, 3.52F, 0.35F}, {0, 1, 1}},
                                      {"Y1", {0, 1, 0}, {3.34F, 0, -1.35F}, {0, 1, 0}},
                                      {"Y2", {0, -1, 0}, {-0.82F, 0, 3.47F}, {1, 0, 1}},
                                      {"Z1", {0, 0, 1}, {-1.02F, 3.43F, 0}, {0, 0, 1}},
                                      {"Z2", {0, 0, -1}, {1.15F, 3.4F, 0}, {1, 1, 0}}}};
  for (const Face& face : faces) {
    SCOPED_TRACE(face.name);
    const core::Vec3 up = face.out.y != 0 ? core::Vec3(0, 0, -1) : core::Vec3(0, 1, 0);
    const core::Vec3 right = glm::cross(up, face.out);
    const core::Vec3 from = 20.0F * face.out;
    const ScenePicture picture = render_asset(
        "OrientationTest",
        {.yaml = kEven + fmt::format("film: {{size: [96, 96]}}\ncamera: {{type: orthographic, "
                                     "look_from: [{}, {}, {}], look_at: [0, 0, 0], up: [{}, {}, "
                                     "{}], height: 12}}\n",
                                     from.x, from.y, from.z, up.x, up.y, up.z),
         .samples = 8},
        face.name);
    const auto seen = [&](const core::Vec3& p) {
      const auto x = static_cast<int>(48.0F + 8.0F * glm::dot(p, right));
      const auto y = static_cast<int>(48.0F - 8.0F * glm::dot(p, up));
      return picture.mean(x - 1, y - 1, x + 2, y + 2);
    };
    const auto has_color = [&](const core::Rgb& c) {
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
          if (face.color[i] > face.color[j] && c[i] < 2.5F * c[j]) return false;
        }
      }
      return true;
    };
    EXPECT_TRUE(has_color(seen(face.target)));
    EXPECT_TRUE(has_color(seen(0.6F * face.target)));
    // Mirrored there is nothing but the cube.
    const core::Vec3 aside = face.target - 2.0F * glm::dot(face.target, right) * right;
    EXPECT_FALSE(has_color(seen(aside)));
  }
}

/// Where a square of side 2 half is green: how much of it, and the middle of that.
struct Green {
  float share = 0.0F;
  core::Vec2 middle{0.0F};
};

Green green_of(const Window& window, const ScenePicture& picture, const core::Vec2& place,
               float half) {
  Green green;
  constexpr int kSteps = 24;
  for (int i = 0; i < kSteps * kSteps; ++i) {
    const core::Vec2 at(static_cast<float>(i % kSteps), static_cast<float>(i / kSteps));
    const core::Vec2 part = half * (2.0F * (at + 0.5F) / static_cast<float>(kSteps) - 1.0F);
    const core::Rgb c = window.mean(picture, place.x + part.x, place.y + part.y, 0.0F);
    if (c.y < 1.5F * c.x) continue;
    green.share += 1.0F / (kSteps * kSteps);
    green.middle += part / static_cast<float>(kSteps * kSteps);
  }
  green.middle /= std::max(green.share, 1e-6F);
  return green;
}

TEST(GltfAssets, TextureSettingsTestLooksLikeItsSamples) {
  NEEDS_ASSETS();
  const Window window{1.5F, -1.05F, 8.3F, 140, 332};
  const ScenePicture picture =
      render_asset("TextureSettingsTest", {.yaml = kEven + window.yaml(), .samples = 8});
  struct Row {
    const char* name;
    float y;
    bool plain;
  };
  // To the left the test, to the right what it should look like: a tick, or green all over.
  const std::array<Row, 8> rows = {{{"single-sided", 2.54F, false},
                                    {"double-sided", 1.52F, false},
                                    {"clamp s", 0.47F, true},
                                    {"clamp t", -0.57F, true},
                                    {"repeat s", -1.6F, false},
                                    {"repeat t", -2.64F, false},
                                    {"mirror s", -3.68F, false},
                                    {"mirror t", -4.71F, false}}};
  for (const Row& row : rows) {
    SCOPED_TRACE(row.name);
    const Green test = green_of(window, picture, {0.45F, row.y}, 0.4F);
    const Green sample = green_of(window, picture, {2.6F, row.y}, 0.4F);
    EXPECT_NEAR(test.share, sample.share, 0.04F);
    EXPECT_NEAR(test.middle.x, sample.middle.x, 0.06F);
    EXPECT_NEAR(test.middle.y, sample.middle.y, 0.06F);
    EXPECT_EQ(sample.share > 0.99F, row.plain);
    EXPECT_EQ(sample.share > 0.1F && sample.share < 0.3F, !row.plain);
  }
}

TEST(GltfAssets, AttenuationTestDarkensByBeersLaw) {
  NEEDS_ASSETS();
  // The wall behind shines, and nothing else, so that what comes through a block is what its
  // surfaces and its inside leave of it.
  const Window window{1.5F, -4.5F, 6, 260, 120};
  const ScenePicture picture = render_asset(
      "AttenuationTest",
      {.yaml = "integrator: {max_depth: 16}\n" + window.yaml(),
       .samples = 32,
       .edits = {{"FlatBackdrop: {type: principled, base_color: PlainGrid, metallic: 0, "
                  "roughness: 0.5, sides: front}",
                  "FlatBackdrop: {type: principled, base_color: 0, specular: 0, "
                  "emission_strength: 1}"}}});
  struct Block {
    float x, y, thickness;  ///< in attenuation distances
  };
  const std::array<Block, 8> blocks = {{{-2, -3, 0.5F},
                                        {0, -3, 1},
                                        {2.5F, -3, 1.5F},
                                        {6, -3, 2},
                                        {-2, -6, 0.5F},
                                        {0, -6, 1},
                                        {2.5F, -6, 1.5F},
                                        {6, -6, 2}}};
  for (const Block& block : blocks) {
    const core::Rgb seen = window.mean(picture, block.x, block.y, 0.12F);
    for (int c = 0; c < 3; ++c) {
      const float left = std::pow(core::Rgb(0.1F, 0.5F, 0.9F)[c], block.thickness);
      // Both surfaces reflect 4 %, again and again.
      const float clear = 0.96F * 0.96F * left / (1.0F - 0.04F * 0.04F * left * left);
      EXPECT_NEAR(seen[c], clear, 0.03F * clear + 1e-3F) << block.x << " " << block.y << " " << c;
    }
  }
}

TEST(GltfAssets, ClearCoatTestsCoatsReflect) {
  NEEDS_ASSETS();
  const Window window{0, 0, 13, 80, 130};
  const ScenePicture picture =
      render_asset("ClearCoatTest", {.yaml = kEven + window.yaml(), .samples = 16});
  // Red paint, bare and coated: the coat adds white and takes little.
  const core::Rgb bare = window.mean(picture, -2.1F, 5.25F, 0.5F);
  const core::Rgb coated = window.mean(picture, 0, 5.25F, 0.5F);
  EXPECT_GT(coated.z, bare.z + 0.03F);
  EXPECT_GT(coated.x, bare.x);
  EXPECT_LT(coated.x, bare.x + 0.05F);
  // In all other rows too, by as much as the coat alone reflects or a little less.
  for (const float y : {1.05F, -1.05F, -3.15F, -5.25F}) {
    const float base = window.mean(picture, -2.1F, y, 0.5F).x;
    const float with_coat = window.mean(picture, 0, y, 0.5F).x;
    const float coat_alone = window.mean(picture, 2.1F, y, 0.5F).x;
    EXPECT_GT(with_coat, base + 0.1F * coat_alone) << y;
    EXPECT_LT(with_coat, base + 1.1F * coat_alone) << y;
  }
  // A coat with holes: alone it shows the sky through them, and not its own inside, for it is of
  // one side.
  const float half = window.mean(picture, 0, 3.15F, 0.5F).x;
  EXPECT_GT(half, window.mean(picture, -2.1F, 3.15F, 0.5F).x + 0.002F);
  EXPECT_GT(window.mean(picture, 2.1F, 3.15F, 0.5F).x, 3.0F * half);
}

TEST(GltfAssets, SpecularTestReflectsMoreToTheRight) {
  NEEDS_ASSETS();
  const Window window{0.1F, 0, 0.8F, 300, 240, 5};
  const ScenePicture picture =
      render_asset("SpecularTest", {.yaml = kEven + window.yaml(), .samples = 8});
  const auto middle = [&](int row, int column) {
    return window.mean(picture, 0.325F - 0.44F + 0.11F * static_cast<float>(column),
                       0.33F - 0.11F * static_cast<float>(row), 0.008F);
  };
  const std::array<float, 5> factors = {0, 0.051269F, 0.212231F, 0.520996F, 1};
  const std::array<float, 5> beyond = {0, 1.184F, 5.441F, 13.276F, 24};
  for (int column = 0; column < 5; ++column) {
    const float f = 0.04F * factors[static_cast<size_t>(column)];
    for (int row = 0; row < 4; ++row) {
      EXPECT_NEAR(middle(row, column).y, f, 0.05F * f + 1e-3F) << row << " " << column;
    }
    for (int row = 4; row < 6; ++row) {
      EXPECT_NEAR(middle(row, column).y, f, 0.05F * f + 1e-3F) << row << " " << column;
      EXPECT_LT(middle(row, column).z, 1e-3F) << row << " " << column;
    }
    // The whitest is held a little below 1.
    const float most = 0.04F * beyond[static_cast<size_t>(column)];
    EXPECT_NEAR(middle(6, column).y, most, 0.05F * most + 1e-3F) << column;
  }
}

TEST(GltfAssets, TransmissionRoughnessTestBlursMoreToTheRight) {
  NEEDS_ASSETS();
  const Window window{-0.075F, 0, 0.56F, 160, 208, 5};
  const ScenePicture picture = render_asset(
      "TransmissionRoughnessTest",
      {.yaml = "integrator: {max_depth: 8}\n" + window.yaml(),
       .samples = 16,
       .edits = {{"FlatBackdrop: {type: principled, base_color: GridWithDetails, metallic: 0, "
                  "roughness: 0.5, sides: front}",
                  "FlatBackdrop: {type: principled, base_color: 0, specular: 0, "
                  "emission_strength: 1, emission_color: GridWithDetails}"}}});
  const auto contrast = [&](int row, int column) {
    return window.contrast(picture, 0.2F - 0.44F + 0.11F * static_cast<float>(column),
                           0.22F - 0.11F * static_cast<float>(row), 0.035F);
  };
  // From diamond to water the pattern behind is sharp to the left and gone to the right.
  for (int row = 0; row < 4; ++row) {
    EXPECT_GT(contrast(row, 0), 0.1) << row;
    EXPECT_GT(contrast(row, 0), 3.0 * contrast(row, 2)) << row;
    EXPECT_LT(contrast(row, 3), 0.06) << row;
  }
  // Air does not blur.
  for (int column = 0; column < 4; ++column) EXPECT_GT(contrast(4, column), 0.06) << column;
}

TEST(GltfAssets, AnisotropyStrengthTestStretchesHighlights) {
  NEEDS_ASSETS();
  const Window window{-1, 3, 7, 100, 280};
  const ScenePicture picture = render_asset(
      "AnisotropyStrengthTest",
      {.yaml = "lights: {key: {type: sun, direction: [0, 0, -1], irradiance: 3, angle: 8}}\n" +
               window.yaml(),
       .samples = 16});
  // How wide a highlight is along x over along y, for spheres of roughness 1/3: where it has half
  // of its brightness.
  const auto stretch = [&](float y) {
    std::vector<std::pair<core::Vec2, float>> seen;
    float peak = 0.0F;
    for (float dy = -0.3F; dy <= 0.3F; dy += 0.025F) {
      for (float dx = -0.3F; dx <= 0.3F; dx += 0.025F) {
        seen.emplace_back(core::Vec2(dx, dy),
                          core::luminance(window.mean(picture, -1 + dx, y + dy, 0.04F)));
        peak = std::max(peak, seen.back().second);
      }
    }
    core::Vec2 squares(0.0F);
    for (const auto& [place, light] : seen) {
      if (light > 0.5F * peak) squares += place * place;
    }
    return std::sqrt(squares.x / squares.y);
  };
  EXPECT_NEAR(stretch(0), 1.0, 0.1);
  EXPECT_GT(stretch(2), 1.25);
  EXPECT_GT(stretch(3), 1.5);
  EXPECT_GT(stretch(6), 2.0);
}

TEST(GltfAssets, BoxVertexColorsShowsThoseOfItsCorners) {
  NEEDS_ASSETS();
  // The face towards +z: 0.8 times what the file says of its corners, near these.
  struct Corner {
    float x, y;
    core::Rgb color;
  };
  const std::array<Corner, 4> corners = {{{-1, -1, {0.64F, 0.64F, 0.64F}},
                                          {1, -1, {0, 0.1F, 0.8F}},
                                          {-1, 1, {0.41F, 0.8F, 0}},
                                          {1, 1, {0.8F, 0, 0.02F}}}};
  const Window window{0, 0, 1.2F, 60, 60};
  const ScenePicture picture =
      render_asset("BoxVertexColors", {.yaml = kEven + window.yaml(), .samples = 16});
  for (const Corner& corner : corners) {
    const core::Rgb seen = window.mean(picture, 0.45F * corner.x, 0.45F * corner.y, 0.03F);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(seen[c], corner.color[c], 0.12F) << corner.x << " " << corner.y << " " << c;
    }
  }
}

TEST(GltfAssets, CornellBoxIsRedToTheLeftAndGreenToTheRight) {
  NEEDS_ASSETS();
  const ScenePicture picture = render_asset(
      "CornellBox",
      {.yaml = "film: {size: [64, 64]}\ncamera: {look_from: [-278, 273, 800], look_at: [-278, 273, "
               "0], fov: 39}\n",
       .samples = 16});
  const core::Rgb left = picture.mean(3, 20, 8, 44);
  const core::Rgb right = picture.mean(56, 20, 61, 44);
  EXPECT_GT(left.x, 4.0F * left.y);
  EXPECT_GT(right.y, 4.0F * right.x);
  // The lamp shines with what the file says.
  EXPECT_NEAR(picture.mean(28, 8, 36, 9).y, 100.0F, 15.0F);
}

/// A silhouette before nothing: which pixels are covered.
std::vector<float> coverage(const ScenePicture& picture) {
  std::vector<float> out;
  const int alpha = picture.image.find_channel("A");
  for (int y = 0; y < picture.image.height; ++y) {
    for (int x = 0; x < picture.image.width; ++x) out.push_back(picture.image.at(x, y, alpha));
  }
  return out;
}

/// What two silhouettes have in common over what either has.
float overlap(const std::vector<float>& a, const std::vector<float>& b) {
  float both = 0.0F;
  float either = 0.0F;
  for (size_t i = 0; i < a.size(); ++i) {
    both += std::min(a[i], b[i]);
    either += std::max(a[i], b[i]);
  }
  return both / either;
}

const std::string kUnseen = "environment: {color: 1, visible_to_camera: false}\n";

TEST(GltfAssets, DracoSuzanneIsWholeAndSymmetric) {
  NEEDS_ASSETS();
  const ScenePicture picture = render_asset(
      "suzanne_draco", {.yaml = kUnseen + Window{0, 0, 3, 96, 96}.yaml(), .samples = 4});
  const std::vector<float> shape = coverage(picture);
  std::vector<float> mirrored = shape;
  for (size_t y = 0; y < 96; ++y) {
    std::reverse(mirrored.begin() + static_cast<std::ptrdiff_t>(96 * y),
                 mirrored.begin() + static_cast<std::ptrdiff_t>(96 * y + 96));
  }
  EXPECT_GT(overlap(shape, mirrored), 0.95F);
  float area = 0.0F;
  for (const float each : shape) area += each / (32.0F * 32.0F);
  EXPECT_NEAR(area, 1.25F, 0.1F);
}

TEST(GltfAssets, CesiumManWalks) {
  NEEDS_ASSETS();
  const auto silhouette = [](int frame, const std::string& shutter) {
    return coverage(render_asset(
        "CesiumMan",
        {.yaml = kUnseen + "frames: {range: 1-49, fps: 24" + shutter + "}\n" +
                 "film: {size: [100, 100]}\ncamera: {look_from: [3, 0.8, 0], look_at: [0, 0.8, 0], "
                 "fov: 35}\n",
         .frame = frame,
         .samples = 8},
        std::to_string(frame)));
  };
  const std::vector<float> first = silhouette(1, "");
  const std::vector<float> half = silhouette(13, "");
  EXPECT_LT(overlap(first, half), 0.85F);
  EXPECT_GT(overlap(first, half), 0.4F);
  // Two seconds are a whole walk.
  EXPECT_GT(overlap(first, silhouette(49, "")), 0.93F);
  // While the shutter is open legs and arms move: more pixels are covered in part.
  const auto soft = [](const std::string& shutter) {
    const std::vector<float> shape = coverage(
        render_asset("CesiumMan",
                     {.yaml = kUnseen + "frames: {range: 1-49, fps: 24" + shutter + "}\n" +
                              "film: {size: [300, 300], crop: [90, 160, 210, 270], filter: box}\n"
                              "camera: {look_from: [3, 0.8, 0], look_at: [0, 0.8, 0], fov: 35}\n",
                      .frame = 13,
                      .samples = 8},
                     "Legs"));
    return std::count_if(shape.begin(), shape.end(), [](float a) { return a > 0.2F && a < 0.8F; });
  };
  EXPECT_GT(soft(", shutter: 1"), 1.2F * soft(""));
}

TEST(GltfAssets, FoxHasThreeGaits) {
  NEEDS_ASSETS();
  const auto shown = [](const std::string& clip) {
    return render_asset(
        "Fox",
        {.yaml = kUnseen + "film: {size: [100, 70]}\n"
                           "camera: {look_from: [240, 40, 0], look_at: [0, 40, 0], fov: 35}\n",
         .animation = clip,
         .frame = 8,
         .samples = 8},
        clip);
  };
  const ScenePicture walk = shown("Walk");
  const ScenePicture run = shown("Run");
  EXPECT_LT(overlap(coverage(walk), coverage(run)), 0.85F);
  EXPECT_LT(overlap(coverage(walk), coverage(shown("Survey"))), 0.9F);
  EXPECT_NE(walk.job.find("range: 1-18"), std::string::npos) << walk.job;
  EXPECT_TRUE(walk.notes.empty());
  // It is orange.
  const core::Rgb all = walk.mean(0, 0, 100, 70);
  EXPECT_GT(all.x, 1.5F * all.z);
}

}  // namespace
}  // namespace hyades::test
