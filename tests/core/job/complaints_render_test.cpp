#include <gtest/gtest.h>

#include "tests/core/job/complaints_testing.h"

// Complaints about how a job is rendered, and what is written.
namespace hyades::core {
namespace {

TEST(Complaints, OneOutputIsNoFolderOfAnother) {
  EXPECT_EQ(complaints("outputs:\n  - {file: a.exr}\n  - {file: ./a.exr/b.exr}\n"),
            "job.yaml:4:12: file is './a.exr/b.exr', which cannot stand beside 'a.exr' of line 3: "
            "one would be the other's folder\n");
  EXPECT_EQ(complaints("outputs:\n  - {file: a.exr/b.exr}\n  - {file: a.exr}\n"),
            "job.yaml:4:12: file is 'a.exr', which cannot stand beside 'a.exr/b.exr' of line 3: "
            "one would be the other's folder\n");
  EXPECT_EQ(complaints("outputs:\n  - {file: a.exr}\n  - {file: a.exr.png}\n  - {file: b/a.exr}\n"),
            "");
}

TEST(Complaints, StrategiesThatCannotBe) {
  EXPECT_EQ(
      complaints("integrator: {type: bdpt, max_depth: 2, strategy: [3, 2]}\n"),
      "job.yaml:2:50: strategy is [3, 2], which is 3 events, expected no more than max_depth, "
      "2\n");
  for (const char* strategy : {"[1, 1]", "[0, 1]", "[3, 0]"}) {
    const std::string text = std::string("integrator: {type: bdpt, strategy: ") + strategy + "}\n";
    EXPECT_EQ(complaints(text),
              std::string("job.yaml:2:36: strategy is ") + strategy +
                  ", expected [s, t]: how many vertices come from the light and from the camera, "
                  "such as [0, 2], [1, 2] or [2, 1]\n");
  }
}

TEST(Complaints, StrategiesAllUnweighted) {
  EXPECT_EQ(
      complaints("integrator: {type: bdpt, mis: false}\n"),
      "job.yaml:2:31: mis is false without a strategy, expected [s, t] in strategy too: all of "
      "them unweighted would add up to several times the picture\n");
}

TEST(Complaints, Videos) {
  EXPECT_EQ(complaints("outputs: [{file: a.avi}]\n"),
            "job.yaml:2:18: file is 'a.avi', expected the ending .exr, .png, .tif, .tiff, .jpg, "
            ".jpeg, .mp4, .mov or .webm\n");
  EXPECT_EQ(complaints("frames: {range: 1-5}\noutputs: [{file: a.####.mp4}]\n"),
            "job.yaml:3:18: file is 'a.####.mp4', expected no #: a video holds all frames\n");
  EXPECT_EQ(complaints("outputs: [{file: a.mp4, quality: 0}]\n"),
            "job.yaml:2:34: quality is '0', expected a whole number from 1 to 51\n");
  EXPECT_EQ(complaints("outputs: [{file: a.mp4, layers: [beauty]}]\n"),
            "job.yaml:2:25: unknown key 'layers' in output 1; it belongs to exr\n");
  EXPECT_EQ(complaints("outputs: [{file: a.mp4}, {file: ./a.mp4}]\n"),
            "job.yaml:2:33: file is './a.mp4', which line 2 writes already\n");
  EXPECT_EQ(complaints("outputs: [{file: a.mp4}, {file: a.mp4.frames/####.png}]\n"),
            "job.yaml:2:33: file is 'a.mp4.frames/####.png', which line 2 writes already\n");
  EXPECT_EQ(complaints("outputs: [{file: a.mp4.frames}, {file: a.mp4}]\n").substr(0, 14),
            "job.yaml:2:18:");
}

TEST(Complaints, Outputs) {
  EXPECT_EQ(complaints("frames: 1-2\noutputs: [{file: a.exr}]\n"),
            "job.yaml:3:18: file is 'a.exr', but the job has several frames: expected #### where "
            "the frame number goes\n");
  EXPECT_EQ(complaints("outputs:\n  - {file: ../a.exr}\n"),
            "job.yaml:3:12: file is '../a.exr', expected a path below the output folder (no '..', "
            "not absolute); --output chooses the folder\n");
  EXPECT_EQ(complaints("outputs:\n  - {file: a.exr}\n  - {file: .//./a.exr}\n"),
            "job.yaml:4:12: file is './/./a.exr', which line 3 writes already\n");
  EXPECT_EQ(
      complaints("outputs: [{file: a.gif}]\n"),
      "job.yaml:2:18: file is 'a.gif', expected the ending .exr, .png, .tif, .tiff, .jpg, .jpeg, "
      ".mp4, .mov or .webm\n");
  EXPECT_EQ(complaints("outputs: [{file: a.exr, layers: [beauty, normals, beauty]}]\n"),
            "job.yaml:2:42: layer is 'normals', did you mean 'normal'?\n"
            "job.yaml:2:51: layer 'beauty' is listed twice\n");
  EXPECT_EQ(complaints("outputs: [{file: " + std::string(5000, 'a') + ".exr}]\n"),
            "job.yaml:2:18: file is a name of 5004 bytes, expected at most 4096\n");
  EXPECT_EQ(
      complaints("outputs: [{file: a/b/c.exr}, {file: a/bb.exr}, {file: a/b}]\n").substr(0, 30),
      "job.yaml:2:55: file is 'a/b', ");
  EXPECT_EQ(complaints("outputs: [{file: a.exr}, {file: a.exr-2.exr}, {file: a.exr/b.exr}]\n"),
            "job.yaml:2:54: file is 'a.exr/b.exr', which cannot stand beside 'a.exr' of line 2: "
            "one would be the other's folder\n")
      << "what lies between them in order is no reason";
  EXPECT_EQ(complaints("name: b\nkeep_films: true\noutputs: [{file: ./b.film.exr}]\n"),
            "job.yaml:4:18: file is './b.film.exr', where keep_films puts the film, expected "
            "another name\n");
  EXPECT_EQ(complaints("name: b\noutputs: [{file: ./b.film.exr}]\n"), "");
}

TEST(Complaints, ANoiseToStopAt) {
  EXPECT_EQ(complaints("sampling: {samples: 512, noise: 0.02, min_samples: 64}\n"), "");
  EXPECT_EQ(complaints("sampling: {noise: -0.1}\n"),
            "job.yaml:2:19: noise is '-0.1', expected a number from 0 to 1\n");
  EXPECT_EQ(complaints("sampling: {min_samples: 64}\n"),
            "job.yaml:2:25: min_samples without a noise to stop at, expected noise too: without it "
            "every pixel gets all samples\n");
  EXPECT_EQ(
      complaints("sampling: {noise: 0.1, samples: 64, min_samples: 64}\n"),
      "job.yaml:2:19: noise cannot stop 64 samples: tiles are judged for the first time after "
      "64 (min_samples, at least 32); expected more samples\n");
  EXPECT_EQ(complaints("sampling: {noise: 0.1, min_samples: 4000}\n"), "");
  EXPECT_EQ(complaints("sampling: {noise: 0.1}\nintegrator: bdpt\n"),
            "job.yaml:2:11: sampling has a noise to stop at, which the integrator bdpt does not "
            "know: its light paths end anywhere on the film; expected path, or samples alone\n");
}

TEST(Complaints, AFilterThatHasNoRoomForSplats) {
  for (const std::string type : {"bdpt", "mlt"}) {
    EXPECT_EQ(complaints("film: {filter: center}\nintegrator: {type: " + type + "}\n"),
              "job.yaml:3:13: the integrator is " + type +
                  ", whose light paths may end anywhere on the film, but film.filter is center; "
                  "expected a filter with a radius\n");
  }
  EXPECT_EQ(complaints("film: {filter: center}\nintegrator: path\n"), "");
  EXPECT_EQ(complaints("film: {filter: box}\nintegrator: bdpt\n"), "");
}

}  // namespace
}  // namespace hyades::core
