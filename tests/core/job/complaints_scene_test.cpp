#include <gtest/gtest.h>

#include "tests/core/job/complaints_testing.h"

// Complaints about what is in a scene: objects, materials, textures, media, cameras.
namespace hyades::core {
namespace {

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
            "exist; the job defines none, and a colour is [r, g, b], \"#d8c8a8\" or 3200K\n");
  EXPECT_EQ(complaints("objects: {a: {shape: sphere, emit: {color: [1, -1, 0]}}}\n"),
            "job.yaml:2:48: color[1] is '-1', expected a number >= 0\n");
}

TEST(Complaints, ColoursOfTexturesThatAreNoSharesOfLight) {
  EXPECT_EQ(complaints("textures: {wall: {type: checker, a: [200, 30, 0], b: [0.5, 1, 1]}}\n"
                       "materials: {m: {type: lambert, color: wall}}\n"),
            "job.yaml:2:18: texture 'wall' has the colour [200, 30, 0] and is the color of "
            "material 'm', expected at most 1: if they go from 0 to 255, \"#c81e00\"\n");
  EXPECT_EQ(
      complaints("textures: {in: {type: constant, value: 1.5}, wall: {type: mix, a: 0, b: in}}\n"
                 "materials: {m: {type: principled, base_color: wall}}\n"),
      "job.yaml:2:16: texture 'in' has the colour [1.5, 1.5, 1.5] and is the base_color of "
      "material 'm', expected at most 1\n");
  // Light may be any; arithmetic makes shares of what is none; so do stops of the number before.
  EXPECT_EQ(complaints("textures: {t: {type: checker, a: 200}, half: {type: scale, input: t, "
                       "factor: 0.004}, r: {type: ramp, input: t, stops: {0: 0, 200: 1}}}\n"
                       "materials: {m: {type: lambert, color: half}, n: {type: lambert, color: r}, "
                       "l: {type: principled, emission_color: t, emission_strength: 1}}\n"
                       "objects: {a: {shape: sphere, emit: {color: t}}}\n"),
            "");
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
            "the job defines none, and a colour is [r, g, b], \"#d8c8a8\" or 3200K\n");
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
      "two-sided, hair, null or black, did you mean 'lambert'?\n"
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
            "job.yaml:2:14: object 'a' has none of shape, mesh, curves, instance and group, "
            "expected one\n"
            "job.yaml:2:28: object 'b' has none of shape, mesh, curves, instance and group, "
            "expected one\n"
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

TEST(Complaints, HairHasOneColor) {
  const auto told = [](const std::string& keys) {
    return complaints("materials: {m: {type: hair, " + keys + "}}\n");
  };
  EXPECT_EQ(told("color: 0.5"), "");
  EXPECT_EQ(told("absorption: 3"), "");
  EXPECT_EQ(told("eumelanin: 1, pheomelanin: 2"), "");
  EXPECT_EQ(told("color: 0.5, absorption: 3"),
            "job.yaml:2:53: color and absorption are both there, expected one of color, absorption "
            "and pigments\n");
  EXPECT_EQ(told("pheomelanin: 2, absorption: 3"),
            "job.yaml:2:42: absorption and pheomelanin are both there, expected one of color, "
            "absorption and pigments\n");
}

TEST(Complaints, DirectionsThatAreNone) {
  EXPECT_EQ(complaints("camera: {up: [0, 0, 0]}\n"),
            "job.yaml:2:14: up is [0, 0, 0], expected a direction, not [0, 0, 0]\n");
  EXPECT_EQ(complaints("lights: {s: {type: sun, direction: [1e-30, 0, 0]}}\n"),
            "job.yaml:2:36: direction is [1e-30, 0, 0], expected a direction, not [0, 0, 0]\n");
  EXPECT_EQ(complaints("lights: {s: {type: spot, at: [0, -1, 0]}}\n"),
            "job.yaml:2:30: at and look_at are both [0, -1, 0], expected two points\n");
}

TEST(Complaints, ProjectorsWithoutPictureOrDirection) {
  EXPECT_EQ(complaints("lights: {p: {type: projector}}\n"),
            "job.yaml:2:13: light 'p' has no 'image', expected the picture that it throws\n");
  EXPECT_EQ(complaints("lights: {p: {type: projector, image: none.png}}\n"),
            "job.yaml:2:38: image of light 'p': none.png: no such file\n");
  EXPECT_EQ(complaints("lights: {p: {type: point, image: none.exr}}\n"),
            "job.yaml:2:34: image of light 'p': none.exr: no such file\n");
  EXPECT_EQ(complaints("lights: {s: {type: spot, image: none.exr}}\n"),
            "job.yaml:2:26: unknown key 'image' in light 's'; it belongs to point or projector\n");
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
