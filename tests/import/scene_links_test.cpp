#include "import/scene_links.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "core/job/parse.h"
#include "core/job/scene_document.h"
#include "import/job_files.h"
#include "import/write_scene_job.h"
#include "tests/support/temp_folder.h"

namespace hyades::core {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// A folder of secrets, and a scene beside it.
class Links : public testing::Test {
 protected:
  void SetUp() override {
    write("secrets/id.png", "a key");
    write("secrets/id.mtl", "newmtl glow\nKe 1\n");
    write("scene/here/wood.png", "a picture");
    write("scene/a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl glow\nf 1 2 3\n");
    write("scene/a.mtl", "newmtl glow\nmap_Kd tex/id.png\n");
  }
  void write(const std::string& name, const std::string& text) {
    fs::create_directories((folder_.path() / name).parent_path());
    std::ofstream(folder_.path() / name) << text;
  }
  void link(const std::string& to, const std::string& name) {
    fs::create_symlink(to, folder_.path() / name);
  }
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }

  /// What opening a scene says; empty: it is fine.
  std::string trouble(const std::string& scene, bool follow = false) const {
    JobFileOptions options;
    options.follow_links = follow;
    const auto files = JobFiles::open(path(scene), options);
    if (!files) return files.error().message;
    // Jobs name scenes; those become documents when they are opened.
    if (is_script_file(scene)) {
      const auto text = (*files)->files().open((*files)->document());
      Diagnostics diagnostics;
      parse_job({text->chars(), text->size()}, path(scene), (*files)->files(), diagnostics);
      return diagnostics.to_string();
    }
    if (is_scene_file(scene)) return {};
    const auto bytes = (*files)->files().open_document("scene/a.obj.files/scene.yaml");
    return bytes ? std::string() : bytes.error().message;
  }

  test::TempFolder folder_;
};

TEST_F(Links, OfScriptsStayInTheirFolderToo) {
  link("../secrets", "scene/tex");
  write("scene/a.lua", "return {textures = {t = {type = 'image', file = 'tex/id.png'}}}");
  EXPECT_THAT(trouble("scene/a.lua"), HasSubstr("leads out of the scene's folder, by the link"));
  EXPECT_EQ(trouble("scene/a.lua", true), "");
  write("scene/b.lua", "return {textures = {t = {type = 'image', file = 'here/wood.png'}}}");
  EXPECT_EQ(trouble("scene/b.lua"), "");
}

TEST_F(Links, ThatStayInTheScenesFolderAreFollowed) {
  link("here", "scene/tex");
  link("wood.png", "scene/here/id.png");
  EXPECT_EQ(trouble("scene/a.obj"), "");
  link("scene", "shortcut");
  EXPECT_EQ(trouble("shortcut/a.obj"), "") << "where the folder itself is reached by one";
}

TEST_F(Links, OfFilesAndFoldersThatLeadOutAreRefusedAndNamed) {
  link("../secrets", "scene/tex");
  for (const char* scene : {"scene/a.obj", "job.yaml"}) {
    const std::string said = trouble(scene);
    EXPECT_THAT(said, HasSubstr("tex/id.png: leads out of the scene's folder, by the link"));
    EXPECT_THAT(said, HasSubstr("scene/tex;"));
    EXPECT_THAT(said, HasSubstr("--follow-links"));
    EXPECT_EQ(trouble(scene, true), "");
  }
  fs::remove(folder_.path() / "scene/tex");
  fs::create_directories(folder_.path() / "scene/tex");
  link("../../secrets/id.png", "scene/tex/id.png");
  EXPECT_THAT(trouble("scene/a.obj"), HasSubstr("scene/tex/id.png;"));
}

TEST_F(Links, OfWhatImportersReadThemselvesAreRefused) {
  write("scene/a.mtl", "");
  fs::remove(folder_.path() / "scene/a.mtl");
  link("../secrets/id.mtl", "scene/a.mtl");
  EXPECT_THAT(trouble("scene/a.obj"), HasSubstr("a.mtl: leads out of the scene's folder"));
  write("scene/a.gltf",
        R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":5,"uri":"a.bin"}]})");
  link("../secrets/id.png", "scene/a.bin");
  EXPECT_THAT(trouble("scene/a.gltf"), HasSubstr("a.bin: leads out of the scene's folder"));
  write("scene/a.pbrt", "Include \"b.pbrt\"\n");
  link("../secrets/id.mtl", "scene/b.pbrt");
  EXPECT_THAT(trouble("scene/a.pbrt"), HasSubstr("b.pbrt: leads out of the scene's folder"));
}

/// A file may have the name of a scene's document, whether there is such a scene or not.
TEST_F(Links, OfFilesThatAreNamedAsDocumentsAreRefused) {
  const char* const leads_out = "leads out of the scene's folder";
  const char* const has_name = ".files: there is a folder of this name";
  write("secrets/job.yaml", "materials: {stolen: {type: mirror}}\n");
  write("scene/x.lua", "return {}");
  link("../secrets/job.yaml", "scene/x.lua,fps=0.yaml");
  write("scene/by_name.lua", "return {include = 'x.lua,fps=0.yaml'}");
  EXPECT_THAT(trouble("scene/by_name.lua"), HasSubstr(leads_out));
  SceneDocument gone;
  gone.scene = "gone.lua";
  gone.fps = 0.0F;
  link("../secrets/job.yaml", "scene/" + reference_of(gone));
  write("scene/gone.lua.files/x", "");
  write("scene/by_script.lua", "return {include = 'gone.lua'}");
  EXPECT_THAT(trouble("scene/by_script.lua"), HasSubstr(has_name));
  write("secrets/scene,prefix=o,fps=24.yaml", "materials: {o.stolen: {type: mirror}}\n");
  link("../secrets", "scene/robot.glb.files");
  write("scene/by_object.lua", "return {objects = {o = {gltf = 'robot.glb'}}}");
  EXPECT_THAT(trouble("scene/by_object.lua"), HasSubstr(has_name));
}

/// What is made of a scene is read of it, wherever it lies.
TEST_F(Links, OfScenesWhosePartsAreNamedAreRefused) {
  const char* const leads_out = ".glb: leads out of the scene's folder";
  link("../secrets/id.mtl", "scene/link1.glb");
  write("scene/a.mtl", "newmtl glow\nmap_Kd link1.glb.files/images/pic.png\n");
  EXPECT_THAT(trouble("scene/a.obj"), HasSubstr(leads_out));
  write("scene/picture.lua",
        "return {textures = {t = {type = 'image', file = 'link1.glb.files/images/pic.png'}}}");
  EXPECT_THAT(trouble("scene/picture.lua"), HasSubstr(leads_out));
  write("scene/walk.lua", "return {objects = {o = {mesh = 'link#.glb.files/meshes/a.ply'}}}");
  EXPECT_THAT(trouble("scene/walk.lua"), HasSubstr(leads_out));
}

TEST_F(Links, OfPicturesOfOtherFormatsAreRefused) {
  link("../secrets/id.png", "scene/id.png");
  write("scene/t.pbrt",
        "WorldBegin\nTexture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"id.png\"\n"
        "Material \"diffuse\" \"texture reflectance\" \"t\"\nShape \"sphere\"\n");
  EXPECT_THAT(trouble("scene/t.pbrt"), HasSubstr("id.png: leads out of the scene's folder"));
  write("scene/t.gltf", R"({"asset":{"version":"2.0"},"images":[{"uri":"id.png"}]})");
  EXPECT_THAT(trouble("scene/t.gltf"), HasSubstr("id.png: leads out of the scene's folder"));
}

TEST_F(Links, OfAnyFileOfAPatternAreRefused) {
  const SceneLinks links(folder_.path().string());
  write("scene/skin.1001.png", "x");
  EXPECT_TRUE(links.check("scene/a.obj", "scene/skin.<UDIM>.png"));
  EXPECT_TRUE(links.check("scene/a.obj", "scene/walk.####.ply"));
  link("../secrets/id.png", "scene/skin.1002.png");
  EXPECT_FALSE(links.check("scene/a.obj", "scene/skin.<UDIM>.png"));
  link("../secrets/id.png", "scene/walk.0001.ply");
  EXPECT_FALSE(links.check("scene/a.obj", "scene/walk.####.ply"));
  write("scene/tiles1/1001.png", "x");
  EXPECT_TRUE(links.check("scene/a.obj", "scene/tiles#/<UDIM>.png"));
  link("../../secrets/id.png", "scene/tiles1/1002.png");
  EXPECT_FALSE(links.check("scene/a.obj", "scene/tiles#/<UDIM>.png")) << "in a folder";
  link("../secrets", "scene/d1001");
  EXPECT_FALSE(links.check("scene/a.obj", "scene/d<UDIM>/id.png")) << "a folder";
  link("../secrets/id.png", "scene/x<UDIM>1.ply");
  EXPECT_FALSE(links.check("scene/a.obj", "scene/x<UDIM>#.ply")) << "of both kinds";
  link("../secrets/id.png", "scene/plain#.png");
  EXPECT_FALSE(links.check("scene/a.obj", "scene/plain#.png")) << "as it is written";
}

TEST_F(Links, OfAPatternThatLeadBackIntoTheFolderEnd) {
  const SceneLinks links(folder_.path().string());
  write("scene/a.png", "x");
  link(".", "scene/one");
  link(".", "scene/two");
  std::string file = "scene/";
  for (int i = 0; i < 40; ++i) file += "#/";
  const Status meant = links.check("scene/a.obj", file + "a.png");
  ASSERT_FALSE(meant);
  EXPECT_THAT(meant.error().message, HasSubstr("may mean too many files"));
  EXPECT_TRUE(links.check("scene/a.obj", "scene/a.png"));
  EXPECT_FALSE(links.check("scene/a.obj", "scene/#/a.png")) << "all patterns have so many together";
  std::string deep = "scene";
  while (deep.size() < 4000) deep += "/a";
  EXPECT_TRUE(SceneLinks(folder_.path().string()).check("scene/a.obj", deep));
  EXPECT_THAT(links.check("scene/a.obj", deep + deep).error().message,
              HasSubstr("a name of 8002 bytes, expected at most 4096"));
}

TEST_F(Links, ImportKeepsToTheSameRule) {
  link("../secrets", "scene/tex");
  WriteSceneJob request;
  request.scene = path("scene/a.obj");
  request.job = path("out/a.yaml");
  const auto refused = write_scene_job(request);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("leads out of the scene's folder"));
  request.follow_links = true;
  EXPECT_TRUE(write_scene_job(request));
}

// The job around a scene may name what it likes: a file of media beside the scene's folder.
TEST_F(Links, AreNoBusinessOfJobs) {
  const auto files = JobFiles::open(path("scene/a.obj"));
  ASSERT_TRUE(files) << files.error().message;
  EXPECT_TRUE((*files)->files().open("../secrets/id.mtl", "a.obj"));
}

TEST_F(Links, FilesThatAreNotThereAreTheirOpenersBusiness) {
  EXPECT_EQ(trouble("scene/a.obj"), "");
  link("nowhere", "scene/tex");
  EXPECT_EQ(trouble("scene/a.obj"), "");
}

TEST_F(Links, AFolderOfTheNameOfWhatIsMadeIsRefused) {
  link("here", "scene/tex");
  write("scene/a.obj.files/scene.yaml", "hyades: 1\n");
  const std::string said = trouble("job.yaml");
  EXPECT_THAT(said, HasSubstr("scene/a.obj.files: there is a folder of this name"));
  fs::remove(folder_.path() / "scene/a.obj");
  EXPECT_THAT(trouble("job.yaml"), HasSubstr("there is a folder of this name"));
  link("nowhere", "scene/a.obj");
  EXPECT_THAT(trouble("job.yaml"), HasSubstr("there is a folder of this name"));
}

/// The system opens what no name of the disk is long enough for.
TEST_F(Links, ThroughFoldersTooDeepToBeToldAreRefused) {
  const std::string step(250, 'a');
  std::string way;
  for (int i = 0; i < 12; ++i) way += "/" + step;
  fs::create_directories(path("scene" + way));
  link("." + way, "scene/L1");
  fs::create_directories(path("scene/L1" + way));
  link("L1" + way, "scene/L2");
  link(path("secrets/id.png"), "scene/L2/wood.png");
  link("L2", "scene/tex");
  write("scene/a.mtl", "newmtl glow\nmap_Kd tex/wood.png\n");
  ASSERT_TRUE(std::ifstream(path("scene/tex/wood.png")).good());
  EXPECT_THAT(trouble("scene/a.obj"), HasSubstr("lies in the scene's folder cannot be told"));
  EXPECT_EQ(trouble("scene/a.obj", true), "");
}

TEST_F(Links, InFoldersThatMayNotBeListedAreRefused) {
  write("scene/tex/x", "");
  link("../../secrets/id.png", "scene/tex/t.1001.png");
  write("scene/a.mtl", "newmtl glow\nmap_Kd tex/t.<UDIM>.png\n");
  fs::permissions(folder_.path(), fs::perms(0755));
  fs::permissions(path("scene/tex"), fs::perms(0311));
  // The administrator may list any.
  const bool root = ::geteuid() == 0;
  ASSERT_TRUE(!root || ::seteuid(65534) == 0);
  const bool reached = std::ifstream(path("scene/a.obj")).good();
  const std::string said = trouble("scene/a.obj");
  ASSERT_TRUE(!root || ::seteuid(0) == 0);
  if (!reached) GTEST_SKIP() << "nobody but the administrator gets to " << folder_.path();
  EXPECT_THAT(said, HasSubstr("lies in the scene's folder cannot be told"));
}

/// Only what is made of a script has marks that tell of scripts.
TEST_F(Links, AFileDoesNotTakeTheWordOfAScript) {
  write("b/b.lua", "return {name = 'b'}");
  write("b/secret.png", "a key");
  write("a/a.lua", "return {include = 'a2.lua,fps=0.yaml'}");
  write("a/a2.lua,fps=0.yaml",
        "#line 1 ../b/b.lua\ntextures: {t: {type: image, file: secret.png}}\n");
  const std::string text =
      "hyades: 1\ncamera: {look_from: [0, 0, 4], look_at: [0, 0, 0]}\ninclude: [a/a.lua, b/b.lua]\n"
      "materials: {m: {type: lambert, color: t}}\nobjects: {o: {shape: sphere, material: m}}\n";
  write("job.yaml", text);
  const auto files = JobFiles::open(path("job.yaml"));
  ASSERT_TRUE(files) << files.error().message;
  Diagnostics diagnostics;
  const Job job = parse_job(text, path("job.yaml"), (*files)->files(), diagnostics);
  ASSERT_EQ(job.textures.size(), 1U);
  EXPECT_THAT(diagnostics.to_string(), HasSubstr("texture 't': a/secret.png: no such file"));
  const auto* image = std::get_if<textures::Image>(&job.textures[0].kind);
  ASSERT_NE(image, nullptr);
  EXPECT_EQ(image->file, "a/secret.png");
}

}  // namespace
}  // namespace hyades::core
