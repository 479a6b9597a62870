#include <gtest/gtest.h>

#include "core/job/parse.h"
#include "tests/core/job/test_assets.h"

/// The exact text of every kind of complaint: file, line, column, what was found, what was
/// expected.
namespace hyades::core {
namespace {

std::string complaints(const std::string& body) {
  MemoryAssets assets;
  assets.add("a.obj", "mesh");
  Diagnostics diagnostics;
  parse_job("hyades: 1\n" + body, "job.yaml", assets, diagnostics);
  return diagnostics.to_string();
}

TEST(Complaints, UnknownKeysSuggestTheNearestOne) {
  EXPECT_EQ(complaints("camera: {look_form: [0, 0, 1]}\n"),
            "job.yaml:2:10: unknown key 'look_form' in camera, did you mean 'look_from'?\n");
  EXPECT_EQ(complaints("flim: {size: [2, 2]}\n"),
            "job.yaml:2:1: unknown key 'flim' in the job, did you mean 'film'?\n");
  EXPECT_EQ(complaints("sampling: {quality: 7}\n"),
            "job.yaml:2:12: unknown key 'quality' in sampling; expected sampler, samples or "
            "seed\n");
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
            "job.yaml:2:17: range is '9-3', expected a frame or range such as 7, 1-120 or "
            "1-120x2, up to 9999999\n");
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

TEST(Complaints, TexturesWhereOnlyAColourIsAllowed) {
  EXPECT_EQ(
      complaints("textures: {dots: {type: checker}}\nlights: {a: {type: point, color: dots}}\n"),
      "job.yaml:3:34: color is a texture; here only a colour is allowed\n");
  EXPECT_EQ(complaints("environment: {color: {type: checker, scale: 3}}\n"),
            "job.yaml:2:22: color is a texture; here only a colour is allowed\n");
  EXPECT_EQ(complaints("textures: {dots: {type: checker}}\n"
                       "lights: {a: {type: sun, color: {keys: {1: dots, 5: 1}}}}\n"),
            "job.yaml:3:43: color is a texture; here only a colour is allowed\n");
  EXPECT_EQ(complaints("media: {fog: {scattering: {type: checker}}}\n"),
            "job.yaml:2:27: scattering is a texture; here only a colour is allowed\n");
  EXPECT_EQ(complaints("objects: {a: {shape: sphere, emit: {color: dots}}}\n"),
            "job.yaml:2:44: color of emit of object 'a' names the texture 'dots', which does not "
            "exist; the job defines none\n");
  EXPECT_EQ(complaints("objects: {a: {shape: sphere, emit: {color: [1, -1, 0]}}}\n"),
            "job.yaml:2:48: color[1] is '-1', expected a number >= 0\n");
}

TEST(Complaints, KeysThatAreNoTextHideNoOtherComplaint) {
  EXPECT_EQ(
      complaints("film: {size: 640}\nobjects:\n  ~: {shape: sphere}\n  [1, 2]: {shape: sphere}\n"
                 "  a: &name {shape: cube}\n  *name : 3\n  <<: 2\n"),
      "job.yaml:2:14: size is '640', expected a list of 2 whole numbers\n"
      "job.yaml:4:3: an empty key; keys are plain text\n"
      "job.yaml:5:3: a list or map as a key; keys are plain text\n"
      "job.yaml:6:20: shape is 'cube', expected sphere, rectangle, disk, box or cylinder\n"
      "job.yaml:7:3: an alias as a key; keys are plain text\n"
      "job.yaml:8:3: '<<' is not supported; use `like: name` to copy another entry's keys\n");
}

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
      "sheen, two-sided, null or black, did you mean 'lambert'?\n");
  EXPECT_EQ(
      complaints("materials: {a: {color: 0.5}}\n"),
      "job.yaml:2:16: material 'a' has no 'type', expected one of lambert, principled, dielectric, "
      "thin-dielectric, conductor, glossy, mirror, diffuse-transmission, mix, coat, sheen, "
      "two-sided, null or black\n");
  EXPECT_EQ(complaints("materials: {a: {type: conductor, metal: sliver}}\n"),
            "job.yaml:2:41: metal is 'sliver', expected aluminium, brass, chromium, cobalt, "
            "copper, gold, iron, nickel, palladium, platinum, silver, titanium or tungsten, did "
            "you mean 'silver'?\n");
  EXPECT_EQ(complaints("objects: {a: {shape: cube}}\n"),
            "job.yaml:2:22: shape is 'cube', expected sphere, rectangle, disk, box or cylinder\n");
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

TEST(Complaints, Media) {
  EXPECT_EQ(complaints("media: {fog: {g: 1}}\n"),
            "job.yaml:2:18: g is '1', expected a number above -1 and below 1\n");
  EXPECT_EQ(complaints("media: {fog: {albedo: 0.5}}\n"),
            "job.yaml:2:23: medium 'fog' has albedo alone, expected albedo together with "
            "mean_free_path or density\n");
  EXPECT_EQ(complaints("media: {fog: {albedo: 0.5, density: 2, scattering: 1}}\n"),
            "job.yaml:2:23: medium 'fog' has both albedo and scattering, expected one way of "
            "saying how dense it is\n");
  EXPECT_EQ(complaints("media: {fog: {phase: rayleigh, g: 0.5}}\n"),
            "job.yaml:2:35: g belongs to phase henyey-greenstein, not to rayleigh\n");
  EXPECT_EQ(complaints("media: {fog: {}}\nobjects: {a: {shape: disk, interior: fog}}\n"),
            "job.yaml:3:38: object 'a' is a disk, which has no inside: interior needs a mesh, a "
            "sphere, a box or a cylinder with caps\n");
  EXPECT_EQ(complaints("objects: {a: {shape: cylinder, caps: false, priority: 2}}\n"),
            "job.yaml:2:55: object 'a' is a cylinder without caps, which has no inside: priority "
            "needs a mesh, a sphere, a box or a cylinder with caps\n");
  EXPECT_EQ(complaints("media: {fog: {}}\natmosphere: smog\n"),
            "job.yaml:3:13: atmosphere names the medium 'smog', which does not exist; there are "
            "fog\n");
}

TEST(Complaints, DanglingNames) {
  EXPECT_EQ(complaints("materials: {steel: {type: mirror}}\n"
                       "objects: {a: {shape: sphere, material: stel}}\n"),
            "job.yaml:3:40: material of object 'a' names the material 'stel', which does not "
            "exist, did you mean 'steel'?\n");
  EXPECT_EQ(complaints("materials: {a: {type: lambert, color: wood}}\n"),
            "job.yaml:2:39: color of material 'a' names the texture 'wood', which does not exist; "
            "the job defines none\n");
  EXPECT_EQ(complaints("objects: {a: {instance: house}}\ngroups: {b: {objects: {}}}\n"),
            "job.yaml:2:25: instance of object 'a' names the group 'house', which does not exist; "
            "there are b\n");
  EXPECT_EQ(complaints("camera: {focus: ball}\n"),
            "job.yaml:2:17: focus of camera names the object 'ball', which does not exist; the job "
            "defines none\n");
}

TEST(Complaints, AMistakeInAnEntryDoesNotMakeItsNameUnknown) {
  EXPECT_EQ(
      complaints("materials: {red: {type: mirror, color: 7}, blue: {type: lambart}}\n"
                 "objects: {a: {shape: box, material: red}, b: {shape: box, material: blue}}\n"
                 "groups: {g: {objects: 3}}\n"),
      "job.yaml:2:40: color is '7', expected a number from 0 to 1\n"
      "job.yaml:2:57: type is 'lambart', expected lambert, principled, dielectric, "
      "thin-dielectric, conductor, glossy, mirror, diffuse-transmission, mix, coat, sheen, "
      "two-sided, null or black, did you mean 'lambert'?\n"
      "job.yaml:4:23: objects is '3', expected a map of names, such as {name: {...}}\n");
}

TEST(Complaints, ThingsThatContainThemselves) {
  EXPECT_EQ(complaints("textures: {a: {type: checker, a: b}, b: {type: scale, input: a}}\n"),
            "job.yaml:2:15: texture 'a' is made of itself\n"
            "job.yaml:2:41: texture 'b' is made of itself\n");
  EXPECT_EQ(complaints("materials: {m: {type: mix, first: m, second: n}, n: {type: mirror}}\n"),
            "job.yaml:2:16: material 'm' is made of itself\n");
  EXPECT_EQ(complaints("groups: {g: {objects: {x: {group: {objects: {y: {instance: g}}}}}}}\n"),
            "job.yaml:2:13: group 'g' contains itself\n");
  EXPECT_EQ(complaints("objects: {a: {like: b}, b: {like: a}}\n"),
            "job.yaml:2:14: object 'a' has none of shape, mesh, instance and group, expected one\n"
            "job.yaml:2:28: object 'b' has none of shape, mesh, instance and group, expected one\n"
            "job.yaml:2:35: 'b' is like 'a', which in the end is like itself\n");
}

TEST(Complaints, MissingFiles) {
  EXPECT_EQ(complaints("objects: {a: {mesh: b.obj}, c: {mesh: a.obj}}\n"),
            "job.yaml:2:21: mesh of object 'a': b.obj: no such file\n");
  EXPECT_EQ(complaints("environment: {image: sky.hdr}\n"),
            "job.yaml:2:22: image of environment: sky.hdr: no such file\n");
  EXPECT_EQ(complaints("include: parts.yaml\n"),
            "job.yaml:2:10: include: parts.yaml: no such file\n");
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

TEST(Complaints, KeysThatExcludeEachOther) {
  EXPECT_EQ(complaints("objects: {a: {shape: box, mesh: a.obj}}\n"),
            "job.yaml:2:33: object 'a' has both 'shape' and 'mesh', expected one of them\n");
  EXPECT_EQ(complaints("objects: {a: {shape: box, emit: {radiance: 1, power: 2}}}\n"),
            "job.yaml:2:54: emit has both radiance and power, expected one of them\n");
  EXPECT_EQ(complaints("camera: {aperture: {radius: 1, f_stop: 2}}\n"),
            "job.yaml:2:40: aperture has both radius and f_stop, expected one of them\n");
  EXPECT_EQ(complaints("materials: {a: {type: conductor, eta: 1}}\n"),
            "job.yaml:2:39: eta and k belong together, found only one of them\n");
  EXPECT_EQ(complaints("materials: {a: {type: conductor, metal: gold, eta: 1, k: 2}}\n"),
            "job.yaml:2:41: metal and the measured eta and k are both there, expected one of "
            "them\n");
  EXPECT_EQ(complaints("camera: {look_from: [1, 2, 3], look_at: [1, 2, 3]}\n"),
            "job.yaml:2:41: look_from and look_at are both [1, 2, 3], expected two points\n");
}

TEST(Complaints, DirectionsThatAreNone) {
  EXPECT_EQ(complaints("camera: {up: [0, 0, 0]}\n"),
            "job.yaml:2:14: up is [0, 0, 0], expected a direction, not [0, 0, 0]\n");
  EXPECT_EQ(complaints("lights: {s: {type: sun, direction: [1e-30, 0, 0]}}\n"),
            "job.yaml:2:36: direction is [1e-30, 0, 0], expected a direction, not [0, 0, 0]\n");
  EXPECT_EQ(complaints("lights: {s: {type: spot, at: [0, -1, 0]}}\n"),
            "job.yaml:2:30: at and look_at are both [0, -1, 0], expected two points\n");
}

TEST(Complaints, DirectionsThatAreNoneAtAFrame) {
  EXPECT_EQ(complaints("frames: 1-2\n"
                       "lights: {s: {type: sun, direction: [0, \"= frame == 2 ? 0 : -1\", 0]}}\n"),
            "job.yaml:3:36: direction is [0, 0, 0] at frame 2, expected a direction, not "
            "[0, 0, 0]\n");
  EXPECT_EQ(complaints("frames: 1-2\nobjects: {a: {shape: box, transform: [{rotate: {axis: "
                       "[\"= frame == 2 ? 0 : 1\", 0, 0], angle: 30}}]}}\n"),
            "job.yaml:3:55: axis is [0, 0, 0] at frame 2, expected a direction, not [0, 0, 0]\n");
  EXPECT_EQ(complaints("frames: 1-2\ncamera: {look_from: [0, 0, 5], look_at: [0, 0, \"= frame == "
                       "2 ? 5 : 0\"]}\n"),
            "job.yaml:3:41: look_from and look_at are both [0, 0, 5] at frame 2, expected two "
            "points\n");
  EXPECT_EQ(complaints("frames: 1-2\ncamera: {look_from: [0, 0, 5], look_at: {keys: {1: [0, 0, 0], "
                       "3: [0, 0, 10]}}}\n"),
            "job.yaml:3:41: look_from and look_at are both [0, 0, 5] at frame 2, expected two "
            "points\n");
}

TEST(Complaints, CameraAndTransformsCountWhileTheShutterIsOpen) {
  const std::string frames = "frames: {range: 1-2, shutter: 0.5}\n";
  EXPECT_EQ(complaints(frames + "camera: {fov: \"= frame == 2.25 ? 200 : 40\"}\n"),
            "job.yaml:3:15: fov is 200 at frame 2.25, expected a number above 0 and below 180\n");
  EXPECT_EQ(complaints(frames + "lights: {p: {type: point, power: \"= 2 - frame\"}}\n"), "");
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
            "job.yaml:2:42: layer is 'normals', expected beauty, alpha, depth, position, normal, "
            "albedo, motion, variance, samples, components, diffuse_direct, diffuse_indirect, "
            "glossy_direct, glossy_indirect, transmission_direct, transmission_indirect, "
            "volume_direct, volume_indirect, emission, environment, light_groups, object_id, "
            "material_id, crypto_object or crypto_material, did you mean 'normal'?\n"
            "job.yaml:2:51: layer 'beauty' is listed twice\n");
  EXPECT_EQ(complaints("name: b\nkeep_films: true\noutputs: [{file: ./b.film.exr}]\n"),
            "job.yaml:4:18: file is './b.film.exr', where keep_films puts the film, expected "
            "another name\n");
  EXPECT_EQ(complaints("name: b\noutputs: [{file: ./b.film.exr}]\n"), "");
}

TEST(Complaints, Transforms) {
  EXPECT_EQ(complaints("objects: {a: {shape: box, transform: {scale: 2}}}\n"),
            "job.yaml:2:38: transform is a map, expected a list of steps, such as [{scale: 2}, "
            "{rotate_y: 45}]\n");
  EXPECT_EQ(complaints("objects: {a: {shape: box, transform: [{rotat_y: 2}]}}\n"),
            "job.yaml:2:40: unknown key 'rotat_y' in a transform step, did you mean 'rotate_y'?\n");
  EXPECT_EQ(complaints("objects: {a: {shape: box, transform: [{scale: 2, rotate_y: 3}]}}\n"),
            "job.yaml:2:39: a transform step has 2 keys, expected one key of translate, "
            "scale, rotate_x, rotate_y, rotate_z, rotate or matrix\n");
  EXPECT_EQ(complaints("objects: {a: {shape: box, transform: [{rotate: {axis: [0, 0, 0], angle: "
                       "1}}]}}\n"),
            "job.yaml:2:55: axis is [0, 0, 0], expected a direction, not [0, 0, 0]\n");
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

TEST(Complaints, AboutCamerasThatDoNotHaveThat) {
  EXPECT_EQ(complaints("camera: {type: panoramic}\n"),
            "job.yaml:2:16: type is 'panoramic', expected perspective, orthographic or "
            "equirectangular\n");
  EXPECT_EQ(complaints("camera: {type: orthographic, aperture: {f_stop: 2}}\n"),
            "job.yaml:2:49: aperture has f_stop, but orthographic cameras have no focal length "
            "that it could divide, expected radius\n");
  EXPECT_EQ(complaints("camera: {type: orthographic, fov: 30}\n"),
            "job.yaml:2:30: unknown key 'fov' in camera; it belongs to perspective\n");
  EXPECT_EQ(complaints("camera: {type: orthographic, height: 0}\n"),
            "job.yaml:2:38: height is '0', expected a number above 0\n");
  EXPECT_EQ(complaints("camera: {type: equirectangular, focus: 3}\n"),
            "job.yaml:2:33: unknown key 'focus' in camera; it belongs to orthographic or "
            "perspective\n");
  EXPECT_EQ(complaints("camera: {shift: 0.2}\n"),
            "job.yaml:2:17: shift is '0.2', expected [x, y] (each a number from -100 to 100 or an "
            "expression)\n");
  EXPECT_EQ(complaints("camera: {shift: [0, 0.2, 0]}\n"),
            "job.yaml:2:17: shift is a list of 3, expected [x, y] (each a number from -100 to 100 "
            "or an expression)\n");
  EXPECT_EQ(complaints("frames: 1-9\ncamera: {shift: [0, \"= 20 * frame\"]}\n"),
            "job.yaml:3:21: shift[1] is 120 at frame 6, expected a number from -100 to 100\n");
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

TEST(Complaints, MaterialsThatContradictThemselves) {
  const auto complains = [](const std::string& materials, const std::string& expected) {
    const std::string found = complaints("materials:\n  a: {type: lambert}\n" + materials);
    EXPECT_NE(found.find(expected), std::string::npos) << found;
  };
  complains(
      "  g: {type: dielectric}\n  b: {type: two-sided, front: a, back: c}\n"
      "  c: {type: mix, first: a, second: g}\n",
      "job.yaml:5:6: material 'b' is two-sided, but 'g' lets light through");
  complains("  c: {type: lambert, opacity: 0.5}\n  b: {type: two-sided, front: a, back: c}\n",
            "'c' lets light through");
  complains("  b: {type: conductor, edge: 0.5}\n", "edge belongs to color, which is not there");
  complains("  b: {type: conductor, metal: gold, color: 0.5}\n",
            "color and a measured index are both there");
  complains("  b: {type: principled, diffuse_transmission: 0.5}\n",
            "that of thin walls, expected thin_walled: true");
  complains("  b: {type: principled, transmission: 1, subsurface: {radius: 1}}\n",
            "transmission and a subsurface are both there");
  complains("  b: {type: principled, emission_strength: 1}\n  c: {type: coat, base: b}\n",
            "'b' is a part of material 'c' and has an emission_strength");
  complains("  b: {type: coat, base: c}\n  c: {type: sheen, base: b}\n", "is made of itself");
}

// Images of normals hold numbers.
TEST(Complaints, NormalMapsThatAreColours) {
  const auto with_space = [](const std::string& space) {
    return "textures: {n: {type: image, file: n.png" + space +
           "}}\nmaterials: {a: {type: lambert, normal_map: {texture: n}}}\n";
  };
  EXPECT_NE(complaints(with_space(", color_space: srgb")).find("is a normal map with color_space"),
            std::string::npos);
  EXPECT_EQ(complaints(with_space("")).find("color_space"), std::string::npos);
}

}  // namespace
}  // namespace hyades::core
