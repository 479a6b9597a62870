// Materials, textures, lights and cameras of glTF in the words of jobs.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/job/parse.h"
#include "tests/import/gltf_builder.h"

namespace hyades::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// The job of a square of this material; of textures there is one, 0.
std::string job_with(const nlohmann::json& material) {
  GltfBuilder b;
  b.add("images", {{"uri", "wood grain.jpg"}});
  b.add("textures", {{"source", 0}});
  b.add("materials", material);
  nlohmann::json square = b.square();
  square["material"] = 0;
  b.add("nodes", {{"mesh", b.mesh(square)}, {"name", "Thing"}});
  core::SceneRequest request;
  request.beside = "../";
  const std::string job = job_of(b, request);
  // Whatever it is, jobs accept it.
  FilesInMemory files;
  files.files["meshes/Thing.ply"] = "x";
  files.files["../wood%20grain.jpg"] = files.files["../wood grain.jpg"] = "x";
  core::Diagnostics diagnostics;
  core::parse_job("hyades: 1\n" + job, "job.yaml", files, diagnostics);
  EXPECT_EQ(diagnostics.to_string(), "") << job;
  return job;
}

TEST(GltfMaterial, DefaultsAreThoseOfTheSpecification) {
  EXPECT_THAT(
      job_with(nlohmann::json::object()),
      HasSubstr("{type: principled, base_color: 1, metallic: 1, roughness: 1, sides: front}"));
}

TEST(GltfMaterial, BacksAreNotSeenButWhereLightGoesInOrTheFileSaysSo) {
  const auto transmission = [](const char* name, const char* key) {
    return nlohmann::json{{"extensions", {{name, {{key, 1}}}}}};
  };
  EXPECT_THAT(job_with({{"doubleSided", true}}), Not(HasSubstr("sides")));
  EXPECT_THAT(job_with(transmission("KHR_materials_transmission", "transmissionFactor")),
              Not(HasSubstr("sides")));
  EXPECT_THAT(
      job_with(transmission("KHR_materials_diffuse_transmission", "diffuseTransmissionFactor")),
      Not(HasSubstr("sides")));
  EXPECT_THAT(job_with(transmission("KHR_materials_volume", "thicknessFactor")),
              Not(HasSubstr("sides")));
  EXPECT_THAT(job_with(transmission("KHR_materials_clearcoat", "clearcoatFactor")),
              HasSubstr("sides: front"));
}

TEST(GltfMaterial, SpecularOfATextureIsAMixture) {
  const std::string job =
      job_with({{"name", "Old"},
                {"emissiveFactor", {1, 1, 1}},
                {"extensions",
                 {{"KHR_materials_pbrSpecularGlossiness",
                   {{"specularGlossinessTexture", {{"index", 0}}}, {"glossinessFactor", 0.5}}}}}});
  EXPECT_THAT(job, HasSubstr("Old:\n    type: mix\n    first: Old.body\n    second: Old.mirror"));
  EXPECT_THAT(job, HasSubstr("emit: {color: 1, radiance: 1}"));
  EXPECT_THAT(job, Not(HasSubstr("emission_strength")));
}

TEST(GltfMaterial, AlphaModes) {
  const nlohmann::json half = {{"baseColorFactor", {1, 1, 1, 0.5}},
                               {"baseColorTexture", {{"index", 0}}}};
  EXPECT_THAT(job_with({{"pbrMetallicRoughness", half}}), Not(HasSubstr("opacity")));
  EXPECT_THAT(job_with({{"pbrMetallicRoughness", half}, {"alphaMode", "BLEND"}}),
              HasSubstr("opacity: {type: scale, input: texture.alpha, factor: 0.5}"));
  EXPECT_THAT(
      job_with({{"pbrMetallicRoughness", half}, {"alphaMode", "MASK"}, {"alphaCutoff", 0.3}}),
      HasSubstr("opacity: {type: threshold, input: {type: scale, input: texture.alpha, "
                "factor: 0.5}, level: 0.3}"));
  EXPECT_THAT(job_with({{"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0.2}}}},
                        {"alphaMode", "MASK"}}),
              HasSubstr("opacity: 0"));
}

TEST(GltfMaterial, PicturesBesideTheSceneAreNamedWhereTheyLie) {
  EXPECT_THAT(job_with({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}),
              HasSubstr("file: ../wood grain.jpg"));
}

TEST(GltfMaterial, VolumesAbsorbByBeersLaw) {
  const std::string job = job_with({{"name", "Syrup"},
                                    {"extensions",
                                     {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                                      {"KHR_materials_ior", {{"ior", 1.4}}},
                                      {"KHR_materials_volume",
                                       {{"thicknessFactor", 1},
                                        {"attenuationDistance", 2},
                                        {"attenuationColor", {1, 0.36787944, 0.13533528}}}}}}});
  EXPECT_THAT(job, HasSubstr("Syrup: {absorption: [0, 0.49999"));
  EXPECT_THAT(job, HasSubstr("interior: Syrup"));
  EXPECT_THAT(job, HasSubstr("transmission: 1"));
  EXPECT_THAT(job, HasSubstr("ior: 1.4"));
  EXPECT_THAT(job, Not(HasSubstr("thin_walled")));
}

TEST(GltfMaterial, WithoutAVolumeWallsAreThin) {
  EXPECT_THAT(
      job_with({{"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 0.5}}}}}}),
      HasSubstr("transmission: 0.5, thin_walled: true"));
}

TEST(GltfMaterial, LayersAndTheirTextures) {
  const nlohmann::json map = {{"index", 0}};
  EXPECT_THAT(job_with({{"extensions",
                         {{"KHR_materials_clearcoat",
                           {{"clearcoatFactor", 0.5},
                            {"clearcoatTexture", map},
                            {"clearcoatRoughnessFactor", 0.25}}}}}}),
              HasSubstr("coat: {type: scale, input: texture.red, factor: 0.5}\n"
                        "    coat_roughness: 0.25"));
  EXPECT_THAT(
      job_with({{"extensions",
                 {{"KHR_materials_sheen",
                   {{"sheenColorFactor", {0.5, 0.25, 1}}, {"sheenRoughnessFactor", 0.75}}}}}}),
      HasSubstr("sheen: 1\n    sheen_tint: [0.5, 0.25, 1]\n    sheen_roughness: 0.75"));
  EXPECT_THAT(job_with({{"extensions",
                         {{"KHR_materials_specular",
                           {{"specularFactor", 0.5}, {"specularColorFactor", {1, 0.5, 0}}}}}}}),
              HasSubstr("specular: 0.25\n    specular_tint: [1, 0.5, 0]"));
}

TEST(GltfMaterial, ACoatOverBumpsIsALayerOfItsOwn) {
  const std::string job =
      job_with({{"name", "Paint"},
                {"normalTexture", {{"index", 0}, {"scale", 0.5}}},
                {"extensions", {{"KHR_materials_clearcoat", {{"clearcoatFactor", 1}}}}}});
  EXPECT_THAT(job, HasSubstr("normal_map: {texture: texture, strength: 0.5}"));
  EXPECT_THAT(
      job,
      HasSubstr("Paint: {type: coat, base: Paint.base, amount: 1, roughness: 0, sides: front}"));
}

TEST(GltfMaterial, SurfacesThatShine) {
  const nlohmann::json strong = {{"KHR_materials_emissive_strength", {{"emissiveStrength", 20}}}};
  EXPECT_THAT(job_with({{"emissiveFactor", {1, 0.5, 0}}, {"extensions", strong}}),
              HasSubstr("emission_color: [1, 0.5, 0]\n    emission_strength: 20"));
  EXPECT_THAT(job_with({{"emissiveFactor", {1, 0.5, 0}}, {"doubleSided", true}}),
              HasSubstr("emit: {color: [1, 0.5, 0], radiance: 1, two_sided: true}"));
  const std::string unlit =
      job_with({{"pbrMetallicRoughness", {{"baseColorFactor", {0.25, 0.5, 1, 1}}}},
                {"extensions", {{"KHR_materials_unlit", nlohmann::json::object()}}}});
  EXPECT_THAT(unlit, HasSubstr("{type: black, sides: front}"));
  EXPECT_THAT(unlit, HasSubstr("emit: {color: [0.25, 0.5, 1], radiance: 1}"));
}

TEST(GltfMaterial, AnisotropyIsRoughnessAlongTheTangent) {
  // alpha = 0.04; along the tangent 0.04 + 0.96 * 0.25 = 0.28.
  const std::string job =
      job_with({{"pbrMetallicRoughness", {{"roughnessFactor", 0.2}}},
                {"extensions",
                 {{"KHR_materials_anisotropy",
                   {{"anisotropyStrength", 0.5}, {"anisotropyRotation", -1.5707963}}}}}});
  EXPECT_THAT(job, HasSubstr("roughness_along: 0.52915"));
  EXPECT_THAT(job, HasSubstr("anisotropic_rotation: 0.75"));
}

TEST(GltfMaterial, TextureTransformsAreTurnedWithV) {
  // A quarter of a turn: what lay at (u, v) of the picture, v downwards, is read at (v, -u), then
  // moved.
  const std::string job = job_with(
      {{"pbrMetallicRoughness",
        {{"baseColorTexture",
          {{"index", 0},
           {"extensions",
            {{"KHR_texture_transform",
              {{"offset", {0.5, 0.25}}, {"rotation", 1.5707964}, {"scale", {2, 3}}}}}}}}}}});
  EXPECT_THAT(job, HasSubstr("mapping:\n      type: uv\n      transform:\n        - {matrix: ["));
  const size_t at = job.find("matrix: [") + 9;
  std::stringstream numbers(job.substr(at, job.find(']', at) - at));
  std::array<float, 16> m{};
  char comma = 0;
  for (float& each : m) {
    numbers >> each;
    numbers >> comma;
  }
  // The place (u, v) = (0.1, 0.3) of the file, w = 1 - v.
  const float u = m[0] * 0.1F + m[1] * 0.7F + m[3];
  const float w = m[4] * 0.1F + m[5] * 0.7F + m[7];
  EXPECT_NEAR(u, 3 * 0.3F + 0.5F, 1e-5F);
  EXPECT_NEAR(1.0F - w, -2 * 0.1F + 0.25F, 1e-5F);
}

TEST(GltfLights, CandelaAndLuxAreWatts) {
  GltfBuilder b;
  b.json["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "point"}, {"intensity", 683}, {"color", {1, 0.5, 0.25}}, {"name", "Bulb"}},
      {{"type", "directional"}, {"intensity", 1366}},
      {{"type", "spot"},
       {"intensity", 683},
       {"spot", {{"outerConeAngle", 0.78539816}, {"innerConeAngle", 0.39269908}}}}};
  for (int i = 0; i < 3; ++i) {
    b.add("nodes", {{"translation", {0, 3, 0}},
                    {"rotation", {-0.70710678, 0, 0, 0.70710678}},
                    {"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
  }
  const std::string job = job_of(b);
  EXPECT_THAT(job, HasSubstr("Bulb: {type: point, color: [1, 0.5, 0.25], at: [0, 3, 0], "
                             "power: 12.566371}"));
  EXPECT_THAT(job, HasSubstr("type: sun, color: [1, 1, 1], direction: [0, -1, "));
  EXPECT_THAT(job, HasSubstr("irradiance: 2, angle: 0}"));
  EXPECT_THAT(job, HasSubstr("look_at: [0, 2, "));
  EXPECT_THAT(job, HasSubstr("angle: 45"));
  EXPECT_THAT(job, HasSubstr("blend: 0.5"));
}

TEST(GltfCameras, OrthographicOnesAndThoseThatMove) {
  GltfBuilder b;
  b.add("cameras", {{"type", "orthographic"}, {"orthographic", {{"xmag", 3}, {"ymag", 2}}}});
  b.add("nodes", {{"camera", 0}});
  const int times = b.floats({0, 0.25F}, "SCALAR");
  const int places = b.floats({0, 0, 0, 6, 0, 0}, "VEC3");
  b.add("animations",
        {{"samplers", {{{"input", times}, {"output", places}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}});
  core::SceneRequest request;
  request.fps = 12;
  const std::string job = job_of(b, request);
  EXPECT_THAT(job, HasSubstr("frames: {range: 1-4, fps: 12}"));
  EXPECT_THAT(job, HasSubstr("film: {size: [1080, 720]}"));
  EXPECT_THAT(job, HasSubstr("type: orthographic\n  height: 4"));
  EXPECT_THAT(job, HasSubstr("3: [4, 0, 0], 4: [6, 0, 0]"));
}

}  // namespace
}  // namespace hyades::test
