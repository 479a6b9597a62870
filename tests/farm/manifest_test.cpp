#include "farm/manifest_resolver.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "core/job/layers.h"
#include "core/job/render_key.h"
#include "core/render/render_frame.h"
#include "core/scene/build_scene.h"
#include "farm/job_package.h"
#include "import/job_files.h"
#include "tests/farm/content_testing.h"
#include "tests/support/temp_folder.h"

namespace hyades::farm {
namespace {

namespace fs = std::filesystem;
using core::AssetRecord;
using test::TempFolder;

constexpr const char* kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

/// A job whose files lie above it, at an absolute path and behind a link.
std::string write_scattered_job(const TempFolder& folder) {
  fs::create_directories(folder.file("jobs/parts"));
  fs::create_directories(folder.file("elsewhere"));
  std::ofstream(folder.file("elsewhere/up.obj")) << kTriangle;
  std::ofstream(folder.file("elsewhere/absolute.obj")) << kTriangle << "v 0 0 1\nf 1 2 4\n";
  std::ofstream(folder.file("elsewhere/linked.obj")) << kTriangle << "f 1 3 2\n";
  fs::create_symlink("../elsewhere/linked.obj", folder.file("jobs/link.obj"));
  std::ofstream(folder.file("jobs/parts/look.yaml"))
      << "materials: {red: {type: lambert, color: [0.8, 0.1, 0.1]}}\n";
  std::ofstream(folder.file("jobs/job.yaml"))
      << "hyades: 1\ninclude: parts/look.yaml\nframes: {range: 1-3}\nfilm: {size: [24, 16]}\n"
         "sampling: {samples: 16}\nenvironment: {color: 1}\nobjects:\n"
         "  a: {mesh: ../elsewhere/up.obj, material: red}\n"
         "  b: {mesh: "
      << folder.file("elsewhere/absolute.obj")
      << ", at: [-1, 0, 0]}\n"
         "  c: {mesh: ./link.obj, at: [0, -1, 0], transform: [{rotate_y: \"= 20 * frame\"}]}\n";
  return folder.file("jobs/job.yaml");
}

/// What a client uploads.
void upload(const JobPackage& package, core::JobFiles& door, ContentStore& store) {
  for (const AssetRecord& file : package.files) {
    const auto bytes = door.files().open(file.reference);
    ASSERT_TRUE(bytes) << error_of(bytes);
    EXPECT_EQ(put(store, {bytes->chars(), bytes->size()}), file.sha256);
  }
}

struct Rendered {
  std::string key;
  std::string digest;
};

/// The render key and bits of `frame`, of `samples` samples, of the job in `document` of `files`.
Rendered render(const std::string& document, core::AssetResolver& files, int32_t frame,
                uint32_t samples) {
  auto read = read_job(document, document, files);
  EXPECT_TRUE(read) << error_of(read);
  if (!read) return {};
  core::PixelRect window = core::render_window(read->job.film);
  window.x1 = std::min(window.x1, window.x0 + 32);
  window.y1 = std::min(window.y1, window.y0 + 32);
  read->job.film.crop = window;
  core::SceneCache cache(files);
  const auto scene = core::build_scene(read->job, frame, cache);
  EXPECT_TRUE(scene) << error_of(scene);
  if (!scene) return {};
  const core::FrameRenderer renderer(*scene, read->job, frame, core::needed_layers(read->job));
  return {core::render_key(read->job, frame, read->assets),
          core::render_frame(renderer, window, samples, frame).film.digest()};
}

/// A job on the disk, and the door to its files.
struct Packed {
  std::unique_ptr<core::JobFiles> door;
  core::Result<JobPackage> package;
};

Packed pack(const std::string& path) {
  auto door = core::JobFiles::open(path);
  if (!door) return {nullptr, door.error()};
  auto package = package_job((*door)->document(), path, (*door)->files());
  return {std::move(*door), std::move(package)};
}

TEST(Manifest, NamesWhatAnyFrameNeeds) {
  const TempFolder folder;
  const auto package = pack(write_scattered_job(folder)).package;
  ASSERT_TRUE(package) << error_of(package);
  std::vector<std::string> names;
  for (const AssetRecord& file : package->files) names.push_back(file.reference);
  EXPECT_EQ(names, (std::vector<std::string>{"job.yaml", "parts/look.yaml", "../elsewhere/up.obj",
                                             folder.file("elsewhere/absolute.obj"), "link.obj"}));
  EXPECT_EQ(package->document, "job.yaml");
  EXPECT_EQ(package->files[2].sha256, name_of(kTriangle));
}

/// The resolver must not find by path what it has by content: the files are gone when it is asked.
TEST(Manifest, RendersTheSameBitsWithoutTheFiles) {
  const TempFolder folder;
  const auto [door, package] = pack(write_scattered_job(folder));
  ASSERT_TRUE(package) << error_of(package);
  const auto store = open_store(folder.file("store"));
  upload(*package, *door, *store);
  const Rendered truth = render("job.yaml", door->files(), 2, 16);
  fs::remove_all(folder.file("jobs"));
  fs::remove_all(folder.file("elsewhere"));
  ManifestResolver manifest(package->files, *store);
  const Rendered copy = render("job.yaml", manifest, 2, 16);
  EXPECT_EQ(copy.key, truth.key);
  EXPECT_EQ(copy.digest, truth.digest);
  EXPECT_NE(truth.digest, "");
}

/// Every job of the gallery loads from its manifest alone: a loader that opens files which the dry
/// run does not see would fail here.
TEST(Manifest, HoldsTheWholeGallery) {
  int jobs = 0;
  for (const auto& entry : fs::recursive_directory_iterator("jobs")) {
    if (entry.path().filename() != "job.yaml") continue;
    const auto [door, package] = pack(entry.path().string());
    ASSERT_TRUE(package) << error_of(package);
    const TempFolder folder;
    const auto store = open_store(folder.file("store"));
    upload(*package, *door, *store);
    ManifestResolver manifest(package->files, *store);
    const int32_t frame = package->job.frames.first;
    const Rendered truth = render("job.yaml", door->files(), frame, 4);
    const Rendered copy = render("job.yaml", manifest, frame, 4);
    EXPECT_EQ(copy.key, truth.key) << entry.path();
    EXPECT_EQ(copy.digest, truth.digest) << entry.path();
    ++jobs;
  }
  EXPECT_GE(jobs, 5);
}

TEST(Manifest, OpensNothingElse) {
  const TempFolder folder;
  const auto store = open_store(folder.file("store"));
  std::ofstream(folder.file("secret")) << "secret";
  const std::string good = put(*store, "good");
  ManifestResolver manifest(
      {{"a/b.obj", good, 4}, {"/etc/passwd", good, 4}, {"short.obj", good, 5}}, *store);
  EXPECT_TRUE(manifest.open("a/b.obj"));
  EXPECT_TRUE(manifest.open("b.obj", "a/c.mtl"));
  const auto passwd = manifest.open("/etc/passwd");  // a name like any other
  ASSERT_TRUE(passwd);
  EXPECT_EQ(std::string(passwd->chars(), passwd->size()), "good");
  for (const std::string& name : {std::string(), folder.file("secret"), std::string("b.obj"),
                                  std::string("/etc/hostname"), good}) {
    EXPECT_FALSE(manifest.open(name)) << name;
  }
  EXPECT_NE(error_of(manifest.open("gone.png")).find("gone.png: not among the files"),
            std::string::npos);
  EXPECT_NE(error_of(manifest.open("short.obj")).find("4 bytes"), std::string::npos);
  EXPECT_TRUE(store->remove(good));
  EXPECT_NE(error_of(manifest.open("a/b.obj")).find("a/b.obj"), std::string::npos);
}

TEST(Manifest, ComplaintsNameTheDocumentAsItWasGiven) {
  const TempFolder folder;
  std::ofstream(folder.file("bad.yaml")) << "hyades: 1\nobjects: {a: {mesh: gone.obj}}\n";
  const std::string message = error_of(pack(folder.file("bad.yaml")).package);
  EXPECT_NE(message.find(folder.file("bad.yaml") + ":2:"), std::string::npos) << message;
  EXPECT_NE(message.find("gone.obj: no such file"), std::string::npos) << message;
  EXPECT_NE(error_of(pack(folder.file("none.yaml")).package).find("no such file"),
            std::string::npos);
}

}  // namespace
}  // namespace hyades::farm
