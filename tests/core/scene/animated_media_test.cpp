#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "core/job/parse.h"
#include "core/job/render_key.h"
#include "core/media/write_vdb.h"
#include "core/scene/build_scene.h"
#include "core/scene/volume_makers.h"
#include "tests/core/job/test_assets.h"

namespace hyades::core {
namespace {

/// An image of one pixel of radiance 1.
const std::string kWhite =
    "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n" + std::string("\x80\x80\x80\x81");

class AnimatedMedia : public testing::Test {
 protected:
  AnimatedMedia() : cache_(assets_) { assets_.add("sky.hdr", kWhite); }

  void read(const std::string& media) {
    Diagnostics diagnostics;
    job_ = parse_job("hyades: 1\nframes: 1-10\nmedia: {m: {" + media +
                         "}}\nobjects: {ball: {shape: sphere, radius: 2, interior: m}}\n",
                     "job.yaml", assets_, diagnostics);
    EXPECT_EQ(diagnostics.to_string(), "");
  }

  MemoryAssets assets_;
  SceneCache cache_;
  Job job_;
};

TEST_F(AnimatedMedia, RefractMoreFromFrameToFrame) {
  read("scattering: 0.1, index: \"= 0.9 + 0.1 * frame\"");
  for (const int32_t frame : {1, 3, 6}) {
    const auto scene = build_scene(job_, frame, cache_);
    ASSERT_TRUE(scene) << scene.error().message;
    const float index = 0.9F + 0.1F * static_cast<float>(frame);
    EXPECT_FLOAT_EQ((*scene)->objects[0].material->index(), frame == 1 ? 0.0F : index);
  }
}

TEST_F(AnimatedMedia, ShellsGrow) {
  read(
      "albedo: 0.9, density: {shell: {image: sky.hdr, inner: \"= 0.1 * frame\", outer: \"= 0.2 * "
      "frame\"}}");
  const Bounds body{Vec3(-2.0F), Vec3(2.0F)};
  for (const int32_t frame : {1, 5, 10}) {
    const auto made = make_volume(job_.media[0], job_.time_of(frame), body, cache_);
    ASSERT_TRUE(made) << made.error().message;
    for (int i = 1; i < 40; ++i) {
      const float radius = 0.05F * static_cast<float>(i) + 0.02F;
      const auto f = static_cast<float>(frame);
      EXPECT_EQ(made->volume->density->at({radius, 0, 0}) > 0.0F,
                radius > 0.1F * f && radius < 0.2F * f)
          << frame << ' ' << radius;
    }
  }
}

TEST_F(AnimatedMedia, FilesOfFramesAreTheirsAndLeaveNothingBehind) {
  for (int frame = 1; frame <= 10; ++frame) {
    VdbBox box;
    box.name = "density";
    box.size = Vec3i(4);
    box.values.assign(64, static_cast<float>(frame));
    const auto bytes = write_vdb({box});
    ASSERT_TRUE(bytes) << bytes.error().message;
    const std::string name = "fire." + std::to_string(1000 + frame).substr(1) + ".vdb";
    assets_.add(name, std::string(bytes->chars(), bytes->size()));
  }
  read("absorption: 1, density: {vdb: fire.###.vdb, place: native}");
  const auto density = [&](int32_t frame, float radius) {
    const Bounds body{Vec3(-radius), Vec3(radius)};
    const auto made = make_volume(job_.media[0], job_.time_of(frame), body, cache_);
    EXPECT_TRUE(made) << made.error().message;
    return made->volume->density;
  };
  auto third = density(3, 2.0F);
  EXPECT_EQ(third->at(Vec3(1.5F)), 3.0F);
  EXPECT_EQ(density(3, 1.0F), third) << "bodies of a frame share its file";
  EXPECT_EQ(density(10, 2.0F)->at(Vec3(1.5F)), 10.0F);
  const std::weak_ptr<const DensityField> gone = third;
  third.reset();
  EXPECT_TRUE(gone.expired());
}

// Neither what happens while the shutter is open nor the layer `motion` looks at the next frame's.
TEST_F(AnimatedMedia, OnlyTheFilesOfItsFramesAreOpened) {
  for (const std::string name : {"fire.1.vdb", "fire.2.vdb", "fire.3.vdb"}) assets_.add(name, "");
  RecordingResolver records(assets_);
  Diagnostics diagnostics;
  const Job job = parse_job(
      "hyades: 1\nframes: {range: 1-2, shutter: 0.5}\n"
      "media: {m: {absorption: 1, density: {vdb: fire.#.vdb}}}\n"
      "objects: {ball: {shape: sphere, interior: m}}\noutputs: [{file: a.#.exr, layers: "
      "[motion]}]\n",
      "job.yaml", records, diagnostics);
  EXPECT_EQ(diagnostics.to_string(), "");
  ASSERT_EQ(records.records().size(), 2U);
  auto changed = records.records();
  changed[1].sha256 = "other";
  EXPECT_EQ(render_key(job, 1, changed), render_key(job, 1, records.records()));
  EXPECT_NE(render_key(job, 2, changed), render_key(job, 2, records.records()));
}

TEST_F(AnimatedMedia, FilesOfFramesThatAreMissingAreNamed) {
  assets_.add("fire.1.vdb", "");
  Diagnostics diagnostics;
  parse_job(
      "hyades: 1\nframes: 1-10\nmedia: {m: {absorption: 1, density: {vdb: fire.#.vdb}}}\n"
      "objects: {ball: {shape: sphere, interior: m}}\n",
      "job.yaml", assets_, diagnostics);
  EXPECT_NE(diagnostics.to_string().find("frame 2: fire.2.vdb: no such file"), std::string::npos)
      << diagnostics.to_string();
}

TEST_F(AnimatedMedia, ShellsThatTurnInsideOutAreRefused) {
  read("albedo: 0.9, density: {shell: {image: sky.hdr, inner: \"= 0.1 * frame\", outer: 0.5}}");
  EXPECT_TRUE(build_scene(job_, 4, cache_));
  const auto scene = build_scene(job_, 5, cache_);
  ASSERT_FALSE(scene);
  EXPECT_NE(scene.error().message.find("inner radius of 0.5 at this frame"), std::string::npos)
      << scene.error().message;
}

}  // namespace
}  // namespace hyades::core
