#include "import/importing_resolver.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "core/image/read_image.h"
#include "core/job/parse.h"
#include "core/job/scene_document.h"
#include "import/job_files.h"
#include "import/names.h"
#include "import/write_scene_job.h"
#include "tests/support/temp_folder.h"

namespace hyades::core {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr const char* kQuads =
    "mtllib looks/all.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\n"
    "usemtl red paint\nf 1 2 3 4\nusemtl glow\nf 1 2 5\n";

class Importing : public testing::Test {
 protected:
  Importing() {
    write("quads.obj", kQuads);
    write("looks/all.mtl",
          "newmtl red paint\nKd 0.7 0.1 0.05\nmap_Kd ../pic/wood.png\nnewmtl glow\nKe 5 5 5\n");
  }

  std::string path(const std::string& name) const { return folder_.file(name); }

  void write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories(std::filesystem::path(path(name)).parent_path());
    std::ofstream(path(name), std::ios::binary) << text;
  }

  static std::string text_of(AssetResolver& files, const std::string& reference) {
    const auto bytes = files.open(reference);
    return bytes ? std::string(bytes->chars(), bytes->size()) : "ERROR " + bytes.error().message;
  }

  static std::string document_of(AssetResolver& files, const std::string& reference) {
    const auto bytes = files.open_document(reference);
    return bytes ? std::string(bytes->chars(), bytes->size()) : "ERROR " + bytes.error().message;
  }

  test::TempFolder folder_;
};

TEST_F(Importing, ASceneIsADocumentInAFolderBesideIt) {
  const auto disk = make_file_resolver(folder_.path().string());
  ImportingResolver files(*disk);
  const std::string name = reference_of({"quads.obj", "q", 24.0F, ""});
  // A picture of that name makes none.
  EXPECT_THAT(text_of(files, name), HasSubstr("ERROR quads.obj: 'scene,prefix=q,fps=24.yaml'"));
  EXPECT_FALSE(files.exists(name));
  const std::string text = document_of(files, name);
  EXPECT_EQ(text_of(files, name), text) << "now it is there";
  EXPECT_THAT(
      text, HasSubstr("q.red paint: {mesh: ../quads.obj, part: red paint, material: q.red paint}"))
      << text;
  EXPECT_THAT(text, HasSubstr("file: ../pic/wood.png"));
  EXPECT_TRUE(files.exists(name));
  EXPECT_FALSE(files.exists("gone.obj.files/scene.yaml"));
  EXPECT_THAT(document_of(files, "gone.obj.files/scene.yaml"),
              HasSubstr("ERROR gone.obj: no such file"));
  EXPECT_THAT(text_of(files, "quads.obj.files/meshes/x.ply"),
              HasSubstr("ERROR quads.obj: 'meshes/x.ply'"));
}

TEST_F(Importing, MagentaStandsInForMissingPicturesOnlyWhereAsked) {
  const auto disk = make_file_resolver(folder_.path().string());
  ImportingResolver strict(*disk);
  EXPECT_FALSE(strict.open("pic/wood.png"));
  ImportingResolver lenient(*disk, MissingTextures::magenta);
  const auto bytes = lenient.open("pic/wood.png");
  ASSERT_TRUE(bytes);
  const auto image = read_image(*bytes, "stand-in", ColorSpace::automatic);
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_EQ(image->width, 1);
  EXPECT_FALSE(lenient.open("mesh.ply"));
  EXPECT_THAT(lenient.notes(),
              ElementsAre("pic/wood.png: no such picture; magenta stands in for it"));
  write("pic/wood.png", "not a picture");
  EXPECT_EQ(text_of(lenient, "pic/wood.png"), "not a picture") << "what is broken is not missing";
}

/// One who renders, one who checks, one who submits: all see a scene through this.
TEST_F(Importing, AnySceneIsAJob) {
  write("pic/wood.png", "x");
  const auto files = JobFiles::open(path("quads.obj"));
  ASSERT_TRUE(files) << files.error().message;
  RecordingResolver assets((*files)->files());
  Diagnostics diagnostics;
  const std::string text = text_of((*files)->files(), (*files)->document());
  const Job job = parse_job(text, "quads.obj", assets, diagnostics);
  EXPECT_EQ(diagnostics.to_string(), "") << text;
  EXPECT_EQ(job.name, "quads");
  ASSERT_EQ(job.objects.size(), 3U);
  EXPECT_EQ(job.objects[2].name, "ground");
  EXPECT_TRUE(job.objects[1].emit) << "it shines, and needs no other light";
  EXPECT_TRUE(job.environment);
  std::vector<std::string> names;
  for (const AssetRecord& asset : assets.records()) names.push_back(asset.reference);
  EXPECT_THAT(names, ElementsAre("pic/wood.png", "quads.obj"));
  EXPECT_THAT((*files)->notes(), ElementsAre(HasSubstr("it has no lamps")));
}

TEST_F(Importing, StreamsFilesOfTheDiskAndThoseThatAreMade) {
  const auto files = JobFiles::open(path("quads.obj"), {{}, MissingTextures::magenta, {}});
  ASSERT_TRUE(files);
  const auto all = [](std::istream& in) {
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  EXPECT_EQ(all(*(*files)->stream("quads.obj")), kQuads);
  const auto made = (*files)->stream("quads.obj.yaml");
  EXPECT_THAT(all(*made), testing::StartsWith("hyades: 1\nname: quads\n"));
  made->clear();
  made->seekg(8);
  EXPECT_THAT(all(*made), testing::StartsWith("1\nname"));
  EXPECT_TRUE((*files)->stream("pic/wood.png")->good());
  EXPECT_FALSE((*files)->stream("gone.ply")->good());
}

TEST_F(Importing, WhatAMaterialNamesStaysWithinTheFolder) {
  for (const char* out : {"../../secret.png", "/etc/secret.png", "a/../../../x.png"}) {
    write("looks/all.mtl", std::string("newmtl glow\nmap_Kd ") + out + "\n");
    const auto files = JobFiles::open(path("quads.obj"));
    ASSERT_FALSE(files) << out;
    EXPECT_THAT(files.error().message, HasSubstr("expected a file in the scene's folder"));
    EXPECT_THAT(files.error().message, HasSubstr("looks/all.mtl: material 'glow'"));
  }
}

TEST_F(Importing, IsWrittenAsAJobToBeEdited) {
  write("pic/wood.png", "x");
  WriteSceneJob request;
  request.scene = path("quads.obj");
  request.job = path("jobs/new/q.yaml");
  const auto written = write_scene_job(request);
  ASSERT_TRUE(written) << written.error().message;
  EXPECT_EQ(written->files.size(), 3U);
  EXPECT_EQ(written->files.back(), path("jobs/new/q.yaml"));
  const auto files = JobFiles::open(path("jobs/new/q.yaml"));
  ASSERT_TRUE(files);
  Diagnostics diagnostics;
  const std::string text = text_of((*files)->files(), "q.yaml");
  const Job job = parse_job(text, path("jobs/new/q.yaml"), (*files)->files(), diagnostics);
  EXPECT_EQ(diagnostics.to_string(), "") << text;
  EXPECT_THAT(text, testing::StartsWith(
                        "# quads.obj, as 'hyades import' tells it.\n"
                        "# Not of the scene, which has none: camera, objects.ground, environment\n"
                        "# ../../quads.obj: it has no lamps; what its surfaces emit, "));
  EXPECT_EQ(job.objects.at(0).mesh, "q_files/red_paint.ply");
  EXPECT_EQ(job.objects.at(0).part, "");
  EXPECT_THAT(text, HasSubstr("file: ../../pic/wood.png"));

  const auto again = write_scene_job(request);
  ASSERT_FALSE(again);
  EXPECT_THAT(again.error().message, HasSubstr("q.yaml: is there already"));
  request.overwrite = true;
  EXPECT_TRUE(write_scene_job(request));
}

TEST_F(Importing, NamesOfWhatImportMakesAreBounded) {
  // A hundred thousand names of 3,000 letters each.
  const auto refusal = [&](const std::string& letters) {
    std::ofstream(path("long.lua"))
        << "local p = places({{at = {0, 0, 0}}})\n"
           "local long = p:match('^(.*/)') .. string.rep('a', "
        << letters
        << ") .. '#######'\n"
           "return {frames = {range = '1-100000'}, name = long, environment = {color = 1}}";
    WriteSceneJob request;
    request.scene = path("long.lua");
    request.job = path("long.yaml");
    const auto written = write_scene_job(request);
    return written ? std::string() : written.error().message;
  };
  EXPECT_THAT(refusal("3000"), HasSubstr("files whose names have more than 64 MiB"));
  EXPECT_THAT(refusal("60000"), Not(IsEmpty())) << "no file has such a name";
}

// A fire is light enough: no lamp and no sky are put beside it.
TEST_F(Importing, MediaThatGlowAreLight) {
  const auto text_with = [&](const std::string& le) {
    write(
        "fire.pbrt",
        "Camera \"perspective\" WorldBegin MakeNamedMedium \"m\" \"string type\" \"homogeneous\" " +
            le + " Material \"interface\" MediumInterface \"m\" \"\" Shape \"sphere\"");
    const auto files = JobFiles::open(path("fire.pbrt"));
    return files ? text_of((*files)->files(), (*files)->document()) : files.error().message;
  };
  EXPECT_THAT(text_with(""), HasSubstr("environment: {"));
  const std::string glowing = text_with("\"rgb Le\" [3 2 1]");
  EXPECT_THAT(glowing, HasSubstr("emission: "));
  EXPECT_THAT(glowing, testing::Not(HasSubstr("environment")));
}

// A label that emits as much as white paper shows does not light a scene; a lamp does. In pbrt's
// scenes whoever wrote them has thought of all light.
TEST_F(Importing, LabelsThatEmitAreNoLamps) {
  const auto job = [&](const std::string& file) {
    const auto files = JobFiles::open(path(file));
    return files ? text_of((*files)->files(), (*files)->document()) : files.error().message;
  };
  write("s.obj", "mtllib s.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  write("s.mtl", "newmtl m\nKe 1 0.5 1\n");
  EXPECT_THAT(job("s.obj"), testing::AllOf(HasSubstr("emi"), HasSubstr("key:")));
  write("s.mtl", "newmtl m\nKe 17 12 4\n");
  EXPECT_THAT(job("s.obj"), testing::Not(HasSubstr("key:")));
  const auto lamp = JobFiles::open(path("s.obj"));
  ASSERT_TRUE(lamp);
  EXPECT_THAT((*lamp)->notes(),
              ElementsAre(HasSubstr("s.obj: it has no lamps; what its surfaces")));
  write("s.pbrt",
        "Camera \"perspective\" WorldBegin AreaLightSource \"diffuse\" \"rgb L\" [0.5 0.5 0.5] "
        "Shape \"sphere\"");
  EXPECT_THAT(job("s.pbrt"), testing::AllOf(HasSubstr("emit:"), testing::Not(HasSubstr("key:"))));
}

// A picture that is missing may be stood in for, a mesh may not.
TEST_F(Importing, AFileThatAPbrtLacksIsToldWithItsPlace) {
  const auto error = [&](const std::string& world, MissingTextures missing) {
    write("s.pbrt", "Camera \"perspective\" WorldBegin\n" + world);
    JobFileOptions options;
    options.missing = missing;
    const auto files = JobFiles::open(path("s.pbrt"), options);
    if (!files) return files.error().message;
    const std::string text = text_of((*files)->files(), (*files)->document());
    return text.starts_with("ERROR ") ? text : std::string("none");
  };
  const std::string mesh = "\n  Shape \"plymesh\" \"string filename\" \"gone.ply\"";
  const std::string picture =
      "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"gone.png\"\n"
      "Material \"diffuse\" \"texture reflectance\" \"t\" Shape \"sphere\"";
  for (const auto missing : {MissingTextures::refused, MissingTextures::magenta}) {
    EXPECT_THAT(error(mesh, missing), HasSubstr("s.pbrt:3:3: gone.ply: no such file"));
  }
  EXPECT_THAT(error(picture, MissingTextures::refused),
              testing::AllOf(HasSubstr("s.pbrt:2:1: gone.png: no such file"),
                             HasSubstr("; --missing-textures lets magenta")));
  EXPECT_EQ(error(picture, MissingTextures::magenta), "none");
}

}  // namespace
}  // namespace hyades::core
