// Light linking and shadow linking, against closed forms and by every integrator.

#include <gtest/gtest.h>

#include <cmath>
#include <exception>
#include <string>

#include "tests/truth/replicates.h"

namespace hyades::test {
namespace {

using core::Vec3d;

constexpr Promise kLinkingPromise{
    .significance = 0.01, .tests = 3 * 60, .relative_error = 0.02, .power = 0.99};
constexpr Promise kLinkingPromiseOfChains{
    .significance = 0.01, .tests = 3 * 60, .relative_error = 0.04, .power = 0.99};
constexpr int kChains = 16;

/// What lights: an even sky, or a sphere around all that shines inwards as brightly.
enum class Around { sky, lamp };

/// A matt ball fills the picture, amid an even light with `keys`.
std::string ball(const std::string& integrator, const std::string& keys, int samples,
                 const std::string& more = "", Around light = Around::sky) {
  const std::string lit =
      light == Around::sky
          ? "environment: {color: 2" + keys + "}\n"
          : "  glow: {shape: sphere, radius: 20, material: soot, emit: {radiance: 2, two_sided: "
            "true" +
                keys + "}}\n";
  return "hyades: 1\nname: linked\nfilm: {size: [16, 16]}\nsampling: {samples: " +
         std::to_string(samples) + ", seed: 5, sampler: independent}\nintegrator: " + integrator +
         "\ncamera: {look_from: [0, 0, 1.5], look_at: [0, 0, 0], fov: 8}\n"
         "materials: {looks: {type: lambert, color: [0.8, 0.5, 0.2]}, soot: {type: "
         "black}}\nobjects:\n"
         "  ball: {group: {objects: {skin: {shape: sphere, radius: 0.5, material: looks}}}}\n"
         "  speck: {shape: sphere, radius: 0.1, at: [0, 9, 0], material: soot}\n" +
         more + lit;
}

const Vec3d kLit = 2.0 * Vec3d(0.8, 0.5, 0.2);

void expect_by(const std::string& integrator, const std::string& keys, Around light,
               const Vec3d& expected) {
  SCOPED_TRACE(integrator + keys + (light == Around::sky ? " of a sky" : " of a lamp"));
  const bool chains = integrator.find("mlt") != std::string::npos;
  const YamlScene scene(ball(integrator, keys, chains ? 60 : 700, "", light));
  if (expected == Vec3d(0.0)) {
    EXPECT_EQ(picture_mean(scene.render().film).mean, expected);
  } else if (chains) {
    expect_mean_of_runs(scene, kChains, expected, kLinkingPromiseOfChains);
  } else {
    expect_picture_mean(scene, expected, kLinkingPromise);
  }
}

void expect_by_all(const std::string& keys, const Vec3d& expected) {
  for (const Around light : {Around::sky, Around::lamp}) {
    for (const char* integrator : {"path", "bdpt", "mlt", "{type: mlt, over: path}"})
      expect_by(integrator, keys, light, expected);
  }
}

TEST(LightLinking, LightsWhatIsInTheListOnly) {
  expect_by_all(", light_linking: {include: [ball]}", kLit);
  expect_by_all(", light_linking: {include: [ball/skin, speck]}", kLit);
  expect_by_all(", light_linking: {exclude: [speck]}", kLit);
  expect_by_all(", light_linking: {include: [speck]}", Vec3d(0.0));
  expect_by_all(", light_linking: {exclude: [ball]}", Vec3d(0.0));
  expect_by_all(", light_linking: {include: [ball], exclude: [ball/skin]}", Vec3d(0.0));
  expect_by_all(", light_linking: {include: []}", Vec3d(0.0));
  // What scripts write for no objects.
  expect_by("path", ", light_linking: {include: {}}", Around::sky, Vec3d(0.0));
  // Groups may be empty.
  const std::string none = "  none: {group: {objects: {}}}\n";
  expect_picture_mean(YamlScene(ball("path", ", light_linking: {exclude: [none]}", 700, none)),
                      kLit, kLinkingPromise);
}

/// A room with lamps that are linked to some of what is in it, and fog: light that lamps did not
/// send straight goes where it goes.
constexpr const char* kLinkedRoom = R"(hyades: 1
name: linked-room
film: {size: [24, 18]}
sampling: {samples: 96, sampler: independent}
camera: {look_from: [0, 1.2, 4], look_at: [0, 0.6, 0], fov: 40}
materials:
  white: {type: lambert, color: 0.7}
  shiny: {type: glossy, color: [0.2, 0.5, 0.7], reflectiveness: 0.4, glossiness: 0.5}
  air: {type: "null"}
media: {fog: {scattering: 1.2, absorption: 0.1, g: 0.3}, haze: {scattering: 0.03}}
objects:
  floor: {shape: rectangle, size: [6, 6], material: white}
  left: {shape: sphere, radius: 0.4, at: [-0.7, 0.4, 0.4], material: white}
  right: {shape: sphere, radius: 0.4, at: [0.7, 0.4, 0.4], material: shiny}
  cloud: {shape: sphere, radius: 0.4, at: [0, 1.1, 0], material: air, interior: fog}
  lamp: {shape: sphere, radius: 0.3, at: [-1.2, 1.6, 0.5], emit: {color: [1, 0.2, 0.2], radiance: 8, light_linking: {include: [left, cloud]}}}
  panel: {shape: rectangle, size: [1, 1], transform: [{rotate_x: 180}], at: [0.5, 2, 0], emit: {color: [0.2, 1, 0.3], radiance: 6, light_linking: {exclude: [floor]}}}
lights:
  bulb: {type: point, at: [1, 2, 1], color: [0.2, 0.3, 1], power: 30, light_linking: {include: [floor, right]}}
  sun: {type: sun, direction: [1, -2, -1], irradiance: 0.6, angle: 10, light_linking: {exclude: [right, cloud]}}
environment: {color: [0.3, 0.3, 0.2], light_linking: {include: [cloud, right]}}
)";

std::string room(const std::string& integrator, const std::string& atmosphere) {
  return "integrator: {type: " + integrator + ", max_depth: 5}\n" + kLinkedRoom + atmosphere;
}

constexpr Promise kLinkedRoomPromise{
    .significance = 0.01, .tests = 12, .relative_error = 0.03, .power = 0.99};

TEST(LightLinking, PathAndBdptAgree) {
  for (const char* atmosphere : {"", "atmosphere: haze\n"}) {
    SCOPED_TRACE(atmosphere);
    const YamlScene path(room("path", atmosphere));
    const YamlScene bdpt(room("bdpt", atmosphere));
    expect_same_picture(render_replicates(path, 24, 6), render_replicates(bdpt, 24, 6),
                        kLinkedRoomPromise);
  }
}

/// Lamps that do not light what is looked at are as if they were not there, and are not chosen.
TEST(LightLinking, ChoosesLampsByTheirLists) {
  const std::string sky = ", light_linking: {include: [ball]}";
  std::string lamps = "lights:\n";
  for (int i = 0; i < 9; ++i) {
    lamps += "  l" + std::to_string(i) + ": {type: point, at: [" + std::to_string(i - 4) +
             ", 2, 3], power: 30, light_linking: {" +
             (i % 3 == 0 ? "include: [ball]" : "exclude: [ball]") + "}}\n";
  }
  std::string fewer = "lights:\n";
  for (int i = 0; i < 9; i += 3) {
    fewer += "  l" + std::to_string(i) + ": {type: point, at: [" + std::to_string(i - 4) +
             ", 2, 3], power: 30}\n";
  }
  const auto picture = [&](const std::string& lights) {
    return picture_mean(YamlScene(ball("path", sky, 400) + lights).render().film);
  };
  const PictureMean linked = picture(lamps);
  const PictureMean alone = picture(fewer);
  for (int c = 0; c < 3; ++c) {
    const double sigma = std::hypot(linked.sigma[c], alone.sigma[c]);
    EXPECT_NEAR(linked.mean[c], alone.mean[c], 4.5 * sigma) << c;
    EXPECT_LT(4.5 * sigma, 0.01 * alone.mean[c]) << c << ": could not have told";
    EXPECT_LT(linked.sigma[c], 0.001 * linked.mean[c]) << c;  // of choices among all 0.004
  }
}

/// Whether the dome around the ball keeps the sky off is a matter of the sky's list.
TEST(ShadowLinking, OnlyWhatIsInTheListCastsShadows) {
  const std::string dome = "  dome: {shape: sphere, radius: 3, material: soot}\n";
  const auto expect_lit = [&](const std::string& keys) {
    SCOPED_TRACE(keys);
    for (const Around light : {Around::sky, Around::lamp})
      expect_picture_mean(YamlScene(ball("path", keys, 700, dome, light)), kLit, kLinkingPromise);
  };
  const auto expect_black = [&](const std::string& keys) {
    SCOPED_TRACE(keys);
    for (const Around light : {Around::sky, Around::lamp}) {
      const YamlScene scene(ball("path", keys, 100, dome, light));
      EXPECT_EQ(picture_mean(scene.render().film).mean, Vec3d(0.0));
    }
  };
  expect_black("");
  expect_lit(", shadow_linking: {exclude: [dome]}");
  expect_lit(", shadow_linking: {include: []}");
  expect_lit(", shadow_linking: {include: [ball]}");
  expect_black(", shadow_linking: {include: [dome]}");
  expect_black(", shadow_linking: {exclude: [ball]}");
  expect_black(", shadow_linking: {exclude: [dome]}, light_linking: {exclude: [ball]}");
}

/// A sun lights through what is not on its list, surfaces as well as media: of 1.5 m of smoke, and
/// a plate.
std::string below_smoke(const std::string& list) {
  std::string text = R"(
hyades: 1
name: through-fog
film: {size: [8, 8]}
sampling: {samples: 64, sampler: independent}
integrator: {type: path, max_depth: 1}
camera: {look_from: [0, 0.5, 4], look_at: [0, 0, 0], fov: 0.1}
materials: {white: {type: lambert, color: 0.5}, air: {type: "null"}, soot: {type: black}}
media: {smoke: {absorption: [1, 0.5, 0]}}
objects:
  floor: {shape: rectangle, size: [0.1, 0.1], material: white}
  smoke: {shape: box, size: [1, 1.5, 1], at: [0, 3, 0], material: air, interior: smoke}
  plate: {shape: rectangle, size: [1, 1], at: [0, 6, 0], material: soot}
lights: {sun: {type: sun, direction: [0, -1, 0], irradiance: 3, angle: 0, shadow_linking: LIST}}
)";
  return text.replace(text.find("LIST"), 4, list);
}

TEST(ShadowLinking, MediaAreAsTheirObjects) {
  const Vec3d plain(3.0 * 0.5 / M_PI);
  const Vec3d smoky = plain * Vec3d(std::exp(-1.5), std::exp(-0.75), 1.0);
  expect_picture_mean(YamlScene(below_smoke("{exclude: [plate]}")), smoky, kLinkingPromise);
  expect_picture_mean(YamlScene(below_smoke("{include: [smoke]}")), smoky, kLinkingPromise);
  expect_picture_mean(YamlScene(below_smoke("{exclude: [plate, smoke]}")), plain, kLinkingPromise);
  expect_picture_mean(YamlScene(below_smoke("{include: []}")), plain, kLinkingPromise);
  const std::string haze = "atmosphere: smoke\n";  // without an end, and on no list
  expect_picture_mean(YamlScene(below_smoke("{include: []}") + haze),
                      plain * Vec3d(std::exp(-4.0311), std::exp(-2.0156), 1.0), kLinkingPromise);
}

/// The light that scattered rays find comes through the same: a ball within smoke within a dome.
TEST(ShadowLinking, FoundLampsAreAsChosenOnes) {
  const std::string more =
      "  smoke: {shape: sphere, radius: 1, material: air, interior: smoke}\n"
      "  dome: {shape: sphere, radius: 3, material: soot}\n";
  const auto picture = [&](const std::string& keys, Around light) {
    std::string text = ball("path", keys, 1500, more, light);
    text.insert(text.find("materials:"), "media: {smoke: {absorption: [0.7, 0.4, 0.1]}}\n");
    text.insert(text.find("soot:"), "air: {type: \"null\"}, ");
    return YamlScene(text);
  };
  for (const Around light : {Around::sky, Around::lamp}) {
    // The camera looks through 0.5 m of it; all the light that the ball gets comes straight out.
    const Vec3d seen(std::exp(-0.35), std::exp(-0.2), std::exp(-0.05));
    const auto mean_of = [&](const std::string& keys) {
      return picture_mean(picture(keys, light).render().film).mean;
    };
    const Vec3d clear = mean_of(", shadow_linking: {include: []}");
    const Vec3d mean = mean_of(", shadow_linking: {exclude: [dome]}");
    for (int c = 0; c < 3; ++c) {
      const double depth = c == 0 ? 0.7 : c == 1 ? 0.4 : 0.1;
      EXPECT_NEAR(clear[c], kLit[c] * seen[c], 0.01 * clear[c]) << c;  // to its rim it is more
      EXPECT_LT(mean[c], kLit[c] * seen[c] * std::exp(-0.5 * depth)) << c;
      EXPECT_GT(mean[c], kLit[c] * seen[c] * std::exp(-0.87 * depth)) << c;
    }
  }
}

std::string error_of(const std::string& text) {
  try {
    (void)YamlScene(text);
  } catch (const std::exception& error) {
    const std::string message = error.what();
    return message.substr(0, message.find('\n'));
  }
  return "none";
}

TEST(Linking, SaysWhatIsWrong) {
  const auto error_with = [](const std::string& keys) { return error_of(ball("path", keys, 1)); };
  EXPECT_EQ(error_with(", light_linking: {include: [bal]}"),
            "test.yaml:11:51: include of light_linking of environment names the object 'bal', "
            "which does not exist, did you mean 'ball'?");
  EXPECT_EQ(error_with(", light_linking: {include: [ball/core]}"),
            "test.yaml:11:40: nothing is called 'ball/core', expected the name of an object or, "
            "behind slashes, of what is in it");
  EXPECT_EQ(error_with(", light_linking: {include: ball}"),
            "test.yaml:11:50: include is 'ball', expected a list of names, such as [ball, "
            "tree/trunk]");
}

TEST(Linking, TellsSixtyThreeListsApart) {
  const auto with_lists = [](int lists) {
    std::string text = "hyades: 1\nobjects:\n";
    for (int i = 0; i < lists; ++i) text += "  o" + std::to_string(i) + ": {shape: sphere}\n";
    text += "lights:\n";
    for (int i = 0; i < lists; ++i) {
      const std::string number = std::to_string(i);
      text += "  l" + number + ": {type: sun, light_linking: {include: [o" + number + "]}}\n";
    }
    return error_of(text);
  };
  EXPECT_EQ(with_lists(63), "none");
  EXPECT_EQ(with_lists(64),
            "test.yaml:131:35: lights are linked to more than 63 different lists of objects, "
            "expected fewer");
}

}  // namespace
}  // namespace hyades::test
