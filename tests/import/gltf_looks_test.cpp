// What small glTF scenes look like, where closed forms or another way to say the same know it.

#include <gtest/gtest.h>

#include <cmath>

#include "import/stand_in.h"
#include "tests/import/gltf_builder.h"
#include "tests/import/rendered_scene.h"

namespace hyades::test {
namespace {

/// A square that moves there and back in 0.85 s, as often as said.
std::string swinging(int rounds) {
  GltfBuilder b;
  b.add("nodes", {{"mesh", b.mesh(b.square())}});
  std::vector<float> times = {0};
  std::vector<float> ways = {-2, 0, 0};
  for (int i = 0; i < rounds; ++i) {
    const float begin = 0.85F * static_cast<float>(i);
    times.insert(times.end(), {begin + 0.3F, begin + 0.85F});
    ways.insert(ways.end(), {1, 0.5F, 0, -2, 0, 0});
  }
  b.add("animations",
        {{"samplers", {{{"input", b.floats(times, "SCALAR")}, {"output", b.floats(ways, "VEC3")}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}});
  return b.glb();
}

/// Frames 9 and 17 of 10 a second are open while the clip begins again.
TEST(GltfLooks, LoopsAreWhatTheSameClipManyTimesIs) {
  const auto once = read_glb(swinging(1));
  const auto often = read_glb(swinging(3));
  ASSERT_TRUE(once.ok() && often.ok());
  const std::string yaml = "environment: {color: 1}\nframes: {range: 1-30, fps: 10, shutter: 1}\n" +
                           Window{.height = 6.0F}.yaml();
  for (const int frame : {4, 9, 14, 17, 18}) {
    SCOPED_TRACE(frame);
    SceneView view{.yaml = yaml, .frame = frame, .samples = 8};
    view.fps = 10;
    const ScenePicture long_one = render_scene(**often, view, ".", "often");
    view.loop = true;
    const ScenePicture loop = render_scene(**once, view, ".", "loop");
    EXPECT_GT(loop.mean(0, 0, 64, 64).x, 0.0F);
    for (int i = 0; i < 64 * 64; ++i) {
      EXPECT_NEAR(loop.at(i % 64, i / 64).x, long_one.at(i % 64, i / 64).x, 0.02F) << i;
    }
  }
}

/// A polished square of KHR_materials_pbrSpecularGlossiness straight before an even sky: by the
/// extension it reflects `specular` and, of what is matt, 1 less the brightest channel of that.
core::Rgb polished(const core::Rgb& specular, float diffuse, bool textured) {
  GltfBuilder b;
  nlohmann::json look = {{"diffuseFactor", {diffuse, diffuse, diffuse, 1}},
                         {"specularFactor", {specular.x, specular.y, specular.z}}};
  if (textured) {
    const core::Bytes magenta = core::magenta_picture();
    b.add("images",
          {{"bufferView", b.view(magenta.chars(), magenta.size())}, {"mimeType", "image/png"}});
    b.add("textures", {{"source", 0}});
    look["specularGlossinessTexture"] = {{"index", 0}};
  }
  b.add("materials", {{"extensions", {{"KHR_materials_pbrSpecularGlossiness", look}}}});
  nlohmann::json square = b.square();
  square["material"] = 0;
  b.add("nodes", {{"mesh", b.mesh(square)}});
  const auto source = read_glb(b.glb());
  if (!source) throw std::runtime_error(source.error().message);
  const ScenePicture picture =
      render_scene(**source,
                   {.yaml = "environment: {color: 1}\n" + Window{0.5F, 0.5F, 0.5F, 16, 16}.yaml(),
                    .samples = 256},
                   ".", "polished");
  return picture.mean(0, 0, 16, 16);
}

TEST(GltfLooks, SpecularOfATextureIsThatOfTheExtension) {
  for (const float s : {0.02F, 0.04F, 0.5F, 0.95F}) {
    SCOPED_TRACE(s);
    const core::Rgb seen = polished({s, 1.0F, 0.6F * s}, 0.5F, true);
    const float matt = 0.5F * (1.0F - s);
    EXPECT_NEAR(seen.x, s + matt, 0.015F);
    EXPECT_NEAR(seen.y, matt, 0.015F);
    EXPECT_NEAR(seen.z, 0.6F * s + matt, 0.015F);
    // Without a texture the same is told otherwise.
    const core::Rgb plain = polished({s, 0.0F, 0.6F * s}, 0.5F, false);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(plain[c], seen[c], 0.025F) << c;
  }
}

}  // namespace
}  // namespace hyades::test
