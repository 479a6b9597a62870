// T19: the components of light, and its groups, add up to beauty, in every integrator; and every
// scattering is called by its name.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "tests/truth/render_yaml.h"

namespace hyades::test {
namespace {

const char* const kEverything = R"yaml(
hyades: 1
name: everything
film: {size: [20, 16], filter: {type: mitchell, radius: 2}}
camera: {look_from: [0, 1, 3.4], look_at: [0, 0.8, 0], fov: 45, aperture: {radius: 0.02}}
materials:
  white: {type: lambert, color: [0.7, 0.6, 0.5]}
  shiny: {type: glossy, color: [0.2, 0.4, 0.6], reflectiveness: 0.6, glossiness: 0.7}
  polished: {type: glossy, color: [0.6, 0.4, 0.6], reflectiveness: 0.5, glossiness: 1}
  glass: {type: dielectric, ior: 1.5}
  pane: {type: thin-dielectric}
  frosted: {type: dielectric, ior: 1.4, roughness: 0.5}
  skin: {type: dielectric, ior: 1.4, roughness: 0.5, subsurface: {color: [0.8, 0.4, 0.3], radius: 0.1}}
  leaf: {type: lambert, color: [0.2, 0.7, 0.1], opacity: 0.5}
media:
  fog: {scattering: 0.2, absorption: 0.02, g: 0.4}
  fire: {absorption: 0.5, scattering: [0.3, 0.1, 0], emission: [2, 1, 0.2], light_group: fire}
objects:
  floor: {shape: rectangle, size: [4, 4], material: white}
  back: {shape: rectangle, size: [3, 4], transform: [{rotate_x: 90}], at: [0, 1, -1], material: shiny}
  shelf: {shape: rectangle, size: [1, 1], transform: [{rotate_z: 20}], at: [-1, 0.9, 0], material: polished}
  ball: {shape: sphere, radius: 0.3, at: [0.3, 0.4, 0.6], material: glass}
  frosted: {shape: sphere, radius: 0.3, at: [-0.5, 0.4, 0.6], material: frosted}
  head: {shape: sphere, radius: 0.25, at: [0.9, 0.4, 0.2], material: skin}
  leaf: {shape: disk, radius: 0.3, transform: [{rotate_x: 70}], at: [0, 1.3, 0.8], material: leaf}
  window: {shape: disk, radius: 0.4, transform: [{rotate_x: 80}], at: [0.9, 1.2, 0.8], material: pane}
  haze: {shape: sphere, radius: 5, material: smoke, interior: fog}
  flame: {shape: sphere, radius: 0.25, at: [-0.6, 1.2, 0], material: smoke, interior: fire}
  lamp: {shape: rectangle, size: [0.5, 0.5], transform: [{rotate_x: 180}], at: [0.3, 1.9, 0], emit: {radiance: 9, light_group: key}}
lights:
  bulb: {type: point, at: [-0.9, 1.6, 0.9], power: 6, light_group: fill}
  sun: {type: sun, direction: [1, -2, -1], irradiance: 0.4, angle: 8}
environment: {color: [0.1, 0.15, 0.3], light_group: sky}
)yaml";

std::string everything(const std::string& more) {
  std::string text = kEverything;
  const size_t smoke = text.find("media:");
  text.insert(smoke, "  smoke: {type: \"null\"}\n");
  return text + more;
}

core::LayerSet all_parts() {
  core::LayerSet layers;
  layers.components.fill(true);
  layers.light_groups = {"fill", "fire", "key", "rest", "sky"};
  return layers;
}

std::vector<std::string> components() {
  std::vector<std::string> names;
  for (size_t i = 0; i < core::kLightComponents; ++i)
    names.emplace_back(core::name_of(static_cast<core::LightComponent>(i)));
  return names;
}

const std::vector<std::string> kGroups = {"light_group_fill", "light_group_fire", "light_group_key",
                                          "light_group_rest", "light_group_sky"};

/// The largest difference between beauty and the sum of `layers`, relative to the picture's mean.
double worst_difference(const core::Image& picture, const std::vector<std::string>& layers) {
  double worst = 0.0;
  double mean = 0.0;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      for (int c = 0; c < 3; ++c) {
        double sum = 0.0;
        for (const std::string& layer : layers) {
          const int first = picture.find_channel(layer + ".R");
          EXPECT_GE(first, 0) << layer;
          sum += static_cast<double>(picture.at(x, y, first + c));
        }
        const auto beauty = static_cast<double>(picture.at(x, y, c));
        worst = std::max(worst, std::abs(sum - beauty));
        mean += std::abs(beauty);
      }
    }
  }
  return worst / (mean / (3.0 * picture.width * picture.height));
}

class LightParts : public ::testing::TestWithParam<const char*> {};

TEST_P(LightParts, AddUpToBeauty) {
  const YamlScene scene(everything("sampling: {samples: 32}\n" + std::string(GetParam())), 1,
                        all_parts());
  const core::RenderedFrame frame = scene.render();
  const core::Image picture = frame.film.normalised();
  EXPECT_LT(worst_difference(picture, components()), 1e-5);
  EXPECT_LT(worst_difference(picture, kGroups), 1e-5);
  // Every part has its share, so that none could be left out.
  std::vector<std::string> all = components();
  all.insert(all.end(), kGroups.begin(), kGroups.end());
  for (const std::string& layer : all) {
    double sum = 0.0;
    const int first = picture.find_channel(layer + ".R");
    for (int y = 0; y < picture.height; ++y) {
      for (int x = 0; x < picture.width; ++x) sum += static_cast<double>(picture.at(x, y, first));
    }
    EXPECT_GT(std::abs(sum), 1e-4) << layer;
  }
  // And telling them apart changes nothing of the rest.
  const YamlScene plain(everything("sampling: {samples: 32}\n" + std::string(GetParam())));
  const core::RenderedFrame plain_frame = plain.render();
  const core::Image beauty = plain_frame.film.normalised();
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      for (int c = 0; c < 3; ++c) ASSERT_EQ(picture.at(x, y, c), beauty.at(x, y, c));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(T19, LightParts,
                         ::testing::Values("integrator: {type: path, max_depth: 6}",
                                           "integrator: {type: path, max_depth: 6, clamp: 0.5}",
                                           "integrator: {type: bdpt, max_depth: 5}",
                                           "integrator: {type: mlt, max_depth: 5}",
                                           "integrator: {type: mlt, over: path, max_depth: 5}"));

/// A floor seen from above under a lamp, and what its light is called.
struct Named {
  const char* name;
  const char* material;
  const char* more;  ///< objects, lights, settings
  std::vector<std::string> expected;
};

constexpr const char* kLamp = R"(
lights: {lamp: {type: sun, direction: [0.3, -1, 0], angle: 30, irradiance: 3}})";

// Every case has light of the expected kinds and of no other.
TEST(LightPartNames, AreThoseOfTheFirstEvent) {
  const std::string wall = R"(
  wall: {shape: rectangle, size: [9, 9], transform: [{rotate_z: 90}], at: [3, 0, 0], material: grey})";
  const Named cases[] = {
      {"a dull floor", "{type: lambert, color: 0.5}", kLamp, {"diffuse_direct"}},
      {"a rough metal", "{type: conductor, metal: gold, roughness: 0.6}", kLamp, {"glossy_direct"}},
      {"a mirror", "{type: mirror}", "\nenvironment: {color: 1}", {"glossy_direct"}},
      {"a pane over a lamp",
       "{type: dielectric, ior: 1.5, roughness: 0.4}",
       "\n  lamp: {shape: rectangle, size: [9, 9], at: [0, -1, 0], emit: {radiance: 1}}",
       {"transmission_direct", "transmission_indirect"}},
      {"a lamp",
       "{type: black}",
       "\n  lamp: {shape: disk, at: [0, 1, 0], emit: {radiance: 1}}",
       {"emission"}},
      {"the sky", "{type: \"null\"}", "\nenvironment: {color: 1}", {"environment"}},
      {"a glossy floor",
       "{type: glossy, color: 0.5, reflectiveness: 0.5, glossiness: 0.5}",
       kLamp,
       {"diffuse_direct", "glossy_direct"}},
      {"a fog before the black",
       "{type: black}",
       "\nmedia: {fog: {scattering: 0.3}}\natmosphere: fog\nlights: {lamp: {type: point, at: [0, "
       "1, 0], power: 9}}",
       {"volume_direct", "volume_indirect"}},
  };
  for (const char* integrator : {"path", "bdpt", "mlt"}) {
    for (const Named& c : cases) {
      SCOPED_TRACE(std::string(integrator) + ": " + c.name);
      const std::string text = R"(
hyades: 1
name: named
film: {size: [8, 8], filter: box}
sampling: {samples: 16}
camera: {look_from: [0, 4, 0.1], look_at: [0, 0, 0], fov: 25}
materials: {seen: )" + std::string(c.material) +
                               R"(, grey: {type: lambert, color: 0.5}}
integrator: {type: )" + integrator +
                               R"(, max_depth: 3}
objects:
  floor: {shape: rectangle, size: [4, 4], material: seen})" +
                               c.more + "\n";
      const YamlScene scene(text, 1, all_parts());
      const core::RenderedFrame frame = scene.render();
      const core::Image picture = frame.film.normalised();
      for (const std::string& layer : components()) {
        double sum = 0.0;
        const int first = picture.find_channel(layer + ".R");
        for (int y = 0; y < 8; ++y) {
          for (int x = 0; x < 8; ++x) sum += static_cast<double>(picture.at(x, y, first));
        }
        const bool expected =
            std::find(c.expected.begin(), c.expected.end(), layer) != c.expected.end();
        EXPECT_EQ(sum > 1e-6, expected) << layer << " holds " << sum;
      }
    }
  }
}

// Whatever strategy finds a path, its light goes to the same part.
TEST(LightPartNames, AreTheSameInAllIntegrators) {
  constexpr int kRuns = 16;
  const std::vector<std::string> names = components();
  const auto means = [&](const std::string& integrator, int samples) {
    std::array<Moments, core::kLightComponents + 4> moments;
    for (int run = 0; run < kRuns; ++run) {
      const YamlScene scene(everything("sampling: {samples: " + std::to_string(samples) +
                                       ", seed: " + std::to_string(run) + "}\n" + integrator),
                            1, all_parts());
      const core::RenderedFrame frame = scene.render();
      const core::Image picture = frame.film.normalised();
      for (size_t i = 0; i < moments.size(); ++i) {
        const int first =
            picture.find_channel((i < names.size() ? names[i] : kGroups[i - names.size()]) + ".R");
        double sum = 0.0;
        for (int y = 0; y < picture.height; ++y) {
          for (int x = 0; x < picture.width; ++x)
            sum += static_cast<double>(picture.at(x, y, first) + picture.at(x, y, first + 1));
        }
        moments[i].add(sum);
      }
    }
    return moments;
  };
  const auto path = means("integrator: {type: path, max_depth: 3}", 64);
  const auto bdpt = means("integrator: {type: bdpt, max_depth: 3}", 32);
  const auto mlt = means("integrator: {type: mlt, max_depth: 3}", 32);
  const double alpha = sidak(0.01, 2 * static_cast<int>(path.size()));
  for (size_t i = 0; i < path.size(); ++i) {
    const std::string name = i < names.size() ? names[i] : kGroups[i - names.size()];
    EXPECT_GE(t_test(path[i], bdpt[i]), alpha)
        << name << ": path " << path[i].mean() << ", bdpt " << bdpt[i].mean();
    EXPECT_GE(t_test(path[i], mlt[i]), alpha)
        << name << ": path " << path[i].mean() << ", mlt " << mlt[i].mean();
    // A third of a part's light in another one would be seen.
    const double spread = path[i].variance_of_mean() + bdpt[i].variance_of_mean();
    EXPECT_LT(detectable_effect(spread, alpha, 0.99), 0.33 * path[i].mean()) << name;
  }
}

}  // namespace
}  // namespace hyades::test
