#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/core/job/complaints_testing.h"

// Complaints about keys, values and expressions anywhere in a job.
namespace hyades::core {
namespace {

TEST(Complaints, UnknownKeysSuggestTheNearestOne) {
  EXPECT_EQ(complaints("camera: {look_form: [0, 0, 1]}\n"),
            "job.yaml:2:10: unknown key 'look_form' in camera, did you mean 'look_from'?\n");
  EXPECT_EQ(complaints("flim: {size: [2, 2]}\n"),
            "job.yaml:2:1: unknown key 'flim' in the job, did you mean 'film'?\n");
  EXPECT_EQ(complaints("sampling: {quality: 7}\n"),
            "job.yaml:2:12: unknown key 'quality' in sampling; expected min_samples, noise, "
            "sampler, samples or seed\n");
}

TEST(Complaints, WordsOfOtherRenderersAreKnown) {
  const auto says = [](const std::string& job, const std::string& hint) {
    EXPECT_THAT(complaints(job), testing::HasSubstr(hint)) << job;
  };
  says("materials: {m: {type: metal}}\n", "or black, did you mean 'conductor'?");
  says("environment: {file: sky.exr}\n", "'file' in environment, did you mean 'image'?");
  says("environment: {texture: sky.exr}\n", "'texture' in environment, did you mean 'image'?");
  says("sampling: {integrator: bdpt}\n", "it is the job's own: 'integrator: path' beside");
  says("materials: {m: {type: principled, color: 1}}\n", ", did you mean 'base_color'?");
  says("materials: {m: {type: principled, metal: 1}}\n", ", did you mean 'metallic'?");
  says("materials: {m: {type: principled, rough: 1}}\n", ", did you mean 'roughness'?");
  says("objects: {a: {shape: rect}}\n", ", did you mean 'rectangle'?");
  says("objects: {a: {shape: sphere, r: 2}}\n", ", did you mean 'radius'?");
  says("objects: {a: {shape: box, material: {type: lambert}}}\n",
       "material is a map, expected a material's name, which stands in 'materials'");
  says("bounces: 3\n", "did you mean 'integrator: {max_depth: N}'?");
  says("sampling: {bounces: 3}\n", "; how deep paths go is the integrator's 'max_depth'");
  says("seed: 3\n", "did you mean 'sampling: {seed: N}'?");
  says("size: [3, 3]\n", "did you mean 'film: {size: [WIDTH, HEIGHT]}'?");
  says("outputs: [{file: a.exr, layers: [Z]}]\n", "layer is 'Z', did you mean 'depth'?");
  says("objects: {a: {shape: sphere, transform: [{rotate: [0, 90, 0]}]}}\n",
       "rotate is a list, expected {axis: [x, y, z], angle: degrees}; turns about x, y and z are "
       "steps of their own: {rotate_y: 90}");
  says("objects: {a: {shape: cube}}\n", "or cylinder, did you mean 'box'?");
  says("objects: {a: {shape: box, position: 1}}\n", ", did you mean 'at'?");
  says("lights: {a: {type: area}}\n", "or sun; a lamp with an area is an object with 'emit'");
  says("samples: 16\n", "in the job, did you mean 'sampling: {samples: N}'?");
  says("resolution: [3, 3]\n", "in the job, did you mean 'film: {size: [WIDTH, HEIGHT]}'?");
  says("textures: {t: {type: voronoi}}\n", ", did you mean 'cellular'?");
  says("frames: {range: 5-1}\n", "range is '5-1', expected the first frame first: 1-5");
  says("frames: 20-2x3\n", "expected the first frame first: 2-20x3");
  says("frames: 5-\n", "expected a frame or range such as 7");
}

TEST(Complaints, KeysOfAnotherTypeSayWhereTheyBelong) {
  EXPECT_EQ(complaints("materials:\n  red: {type: lambert, reflection: 0.5}\n"),
            "job.yaml:3:24: unknown key 'reflection' in material 'red'; it belongs to conductor, "
            "dielectric or thin-dielectric\n");
  EXPECT_EQ(complaints("objects:\n  a: {shape: box, radius: 2}\n"),
            "job.yaml:3:19: unknown key 'radius' in object 'a'; it belongs to cylinder, disk or "
            "sphere\n");
  EXPECT_EQ(complaints("outputs:\n  - {file: a.png, layers: [alpha]}\n"),
            "job.yaml:3:19: unknown key 'layers' in output 1; it belongs to exr\n");
}

TEST(Complaints, WrongTypesSayWhatWasFoundAndExpected) {
  EXPECT_EQ(complaints("camera: {fov: wide}\n"),
            "job.yaml:2:15: fov is 'wide', expected a number above 0 and below 180\n");
  EXPECT_EQ(complaints("camera: {fov: \"35\"}\n"),
            "job.yaml:2:15: fov is the text \"35\", expected a number above 0 and below 180 "
            "(without quotes)\n");
  EXPECT_EQ(complaints("camera: {fov: 30 * t}\n"),
            "job.yaml:2:15: fov is '30 * t', expected a number above 0 and below 180 (an "
            "expression begins with '=')\n");
  EXPECT_EQ(
      complaints("objects: {a: {shape: sphere, radius: 10cm}}\n"),
      "job.yaml:2:38: radius is '10cm', expected a number above 0 (without a unit: 'units' of "
      "the job is that of lengths)\n");
  EXPECT_EQ(complaints("camera: {fov: 35 °}\n"),
            "job.yaml:2:15: fov is '35 °', expected a number above 0 and below 180 (without a "
            "unit: angles are in degrees)\n");
  EXPECT_EQ(complaints("camera: {look_at: [0, 1]}\n"),
            "job.yaml:2:19: look_at is a list of 2, expected [x, y, z] (each a number or an "
            "expression)\n");
  EXPECT_EQ(complaints("camera: {look_at: [0, up, 1]}\n"),
            "job.yaml:2:23: look_at[1] is 'up', expected a number\n");
  EXPECT_EQ(complaints("camera: 35\n"),
            "job.yaml:2:9: camera is '35', expected a map of keys and values\n");
  EXPECT_EQ(complaints("objects: [a, b]\n"),
            "job.yaml:2:10: objects is a list of 2, expected a map of names, such as {name: "
            "{...}}\n");
  EXPECT_EQ(complaints("environment: {visible_to_camera: yes}\n"),
            "job.yaml:2:34: visible_to_camera is 'yes', expected true or false\n");
  EXPECT_EQ(complaints("sampling: {samples: 2.5}\n"),
            "job.yaml:2:21: samples is '2.5', expected a whole number from 1 to 16777216\n");
  EXPECT_EQ(complaints("film: {size: 640}\n"),
            "job.yaml:2:14: size is '640', expected a list of 2 whole numbers\n");
}

TEST(Complaints, NumbersOutOfRange) {
  EXPECT_EQ(complaints("sampling: {samples: 0}\n"),
            "job.yaml:2:21: samples is '0', expected a whole number from 1 to 16777216\n");
  EXPECT_EQ(complaints("sampling: {samples: 99999999999999999999}\n"),
            "job.yaml:2:21: samples is '99999999999999999999', expected a whole number from 1 to "
            "16777216\n");
  EXPECT_EQ(complaints("camera: {fov: 180}\n"),
            "job.yaml:2:15: fov is '180', expected a number above 0 and below 180\n");
  EXPECT_EQ(complaints("camera: {fov: .nan}\n"),
            "job.yaml:2:15: fov is '.nan', expected a number above 0 and below 180\n");
  EXPECT_EQ(complaints("camera: {look_at: [.inf, 1e300, nan]}\n"),
            "job.yaml:2:20: look_at[0] is '.inf', expected a number\n"
            "job.yaml:2:26: look_at[1] is '1e300', expected a number, no larger than 1e18\n"
            "job.yaml:2:33: look_at[2] is 'nan', expected a number\n");
  EXPECT_EQ(complaints("film: {size: [70000, 10]}\n"),
            "job.yaml:2:15: size[0] is '70000', expected a whole number from 1 to 65536\n");
  EXPECT_EQ(complaints("film: {size: [65536, 65536]}\n"),
            "job.yaml:2:14: a film of 4294967296 pixels, expected at most 268435456\n");
  EXPECT_EQ(complaints("film: {size: [10, 10], crop: [2, 2, 11, 4]}\n"),
            "job.yaml:2:30: crop is [2, 2, 11, 4], expected [x0, y0, x1, y1] with x0 < x1 and y0 "
            "< y1 inside the film of 10 x 10\n");
  EXPECT_EQ(complaints("frames: {range: 9-3}\n"),
            "job.yaml:2:17: range is '9-3', expected the first frame first: 3-9\n");
  // Above 0 as a double, but not as the float that it becomes.
  EXPECT_EQ(complaints("objects: {a: {shape: sphere, radius: 1e-60}}\n"),
            "job.yaml:2:38: radius is '1e-60', expected a number above 0\n");
}

TEST(Complaints, Colors) {
  EXPECT_EQ(complaints("materials: {a: {type: lambert, color: [1.2, 0, 0]}}\n"),
            "job.yaml:2:40: color[0] is '1.2', expected a number from 0 to 1\n");
  EXPECT_EQ(complaints("materials: {a: {type: mirror, color: 3200K}}\n"),
            "job.yaml:2:38: color is '3200K', whose linear red is 1.663, expected a number from 0 "
            "to 1 per channel\n");
  EXPECT_EQ(complaints("materials: {a: {type: lambert, color: \"#12345\"}}\n"),
            "job.yaml:2:39: color is the text \"#12345\", expected a colour: a number from 0 to 1, "
            "[r, g, b], \"#rrggbb\" or 3200K\n");
  EXPECT_EQ(complaints("environment: {color: red}\n"),
            "job.yaml:2:22: color is 'red', expected a colour: a number >= 0, [r, g, b], "
            "\"#rrggbb\" or 3200K\n");
  EXPECT_EQ(complaints("environment: {color: 20K}\n"),
            "job.yaml:2:22: color is '20K', expected a black body from 500K to 100000K\n");
}

TEST(Complaints, KeysThatAreNoTextHideNoOtherComplaint) {
  EXPECT_EQ(
      complaints("film: {size: 640}\nobjects:\n  ~: {shape: sphere}\n  [1, 2]: {shape: sphere}\n"
                 "  a: &name {shape: cube}\n  *name : 3\n  <<: 2\n"),
      "job.yaml:2:14: size is '640', expected a list of 2 whole numbers\n"
      "job.yaml:4:3: an empty key; keys are plain text\n"
      "job.yaml:5:3: a list or map as a key; keys are plain text\n"
      "job.yaml:6:20: shape is 'cube', expected sphere, rectangle, disk, box or cylinder, did you "
      "mean 'box'?\n"
      "job.yaml:7:3: an alias as a key; keys are plain text\n"
      "job.yaml:8:3: '<<' is not supported; use `like: name` to copy another entry's keys\n");
}

TEST(Complaints, AreWordedForTheirSubject) {
  EXPECT_EQ(complaints("objects: {'#': {shape: sphere}}\n"),
            "job.yaml:2:11: '#' cannot be the name of an object: expected letters, digits, '_', "
            "'-', '.' and inner spaces, at most 100\n");
  EXPECT_EQ(complaints("objects: {a: {shape: sphere, at: {keys: {}}}}\n"),
            "job.yaml:2:41: keys of at is an empty map, expected a map of frame numbers to values, "
            "such as {1: 0, 120: 1}\n");
  EXPECT_EQ(complaints("film:\n"), "job.yaml:2:1: film is empty, expected a value\n");
  EXPECT_EQ(complaints("materials:\n  a: {type: null, bump: {texture: t}}\n").find("surfaces"),
            std::string::npos);
  EXPECT_EQ(complaints("objects: {a: {mesh: \"a\\nb.obj\"}}\n"),
            "job.yaml:2:21: mesh is the text \"a b.obj\", expected a file name on one line\n");
}

TEST(Complaints, AnUnquotedColorIsAYamlComment) {
  EXPECT_EQ(complaints("materials:\n  a:\n    type: lambert\n    color: #d8c8a8\n"),
            "job.yaml:5:5: color is empty, expected a value (a colour such as \"#d8c8a8\" needs "
            "its quotes: an unquoted # starts a comment)\n");
  EXPECT_EQ(complaints("materials:\n  a: {type: lambert, color: #d8c8a8}\n"),
            "job.yaml:4:1: not valid YAML: end of map flow not found (line 3 has an unquoted "
            "#d8c8a8: # starts a comment there; write \"#d8c8a8\")\n");
}

TEST(Complaints, TypesAndChoicesListWhatThereIs) {
  EXPECT_EQ(
      complaints("materials: {a: {type: lambart}}\n"),
      "job.yaml:2:23: type is 'lambart', expected lambert, principled, "
      "dielectric, thin-dielectric, conductor, glossy, mirror, diffuse-transmission, mix, coat, "
      "sheen, two-sided, hair, null or black, did you mean 'lambert'?\n");
  EXPECT_EQ(
      complaints("materials: {a: {color: 0.5}}\n"),
      "job.yaml:2:16: material 'a' has no 'type', expected one of lambert, principled, dielectric, "
      "thin-dielectric, conductor, glossy, mirror, diffuse-transmission, mix, coat, sheen, "
      "two-sided, hair, null or black\n");
  EXPECT_EQ(complaints("materials: {a: {type: conductor, metal: sliver}}\n"),
            "job.yaml:2:41: metal is 'sliver', expected aluminium, brass, chromium, cobalt, "
            "copper, gold, iron, nickel, palladium, platinum, silver, titanium or tungsten, did "
            "you mean 'silver'?\n");
  EXPECT_EQ(
      complaints("objects: {a: {shape: cube}}\n"),
      "job.yaml:2:22: shape is 'cube', expected sphere, rectangle, disk, box or cylinder, did "
      "you mean 'box'?\n");
}

TEST(Complaints, DuplicateKeys) {
  EXPECT_EQ(complaints("camera:\n  fov: 30\n  fov: 40\n"),
            "job.yaml:4:3: duplicate key 'fov' (first at line 3)\n");
  EXPECT_EQ(complaints("objects:\n  a: {shape: box}\n  b: {shape: box}\n  a: {shape: box}\n"),
            "job.yaml:5:3: duplicate key 'a' (first at line 3)\n");
}

TEST(Complaints, Expressions) {
  EXPECT_EQ(complaints("camera: {fov: \"= 20 + wobble(t)\"}\n"),
            "job.yaml:2:15: fov: unknown name 'wobble' in the expression; known are t, frame, pi, "
            "e, sin, cos, tan, asin, acos, atan, exp, log, sqrt, abs, floor, ceil, round, noise, "
            "atan2, pow, mod, min, max, clamp, lerp or smoothstep\n");
  EXPECT_EQ(complaints("camera: {fov: \"= 20 + smothstep(0, 1, t)\"}\n"),
            "job.yaml:2:15: fov: unknown name 'smothstep' in the expression, did you mean "
            "'smoothstep'?\n");
  EXPECT_EQ(complaints("camera: {fov: \"= 3 +\"}\n"),
            "job.yaml:2:15: fov: the expression does not compile: Unexpected end of expression at "
            "position 5\n");
  EXPECT_EQ(complaints("frames: 1-100\ncamera: {fov: \"= 20 + 10 * frame\"}\n"),
            "job.yaml:3:15: fov is 180 at frame 16, expected a number above 0 and below 180\n");
  EXPECT_EQ(
      complaints("camera: {fov: \"= sqrt(t - 1)\"}\n"),
      "job.yaml:2:15: fov is not a number at frame 1, expected a number above 0 and below 180\n");
  EXPECT_EQ(complaints("camera: {fov: {keys: {1: 20, 2: \"= t\"}}}\n"),
            "job.yaml:2:33: fov has an expression in a key; keys hold plain values\n");
  EXPECT_EQ(complaints("camera: {fov: {keys: {start: 20}}}\n"),
            "job.yaml:2:23: fov has a key at 'start', expected a frame number\n");
  EXPECT_EQ(complaints("camera: {fov: {keys: {1: 20, 1.0: 30}}}\n"),
            "job.yaml:2:22: fov has two keys at one frame\n");
}

TEST(Complaints, VersionAndNames) {
  MemoryAssets assets;
  Diagnostics diagnostics;
  parse_job("name: a\n", "job.yaml", assets, diagnostics);
  EXPECT_EQ(diagnostics.to_string(),
            "job.yaml:1:1: the job has no 'hyades', expected the version of the job language: "
            "hyades: 1\n");
  EXPECT_EQ(complaints("textures: {3200K: {type: checker}}\n"),
            "job.yaml:2:12: '3200K' cannot be the name of a texture: expected letters, digits, "
            "'_', '-', '.' and inner spaces, at most 100, that do not read as a colour or "
            "number\n");
  EXPECT_EQ(complaints("name: a/b\n"),
            "job.yaml:2:7: name is 'a/b', expected letters, digits, '_', '-', '.' and inner "
            "spaces, at most 100\n");
}

TEST(Complaints, ComeAllAtOnceInOrderOfLines) {
  EXPECT_EQ(complaints("outputs: [{file: a.gif}]\n"
                       "film: {size: [0, 10]}\n"
                       "camera: {fov: 500, lens: 3}\n"
                       "objects:\n"
                       "  a: {shape: sphere, radius: -1, material: gold}\n"
                       "  b: {mesh: missing.ply}\n"),
            "job.yaml:2:18: file is 'a.gif', expected the ending .exr, .png, .tif, .tiff, .jpg, "
            ".jpeg, .mp4, .mov or .webm\n"
            "job.yaml:3:15: size[0] is '0', expected a whole number from 1 to 65536\n"
            "job.yaml:4:15: fov is '500', expected a number above 0 and below 180\n"
            "job.yaml:4:20: unknown key 'lens' in camera; expected aperture, exposure, focus, fov, "
            "look_at, "
            "look_from, shift, type or up\n"
            "job.yaml:6:30: radius is '-1', expected a number above 0\n"
            "job.yaml:6:44: material of object 'a' names the material 'gold', which does not "
            "exist; the job defines none\n"
            "job.yaml:7:13: mesh of object 'b': missing.ply: no such file\n");
}

TEST(Complaints, StopAfterAHundred) {
  std::string body = "objects:\n";
  for (int i = 0; i < 300; ++i) body += "  a" + std::to_string(i) + ": {shape: cube}\n";
  MemoryAssets assets;
  Diagnostics diagnostics;
  parse_job("hyades: 1\n" + body, "job.yaml", assets, diagnostics);
  ASSERT_EQ(diagnostics.list().size(), 101U);
  EXPECT_EQ(diagnostics.list().back().to_string(),
            "job.yaml: too many complaints: only the first 100 are listed, mend those and look "
            "again");
}

}  // namespace
}  // namespace hyades::core
