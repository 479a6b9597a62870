#include "import/obj/mtl_material.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/hash.h"
#include "core/job/yaml_writer.h"

namespace hyades::core {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// The material that the lines say, as a job's text.
std::string look(const std::string& lines, const MtlMesh& mesh = {}) {
  const auto materials = parse_mtl("newmtl m\n" + lines);
  if (!materials) return materials.error().message;
  const MtlLook made = look_of(materials->front(), mesh, [](const std::string& f) { return f; });
  std::string text = write_yaml(*YamlMap{{"m", made.material.node()}}.node());
  if (!made.emit.empty()) text += write_yaml(*YamlMap{{"emit", made.emit.node()}}.node());
  for (const std::string& note : made.notes) text += note + "\n";
  return text;
}

TEST(MtlMaterial, ClassicOnes) {
  EXPECT_EQ(look("Kd 0.8 0.2 0.1\n"), "m: {type: lambert, color: [0.8, 0.2, 0.1]}\n");
  EXPECT_EQ(look("Kd 0.5\nKs 0 0 0\nNs 10\n"), "m: {type: lambert, color: 0.5}\n");
  // alpha^2 = 2 / (Ns + 2), and roughness is the root of alpha.
  EXPECT_EQ(look("Kd 1 0 0\nKs 0.5 0.5 0.5\nNs 30\nillum 2\n"),
            "m: {type: principled, base_color: [1, 0, 0], roughness: 0.5, specular: 0.5}\n");
  EXPECT_EQ(look("Kd 1 0 0\nKs 0.5 0.5 0.5\nillum 1\n"), "m: {type: lambert, color: [1, 0, 0]}\n")
      << "model 1 has no highlights";
  EXPECT_EQ(look("Kd 0 0 0\nKs 0.9 0.8 0.7\nillum 3\n"),
            "m: {type: conductor, color: [0.9, 0.8, 0.7], roughness: 0}\n");
}

TEST(MtlMaterial, ColoursOfVerticesCountWhereItSaysNone) {
  const MtlMesh colored{1.0F, true};
  EXPECT_EQ(look("", colored), "m: {type: lambert, color: {type: vertex-color}}\n");
  EXPECT_EQ(look("Pr 0.5\n", colored),
            "m: {type: principled, base_color: {type: vertex-color}, roughness: 0.5}\n");
  EXPECT_EQ(look("Kd 0.5\n", colored),
            "m: {type: lambert, color: 0.5}\n"
            "the colours of vertices are left out where 'm' is: it has its own\n");
}

TEST(MtlMaterial, Glass) {
  EXPECT_EQ(look("Kd 0 0 0\nNi 1.4\nTf 1 0.9 0.8\nillum 7\n"),
            "m: {type: dielectric, ior: 1.4, transmission: [1, 0.9, 0.8]}\n");
  EXPECT_EQ(look("d 0.1\nNi 1.4\n"), "m: {type: dielectric, ior: 1.4}\n");
  EXPECT_EQ(look("Kd 0.3\nTr 0.75\nNi 1\n"), "m: {type: lambert, color: 0.3, opacity: 0.25}\n")
      << "without an index it only thins out";
}

TEST(MtlMaterial, PhysicallyBasedOnes) {
  EXPECT_EQ(look("Kd 0.9\nPr 0.3\nPm 1\nPs 0.2\nPc 0.5\nPcr 0.1\naniso 0.4\nanisor 0.25\nNi 1.6\n"),
            "m:\n  type: principled\n  base_color: 0.9\n  roughness: 0.3\n  metallic: 1\n"
            "  sheen: 0.2\n  coat: 0.5\n  coat_roughness: 0.1\n  anisotropic: 0.4\n"
            "  anisotropic_rotation: 0.25\n  ior: 1.6\n");
}

TEST(MtlMaterial, PicturesAndTheirOptions) {
  EXPECT_EQ(look("map_Kd -s 2 3 1 -o 0.5 0 0 -clamp on my wood\\oak 1.png\n"),
            "m: {type: lambert, color: {type: image, file: my wood/oak 1.png, wrap: clamp, "
            "scale: [2, 3], offset: [0.5, 0]}}\n");
  EXPECT_THAT(look("Kd 0.5 0.5 0.5\nmap_Kd a.png\n"),
              HasSubstr("color: {type: scale, input: {type: image, file: a.png}, factor: 0.5}"));
  EXPECT_THAT(look("Kd 0 0 0\nmap_Kd a.png\n"), HasSubstr("color: {type: image, file: a.png}"));
  EXPECT_THAT(
      look("map_d -imfchan m leaf.png\n"),
      HasSubstr("opacity: {type: image, file: leaf.png, color_space: linear, channel: alpha}"));
  EXPECT_THAT(look("map_bump -bm 0.5 -mm 0.1 0.8 b.png\n"), HasSubstr("to_low: 0.1"));
  EXPECT_THAT(look("map_bump -bm 0.5 b.png\n"), HasSubstr("height: 0.001"));
  EXPECT_THAT(look("norm n.png\n"),
              HasSubstr("normal_map: {texture: {type: image, file: n.png, color_space: linear}}"));
  EXPECT_THAT(look("Ke 3 2 1\n"),
              HasSubstr("emit: {color: [3, 2, 1], radiance: 1, two_sided: true}"));
  EXPECT_THAT(look("map_Ke glow.png\n"), HasSubstr("emit: {color: {type: image, file: glow.png}"));
}

TEST(MtlMaterial, OptionsOfPicturesThatHaveACounterpart) {
  EXPECT_THAT(look("map_Kd -blendu off -blendv off a.png\n"),
              HasSubstr("color: {type: image, file: a.png, filter: nearest}"));
  EXPECT_THAT(look("norm -bm 0.5 n.png\n"), HasSubstr("color_space: linear}, strength: 0.5}"));
  EXPECT_THAT(look("map_Kd -imfchan r -o 1 -s 2 a.png\n"),
              HasSubstr("channel: red, scale: [2, 1], offset: [1, 0]}"));
  EXPECT_THAT(look("Pr 0.5\nmap_Pc c.png\nPcr 0.2\nmap_Pcr r.png\n"),
              HasSubstr("coat: {type: image, file: c.png, color_space: linear}\n  coat_roughness: "
                        "{type: scale, input: {type: image, file: r.png, color_space: linear}, "
                        "factor: 0.2}"));
  // Those that change nothing are not worth a word.
  EXPECT_EQ(look("map_Kd -cc off -boost 0 -t 0 0 0 -mm 0 1 -blendu on -blendv on -o 0 0 0 -s 1 1 1 "
                 "-clamp off a.png\n"),
            "m: {type: lambert, color: {type: image, file: a.png}}\n");
}

TEST(MtlMaterial, OptionsOfPicturesThatHaveNoneAreTold) {
  const std::pair<const char*, const char*> options[] = {
      {"-boost 2", "-boost 2"},       {"-t 0 0.5 0", "-t 0 0.5 0"},
      {"-cc on", "-cc on"},           {"-type sphere", "-type sphere"},
      {"-texres 512", "-texres 512"}, {"-blendu off", "-blendu off"},
      {"-blendv off", "-blendv off"}, {"-clamp maybe", "-clamp maybe"},
      {"-imfchan z", "-imfchan z"},   {"-bm 2", "-bm"},
      {"-unheard of", "-unheard of"},
  };
  for (const auto& [option, told] : options) {
    const std::string text = look(std::string("map_Kd ") + option + " a.png\n");
    EXPECT_EQ(text, std::string("m: {type: lambert, color: {type: image, file: a.png}}\n"
                                "line 2: map_Kd ") +
                        told + " is left out\n");
  }
  EXPECT_THAT(look("d -halo 0.5\n"), HasSubstr("line 2: d -halo is left out"));
}

TEST(MtlMaterial, WhatIsLeftOutIsTold) {
  EXPECT_THAT(look("Kd 1\nKs 1\nillum 1\nmap_Ks s.png\n"), HasSubstr("map_Ks of 'm' is left out"));
  EXPECT_THAT(look("illum 7\nmap_Pr r.png\n"), HasSubstr("map_Pr of 'm' is left out"));
  EXPECT_THAT(look("Kd 1\nTf 1 0 0\n"), HasSubstr("Tf of 'm' is left out: only glass is tinted"));
  EXPECT_THAT(
      look("disp d.png\nmap_Ns n.png\nKa 1 1 1\nrefl -type sphere r.png\n"),
      testing::AllOf(HasSubstr("line 2: disp is left out"), HasSubstr("line 5: refl is left out"),
                     HasSubstr("map_Ns of 'm'"), testing::Not(HasSubstr("Ka"))));
}

TEST(MtlMaterial, WrongLinesAreErrors) {
  EXPECT_EQ(look("Kd 1 two 3\n"), "line 2: Kd: expected one or three finite numbers");
  EXPECT_EQ(look("Kd 1 2\n"), "line 2: Kd: expected one or three finite numbers");
  EXPECT_EQ(look("Ns nan\n"), "line 2: Ns: expected a finite number");
  EXPECT_EQ(look("map_Kd -s 1 1\n"), "line 2: map_Kd: expected a file name after its options");
}

TEST(MtlFile, SeveralMaterialsAndTheLastOfAName) {
  const auto materials =
      parse_mtl("Kd 1\n# no material yet\nnewmtl a b\nKd 0.1\nnewmtl c\nnewmtl a b\nPr 0.5\n");
  ASSERT_TRUE(materials);
  std::vector<std::string> names;
  for (const MtlMaterial& m : *materials) names.push_back(m.name);
  EXPECT_THAT(names, ElementsAre("a b", "c"));
  EXPECT_FALSE((*materials)[0].diffuse);
  EXPECT_EQ((*materials)[0].line, 6);
}

/// 20,000 damaged files: each is read or refused with a line, and what is read makes a material
/// whose text a job's reader can parse.
TEST(MtlFile, DamagedOnesAreReadOrRefused) {
  const std::string good =
      "newmtl a b\nKd 0.8 0.2 0.1\nKs 0.5\nNs 250\nNi 1.45\nd 0.5\nTf 1 1 0\nillum 7\nPr 0.2\nPm "
      "1\n"
      "map_Kd -s 2 2 2 -mm 0.1 0.9 wood.png\nmap_bump -bm 0.3 b.png\nKe 1 2 3\nnewmtl c\nTr 0.1\n";
  constexpr std::string_view kBytes("\0\n -.#eE019azKmN\\/\xff\t", 21);
  uint64_t state = 1;
  const auto next = [&](size_t below) {
    state = mix64(state + 0x9E3779B97F4A7C15ULL);
    return static_cast<size_t>(state % below);
  };
  int refused = 0;
  for (int i = 0; i < 20'000; ++i) {
    std::string text = good;
    for (size_t k = 0; k <= next(4); ++k) text[next(text.size())] = kBytes[next(kBytes.size())];
    if (next(4) == 0) text.resize(next(text.size()));
    const auto materials = parse_mtl(text);
    if (!materials) {
      EXPECT_THAT(materials.error().message, testing::StartsWith("line "));
      ++refused;
      continue;
    }
    for (const MtlMaterial& material : *materials) {
      const MtlLook made = look_of(material, {}, [](const std::string&) { return "x.png"; });
      Diagnostics diagnostics;
      parse_yaml(write_yaml(*YamlMap{{"m", made.material.node()}}.node()), "m", diagnostics);
      EXPECT_TRUE(diagnostics.empty()) << diagnostics.to_string();
    }
  }
  EXPECT_GT(refused, 2'000);
  EXPECT_LT(refused, 18'000);
}

}  // namespace
}  // namespace hyades::core
