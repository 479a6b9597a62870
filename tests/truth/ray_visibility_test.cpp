// Which rays see what, against closed forms: a ball, or what else is looked at, within a dome that
// would keep the even sky off, and does so for the rays that see it only.

#include <gtest/gtest.h>

#include <cmath>
#include <exception>
#include <string>

#include "core/film/film.h"
#include "tests/truth/render_yaml.h"

namespace hyades::test {
namespace {

using core::Vec3d;

constexpr Promise kVisibilityPromise{
    .significance = 0.01, .tests = 3 * 60, .relative_error = 0.02, .power = 0.99};

/// Radiance of the sky.
constexpr double kSky = 2.0;
const Vec3d kColor(0.8, 0.5, 0.2);

/// What is looked at, its material called `looks`.
std::string within_dome(const std::string& shown, const std::string& dome, const std::string& sky,
                        int samples = 800) {
  return "hyades: 1\nname: dome\nfilm: {size: [16, 16]}\nsampling: {samples: " +
         std::to_string(samples) +
         ", seed: 5, sampler: independent}\n"
         "camera: {look_from: [0, 0, 1.5], look_at: [0, 0, 0], fov: 8}\n" +
         shown + "  dome: {shape: sphere, radius: 3, material: soot" + dome +
         "}\nenvironment: {color: 2" + sky + "}\n";
}

/// A ball of a material fills the picture.
std::string ball_of(const std::string& material) {
  return "materials: {soot: {type: black}, looks: " + material +
         "}\nobjects:\n  ball: {shape: sphere, radius: 0.5, material: looks}\n";
}

/// A sheet that reflects 0.3 and lets 0.5 through.
constexpr const char* kLeaf =
    "materials: {soot: {type: black}, looks: {type: diffuse-transmission, color: 0.3, transmitted: "
    "0.5}}\nobjects:\n  sheet: {shape: rectangle, size: [1, 1], transform: [{rotate_x: 90}], "
    "material: looks}\n";

const std::string kMatt = ball_of("{type: lambert, color: [0.8, 0.5, 0.2]}");
const std::string kMirror = ball_of("{type: mirror, color: [0.8, 0.5, 0.2]}");

void expect_mean(const std::string& text, const Vec3d& expected) {
  SCOPED_TRACE(text);
  expect_picture_mean(YamlScene(text), expected, kVisibilityPromise);
}

void expect_black(const std::string& text) {
  SCOPED_TRACE(text);
  EXPECT_EQ(picture_mean(YamlScene(text).render().film).mean, Vec3d(0.0));
}

/// Whether the sky comes in is a matter of shadow rays, however its light is found: half of it is
/// found by rays that the ball scatters.
TEST(RayVisibility, ShadowsAreCastByWhatShadowRaysSee) {
  expect_black(within_dome(kMatt, "", ""));
  expect_mean(within_dome(kMatt, ", visible_to_shadow: false", ""), kSky * kColor);
  expect_black(within_dome(kMatt, ", visible_to_diffuse: false", ""));
  expect_mean(within_dome(kMatt, ", visible_to_diffuse: false, visible_to_shadow: false", ""),
              kSky * kColor);
}

/// A mirror shows what rays of its kind see.
TEST(RayVisibility, MirrorsShowWhatGlossyRaysSee) {
  expect_black(within_dome(kMirror, "", ""));
  expect_black(within_dome(kMirror, ", visible_to_shadow: false, visible_to_diffuse: false", ""));
  expect_mean(within_dome(kMirror, ", visible_to_glossy: false", ""), kSky * kColor);
}

/// A dome that shines and lets the sky in is seen by each kind by itself.
TEST(RayVisibility, EachKindOfRaySeesALamp) {
  const std::string lamp = ", emit: {radiance: 3, two_sided: true}, visible_to_shadow: false";
  const std::string none = lamp +
                           ", visible_to_diffuse: false, visible_to_glossy: false, "
                           "visible_to_transmission: false, visible_to_volume: false";
  for (const std::string& shown : {kMatt, kMirror}) {
    const bool matt = shown == kMatt;
    const char* own = matt ? ", visible_to_diffuse: false" : ", visible_to_glossy: false";
    const char* other = matt ? ", visible_to_glossy: false" : ", visible_to_diffuse: false";
    expect_mean(within_dome(shown, lamp + own, ""), kSky * kColor);
    // Through a lamp that casts no shadow the matt ball is lit by the sky too.
    expect_mean(within_dome(shown, lamp + other, ""), (matt ? 3.0 + kSky : 3.0) * kColor);
    expect_mean(within_dome(shown, none, ""), kSky * kColor);
  }
  expect_mean(within_dome(kLeaf, none, ""), Vec3d(0.8 * kSky));
}

/// The sheet is lit from both sides, and each kind by itself may miss the sky.
TEST(RayVisibility, TheSkyLightsThePartsOfASurface) {
  const std::string open = ", visible_to_shadow: false, visible_to_camera: false";
  expect_mean(within_dome(kLeaf, open, ""), Vec3d(0.8 * kSky));
  expect_mean(within_dome(kLeaf, open, ", visible_to_transmission: false"), Vec3d(0.3 * kSky));
  expect_mean(within_dome(kLeaf, open, ", visible_to_diffuse: false"), Vec3d(0.5 * kSky));
  expect_mean(within_dome(kLeaf, open, ", visible_to_glossy: false, visible_to_volume: false"),
              Vec3d(0.8 * kSky));
}

/// The pictures in which a part is left out differ from that of all by what adds up to the rest.
void expect_sum(const PictureMean& one, const PictureMean& other, const PictureMean& all,
                const PictureMean& none) {
  for (int c = 0; c < 3; ++c) {
    double variance = 0.0;
    for (const PictureMean* mean : {&one, &other, &all, &none})
      variance += mean->sigma[c] * mean->sigma[c];
    const double sigma = std::sqrt(variance);
    EXPECT_NEAR(one.mean[c] + other.mean[c], all.mean[c] + none.mean[c], 4.5 * sigma) << c;
    EXPECT_LT(4.5 * sigma, 0.02 * all.mean[c]) << c << ": could not have told";
    EXPECT_GT(one.mean[c], none.mean[c] + 0.02 * all.mean[c]) << c << ": is no part";
    EXPECT_GT(other.mean[c], none.mean[c] + 0.02 * all.mean[c]) << c << ": is no part";
  }
}

/// Of a surface that is diffuse in part, and in each channel in another, each part counts by its
/// share: of the light of a lamp, and of a wall that is lit by one.
TEST(RayVisibility, PartsOfASurfaceAddUp) {
  const std::string shown =
      ball_of("{type: principled, base_color: [0.8, 0.4, 0.1], roughness: 0.5, ior: 2}");
  const std::string open = ", visible_to_shadow: false";
  const std::string no_diffuse = ", visible_to_diffuse: false";
  const std::string no_glossy = ", visible_to_glossy: false";
  const auto of_sky = [&](const std::string& sky) {
    return picture_mean(YamlScene(within_dome(shown, open, sky, 2000)).render().film);
  };
  expect_sum(of_sky(no_diffuse), of_sky(no_glossy), of_sky(""), of_sky(no_diffuse + no_glossy));
  const auto of_wall = [&](const std::string& wall) {
    // Not by more than two events: else walls that do not see each other are less bright, too.
    std::string text = within_dome(shown, open + wall, "", 4000) + "integrator: {max_depth: 2}\n";
    text.replace(text.find("soot: {type: black}"), 19, "soot: {type: lambert, color: 0.5}");
    return picture_mean(YamlScene(text).render().film);
  };
  expect_sum(of_wall(no_diffuse), of_wall(no_glossy), of_wall(""), of_wall(no_diffuse + no_glossy));
}

/// Fog in a dome that its rays do not see, nor shadow rays, is as fog without a dome.
TEST(RayVisibility, MediaAreLitByTheirOwnKind) {
  const std::string fog =
      "materials: {soot: {type: black}, air: {type: \"null\"}}\nmedia: {fog: {scattering: [2, 1, "
      "0.5], g: "
      "0.3}}\nobjects:\n  cloud: {shape: sphere, radius: 0.5, material: air, interior: fog}\n";
  const std::string hidden = ", visible_to_shadow: false, visible_to_camera: false";
  // The sky shines through: all that comes is its radiance, for the fog takes none away.
  expect_mean(within_dome(fog, hidden + ", visible_to_volume: false", ""), Vec3d(kSky));
  expect_mean(within_dome(fog, hidden, ""), Vec3d(kSky));
  // What is scattered is lit by nothing: what is left is the sky straight through a ball of fog.
  const YamlScene lit(within_dome(fog, hidden, ""));
  const YamlScene unlit(within_dome(fog, hidden, ", visible_to_volume: false"));
  const PictureMean through = picture_mean(unlit.render().film);
  for (int c = 0; c < 3; ++c) {
    const double depth = c == 0 ? 2.0 : c == 1 ? 1.0 : 0.5;
    EXPECT_GT(through.mean[c], kSky * std::exp(-depth) - 5.0 * through.sigma[c]) << c;
    EXPECT_LT(through.mean[c], kSky * std::exp(-0.97 * depth) + 5.0 * through.sigma[c]) << c;
  }
}

/// What is off for a group is off for all in it, and for what instances make of it.
TEST(RayVisibility, GroupsHaveASay) {
  std::string text = within_dome(kMatt, "", "");
  const size_t dome = text.find("  dome:");
  const std::string alone = text.substr(dome + 8, text.find('\n', dome) - dome - 8);
  const size_t length = alone.size() + 8;
  std::string grouped = text;
  grouped.replace(dome, length,
                  "  hall: {visible_to_shadow: false, group: {objects: {dome: " + alone + "}}}");
  expect_mean(grouped, kSky * kColor);
  std::string copied = text;
  copied.replace(dome, length, "  hall: {visible_to_shadow: false, instance: built}");
  expect_mean(copied + "groups: {built: {objects: {dome: " + alone + "}}}\n", kSky * kColor);
  // A lamp in a group that is hidden is not chosen, either.
  std::string lamp = grouped;
  lamp.replace(lamp.find("radius: 3"), 9, "radius: 3, emit: {radiance: 3, two_sided: true}");
  expect_mean(lamp, (kSky + 3.0) * kColor);
  lamp.replace(lamp.find("visible_to_shadow"), 0, "visible_to_diffuse: false, ");
  expect_mean(lamp, kSky * kColor);
}

/// Lights without a body light the parts of surfaces that they are said to; of those with a size,
/// and of suns, mirrors show as much.
TEST(RayVisibility, LightsOfPlacesAndDirections) {
  const std::string open = ", visible_to_shadow: false, visible_to_glossy: false";
  const auto mean_of = [&](const std::string& shown, const std::string& light) {
    std::string text = within_dome(shown, open, "", 400) + "lights: {lamp: {" + light + "}}\n";
    text.replace(text.find("color: 2"), 8, "color: 0");
    return picture_mean(YamlScene(text).render().film).mean;
  };
  for (const std::string light : {"type: point, at: [0, 0, 2.5], power: 100",
                                  "type: point, at: [0, 0, 2.5], power: 100, radius: 0.4",
                                  "type: sun, direction: [0, 0, -1], angle: 20"}) {
    SCOPED_TRACE(light);
    const bool is_point = light.ends_with("power: 100");
    for (const std::string& shown : {kMatt, kMirror}) {
      const bool matt = shown == kMatt;
      const char* own = matt ? ", visible_to_diffuse: false" : ", visible_to_glossy: false";
      const char* other = matt ? ", visible_to_glossy: false" : ", visible_to_diffuse: false";
      const Vec3d plain = mean_of(shown, light);
      const Vec3d same = mean_of(shown, light + other + ", visible_to_volume: false");
      EXPECT_EQ(mean_of(shown, light + own), Vec3d(0.0));
      if (is_point && !matt) continue;  // which mirrors do not show
      for (int c = 0; c < 3; ++c) {
        EXPECT_GT(plain[c], 0.0);
        EXPECT_NEAR(same[c], plain[c], 0.02 * plain[c]);
      }
    }
  }
}

/// Rays are not in a body that they do not see: below a case of glass that casts no shadow a floor
/// in absorbing air is lit as if there were none.
TEST(RayVisibility, WhatIsNotSeenIsNotAround) {
  const std::string text = R"(
hyades: 1
name: case
film: {size: [8, 8]}
sampling: {samples: 64, sampler: independent}
integrator: {max_depth: 1}
camera: {look_from: [0, 0.5, 0], look_at: [0, 0, 0], up: [0, 0, -1], fov: 0.1}
materials: {white: {type: lambert, color: 0.5}, glass: {type: dielectric}}
media: {air: {absorption: [1, 0.5, 0]}}
objects:
  floor: {shape: rectangle, size: [0.1, 0.1], material: white}
  case: {shape: box, size: [2, 2, 2], material: glass, visible_to_shadow: false}
lights: {lamp: {type: point, at: [0, 2, 0], power: 50}}
atmosphere: air
)";
  // The camera is in the case, where there is no air.
  const double straight = 0.5 / M_PI * 50.0 / (4.0 * M_PI * 4.0);
  expect_mean(text, straight * Vec3d(std::exp(-2.0), std::exp(-1.0), 1.0));
}

/// A ball before a wall, below an even sky.
std::string hole(const std::string& integrator, const std::string& ball) {
  return "hyades: 1\nname: hole\nfilm: {size: [24, 24], filter: {type: box, radius: 0.5}}\n"
         "sampling: {samples: 8}\nintegrator: " +
         integrator +
         "\ncamera: {look_from: [0, 0, 6], look_at: [0, 0, 0], fov: 30}\n"
         "materials: {red: {type: lambert, color: [0.8, 0.1, 0.1]}, air: {type: \"null\"}}\n"
         "media: {fog: {absorption: 60, scattering: 40, emission: 1}}\n"
         "groups: {balls: {objects: {ball: {shape: sphere, radius: 0.7, material: red}}}}\n"
         "objects:\n"
         "  wall: {shape: rectangle, size: [4, 4], transform: [{rotate_x: 90}], at: [0, 0, -1]}\n"
         "  ball: {" +
         ball + "}\nenvironment: {color: 1}\n";
}

/// Where the camera sees a holdout nothing is; all else stays as it is, to the bit.
TEST(Holdout, IsAHoleForTheCameraAlone) {
  const std::string sphere = "shape: sphere, radius: 0.7, ";
  const std::string cylinder =
      "group: {objects: {a: {shape: cylinder, radius: 0.7, height: 1, transform: [{rotate_x: "
      "90}]}}}";
  for (const std::string& ball :
       {sphere + "material: red, emit: {radiance: 0.5}", sphere + "material: air, interior: fog",
        std::string("instance: balls"), cylinder}) {
    for (const std::string integrator : {"path", "bdpt", "mlt", "{type: mlt, over: path}"}) {
      SCOPED_TRACE(integrator + ": " + ball);
      const core::Image plain = YamlScene(hole(integrator, ball)).render().film.normalised();
      const core::Image held =
          YamlScene(hole(integrator, ball + ", holdout: true")).render().film.normalised();
      const int alpha = held.find_channel("A");
      ASSERT_GE(alpha, 0);
      double behind = 0.0;
      double before = 0.0;
      for (int y = 0; y < 24; ++y) {
        for (int x = 0; x < 24; ++x) {
          const double r2 = (x - 11.5) * (x - 11.5) + (y - 11.5) * (y - 11.5);
          if (r2 < 20.0) {  // well within the ball
            EXPECT_EQ(held.at(x, y, alpha), 0.0F);
            for (int c = 0; c < 3; ++c) EXPECT_EQ(held.at(x, y, c), 0.0F);
          } else if (r2 > 60.0) {
            EXPECT_EQ(held.at(x, y, alpha), plain.at(x, y, alpha));
            behind += static_cast<double>(held.at(x, y, 0));
            before += static_cast<double>(plain.at(x, y, 0));
          }
        }
      }
      const bool same = integrator == "path";
      EXPECT_NEAR(behind, before, same ? 0.0 : 0.1 * before);  // splats of others come down here
    }
  }
}

/// Light paths cannot tell rays apart.
TEST(RayVisibility, LightPathsRefuseIt) {
  const auto refused = [](const std::string& objects) {
    for (const char* integrator : {"bdpt", "mlt"}) {
      try {
        (void)YamlScene(std::string("hyades: 1\nintegrator: ") + integrator + "\n" + objects);
        ADD_FAILURE() << integrator << " takes " << objects;
      } catch (const std::exception& error) {
        EXPECT_NE(std::string(error.what()).find("expected integrator: path"), std::string::npos)
            << error.what();
      }
    }
    (void)YamlScene("hyades: 1\n" + objects);
  };
  refused("objects: {a: {shape: sphere, visible_to_shadow: false}}\n");
  refused("objects: {a: {group: {objects: {b: {shape: sphere, visible_to_glossy: false}}}}}\n");
  refused("lights: {a: {type: sun, visible_to_volume: false}}\n");
  refused("lights: {a: {type: sun, shadow_linking: {include: []}}}\n");
  refused("environment: {visible_to_diffuse: false}\n");
}

}  // namespace
}  // namespace hyades::test
