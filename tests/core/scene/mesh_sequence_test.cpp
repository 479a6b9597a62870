// Meshes with a file for each frame: which files a frame looks at, and what becomes of them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "core/job/frame_files.h"
#include "core/job/parse.h"
#include "core/job/render_key.h"
#include "core/scene/build_scene.h"
#include "core/scene/scene_files.h"
#include "tests/core/job/test_assets.h"

namespace hyades::core {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// A triangle at height `y`.
std::string triangle(int y, const std::string& faces = "f 1 2 3\n") {
  const std::string h = std::to_string(y);
  return "v 0 " + h + " 0\nv 0 " + h + " 1\nv 1 " + h + " 0\n" + faces;
}

class MeshSequences : public testing::Test {
 protected:
  MeshSequences() : records_(assets_) {}

  void add_frames(int first, int last) {
    for (int i = first; i <= last; ++i) assets_.add(name(i), triangle(i));
  }

  static std::string name(int frame) {
    return "b." + std::to_string(1000 + frame).substr(1) + ".obj";
  }

  /// Reads a job of frames 2-4 of a mesh with a file each.
  void read(const std::string& shutter, const std::string& more = "",
            const std::string& object = "") {
    Diagnostics diagnostics;
    job_ = parse_job("hyades: 1\nframes: {range: 2-4, shutter: " + shutter +
                         "}\nenvironment: {color: 1}\nobjects: {body: {mesh: b.###.obj" + object +
                         "}}\n" + more,
                     "d.yaml", records_, diagnostics);
    complaints_ = diagnostics.to_string();
  }

  std::shared_ptr<const Scene> scene_of(int32_t frame) {
    EXPECT_EQ(complaints_, "");
    auto scene = build_scene(job_, frame, cache_);
    EXPECT_TRUE(scene.ok()) << scene.error().message;
    return scene ? *scene : nullptr;
  }

  std::vector<std::string> opened() {
    std::vector<std::string> names;
    for (const AssetRecord& record : records_.records()) names.push_back(record.reference);
    return names;
  }

  MemoryAssets assets_;
  RecordingResolver records_;
  SceneCache cache_{assets_};
  Job job_;
  std::string complaints_;
};

TEST_F(MeshSequences, JobsOpenTheFilesOfTheirFrames) {
  add_frames(1, 9);
  read("0");
  EXPECT_EQ(complaints_, "");
  EXPECT_THAT(opened(), ElementsAre(name(2), name(3), name(4)));
}

TEST_F(MeshSequences, AndTheNextWhereTheShutterIsOpen) {
  add_frames(1, 9);
  read("0.5");
  EXPECT_THAT(opened(), ElementsAre(name(2), name(3), name(4), name(5)));
}

TEST_F(MeshSequences, AndTheNextForMotion) {
  add_frames(1, 9);
  read("0", "outputs: [{file: a.###.exr, layers: [motion]}]\n");
  EXPECT_THAT(opened(), ElementsAre(name(2), name(3), name(4), name(5)));
}

TEST_F(MeshSequences, MissingFramesAreNamed) {
  add_frames(2, 2);
  add_frames(4, 4);
  read("0.5");
  EXPECT_THAT(complaints_, HasSubstr("mesh of object 'body': frame 3: b.003.obj: no such file"));
}

TEST_F(MeshSequences, EachFrameShowsItsOwn) {
  add_frames(2, 4);
  read("0");
  for (int frame = 2; frame <= 4; ++frame) {
    const auto scene = scene_of(frame);
    const Shape& shape = scene->world->placement(0).shape;
    EXPECT_EQ(shape.mesh->positions[0].y, static_cast<float>(frame));
    EXPECT_FALSE(shape.deforms());
    EXPECT_TRUE(scene->world->placement(0).changes_between_frames);
  }
}

TEST_F(MeshSequences, DeformToTheNextAsFarAsTheShutterIsOpen) {
  add_frames(2, 5);
  read("0.25");
  const auto scene = scene_of(3);
  const Shape& shape = scene->world->placement(0).shape;
  ASSERT_TRUE(shape.deforms());
  EXPECT_EQ(shape.next->positions[0].y, 4.0F);
  EXPECT_EQ(shape.reach, 0.25F);
  EXPECT_NEAR(scene->world->triangle_point(0, 0, 0.3F, 0.3F, 1.0F).position.y, 3.25F, 1e-6F);
}

TEST_F(MeshSequences, TheLastStandsStill) {
  add_frames(2, 4);
  read("0.5");
  const auto scene = scene_of(4);
  EXPECT_FALSE(scene->world->placement(0).shape.deforms());
  EXPECT_TRUE(scene->warnings.empty());
}

TEST_F(MeshSequences, OtherTrianglesStandStillAndAreTold) {
  add_frames(2, 4);
  assets_.add(name(4), triangle(4, "f 1 3 2\n"));
  read("0.5");
  EXPECT_TRUE(scene_of(2)->warnings.empty());
  const auto scene = scene_of(3);
  EXPECT_FALSE(scene->world->placement(0).shape.deforms());
  EXPECT_THAT(scene->warnings,
              ElementsAre("object 'body': b.003.obj and b.004.obj have other triangles: while the "
                          "shutter is open, the mesh stands still"));
}

TEST_F(MeshSequences, DisplacedOnesStandStillAndAreTold) {
  add_frames(2, 4);
  read("0.5", "textures: {bumps: {type: fbm3d}}\n",
       ", displacement: {texture: bumps, height: 0.1, max_edge: 1}");
  const auto scene = scene_of(2);
  EXPECT_FALSE(scene->world->placement(0).shape.deforms());
  EXPECT_THAT(scene->warnings, ElementsAre(HasSubstr("displaced")));
  EXPECT_NEAR(scene->world->bounds().center().y, 2.0F, 0.2F);
  EXPECT_NEAR(scene_of(3)->world->bounds().center().y, 3.0F, 0.2F);
}

TEST_F(MeshSequences, FramesShareWhatBothLookAtAndLeaveNothingBehind) {
  add_frames(2, 5);
  read("0.5");
  auto two = scene_of(2);
  auto three = scene_of(3);
  EXPECT_EQ(two->world->placement(0).shape.next, three->world->placement(0).shape.mesh);
  const std::weak_ptr<const TriangleMesh> first = two->world->placement(0).shape.mesh;
  two.reset();
  three.reset();
  const auto four = scene_of(4);
  EXPECT_TRUE(first.expired());
}

TEST_F(MeshSequences, LoadingNamesTheFilesOfAFrame) {
  add_frames(2, 5);
  read("0.5");
  const auto files = [](const SceneFiles& of) {
    std::vector<std::string> names;
    for (const auto& mesh : of.meshes) names.push_back(mesh.file);
    return names;
  };
  EXPECT_THAT(files(files_of_scene(job_)), ElementsAre());
  EXPECT_THAT(files(files_of_scene(job_, 3)), ElementsAre(name(3), name(4)));
  EXPECT_THAT(files(files_of_job(job_)), ElementsAre(name(2), name(3), name(4), name(5)));
}

TEST_F(MeshSequences, KeysFollowTheFilesThatAFrameLooksAt) {
  add_frames(2, 5);
  read("0.5");
  const auto key_with = [&](int32_t frame, int changed) {
    auto records = records_.records();
    for (AssetRecord& record : records) {
      if (record.reference == name(changed)) record.sha256 = "other";
    }
    return render_key(job_, frame, records);
  };
  EXPECT_EQ(key_with(2, 4), key_with(2, 5));
  EXPECT_NE(key_with(2, 2), key_with(2, 4));
  EXPECT_NE(key_with(2, 3), key_with(2, 4));
  EXPECT_NE(key_with(3, 3), key_with(3, 5));
}

TEST(MeshFiles, KnowTheirNames) {
  EXPECT_TRUE(is_file_sequence("a.#.ply"));
  EXPECT_FALSE(is_file_sequence("a.1.ply"));
  JobTime time;
  time.frame = 12.0;
  EXPECT_EQ(frame_file_at("f/a.####.ply", time), "f/a.0012.ply");
  EXPECT_EQ(frame_file_at("a.ply", time), "a.ply");
  Job job;
  job.frames.first = 8;
  job.frames.last = 10;
  job.frames.step = 2;
  EXPECT_THAT(sequence_files(job, {"a.##.ply", "b.#.#.ply"}),
              testing::ElementsAre("a.08.ply", "a.10.ply", "b.10.10.ply", "b.8.8.ply"));
  job.frames.shutter = 0.5F;
  EXPECT_THAT(sequence_files(job, {"a.##.ply"}),
              testing::ElementsAre("a.08.ply", "a.09.ply", "a.10.ply", "a.11.ply"));
}

}  // namespace
}  // namespace hyades::core
