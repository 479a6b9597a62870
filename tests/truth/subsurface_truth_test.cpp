// Bodies that are told by their colour have that colour.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "core/media/albedo_inversion.h"
#include "tests/truth/render_yaml.h"

namespace hyades::test {
namespace {

using core::Vec3d;

/// Gauss and Legendre's nodes and weights over [0, 1]: the directions from which a slab is seen.
constexpr std::array<std::array<double, 2>, 4> kNodes = {{{0.06943184420297, 0.17392742256873},
                                                          {0.33000947820757, 0.32607257743127},
                                                          {0.66999052179243, 0.32607257743127},
                                                          {0.93056815579703, 0.17392742256873}}};

struct Reflectance {
  Vec3d mean{0.0};
  Vec3d sigma{0.0};
};

/// What a thick slab of `material` sends back of diffuse light (a uniform sky), averaged over the
/// directions that it leaves by: the spherical albedo.
Reflectance slab_reflectance(const std::string& material, int samples) {
  Reflectance sum;
  for (const auto& [mu, weight] : kNodes) {
    const YamlScene scene(R"(
hyades: 1
film: {size: [8, 8], filter: box}
sampling: {samples: )" + std::to_string(samples) +
                          R"(, seed: 5, sampler: independent}
integrator: {type: path, max_depth: 20000, roulette_depth: 64}
camera: {look_from: [)" + std::to_string(std::sqrt(1.0 - mu * mu)) +
                          ", " + std::to_string(mu) +
                          R"(, 0], look_at: [0, 0, 0], fov: 0.001}
materials: {body: )" + material +
                          R"(}
objects: {slab: {shape: box, size: [4000, 400, 4000], at: [0, -200, 0], material: body}}
environment: {color: 1}
)");
    const PictureMean seen = picture_mean(scene.render().film);
    sum.mean += 2.0 * mu * weight * seen.mean;
    for (int c = 0; c < 3; ++c) {
      sum.sigma[c] = std::hypot(sum.sigma[c], 2.0 * mu * weight * seen.sigma[c]);
    }
  }
  return sum;
}

std::string body(const char* surface, const char* color, const char* g) {
  return std::string("{type: ") + surface + ", subsurface: {radius: 0.5, color: " + color +
         ", g: " + g + "}}";
}

/// Each channel within `tolerance` of `expected`, four standard errors of ours aside; an error of
/// five times `most_sigma` more is noticed with 84 %.
void expect_near(const Reflectance& found, const Vec3d& expected, double tolerance,
                 double most_sigma = 0.004) {
  for (int c = 0; c < 3; ++c) {
    EXPECT_LT(found.sigma[c], most_sigma) << "underpowered";
    EXPECT_NEAR(found.mean[c], expected[c], tolerance + 4.0 * found.sigma[c]) << "channel " << c;
  }
}

// Without a surface: van de Hulst's formula is within 0.002 of the truth (measured with 2048
// samples: 0.0015 at most).
TEST(SubsurfaceTruth, SlabsHaveTheirColor) {
  expect_near(slab_reflectance(body("\"null\"", "[0.1, 0.3, 0.5]", "0"), 160), {0.1, 0.3, 0.5},
              0.0025);
  expect_near(slab_reflectance(body("\"null\"", "[0.7, 0.9, 0.97]", "0"), 160), {0.7, 0.9, 0.97},
              0.0025);
}

TEST(SubsurfaceTruth, SlabsHaveTheirColorWhateverTheMeanCosine) {
  expect_near(slab_reflectance(body("\"null\"", "[0.2, 0.5, 0.8]", "0.8"), 160), {0.2, 0.5, 0.8},
              0.004);
  expect_near(slab_reflectance(body("\"null\"", "[0.2, 0.5, 0.8]", "-0.5"), 160), {0.2, 0.5, 0.8},
              0.012);
}

// Behind glass light comes in steeper than diffuse light does, so dark colours are a little darker
// (measured with 2048 samples: by 0.020, 0.031 and 0.010; 0.9 and 0.97 by
// 0.002).
TEST(SubsurfaceTruth, SlabsBehindGlassHaveTheirColorOfTheLightThatIsLetIn) {
  const double outer = core::diffuse_fresnel(1.4F).outer;
  const auto seen = [&](double color) { return outer + (1.0 - outer) * color; };
  const auto found = slab_reflectance(body("dielectric, ior: 1.4", "[0.1, 0.3, 0.7]", "0"), 160);
  expect_near(found, {seen(0.08), seen(0.27), seen(0.69)}, 0.004);
}

// Rough glass that loses nothing (0.97 became 0.63 when it did) looks the same but for grazing
// angles (measured with 400 samples: 0.717 and 0.971 for the first and the last).
TEST(SubsurfaceTruth, SlabsBehindRoughGlassHaveTheirColorToo) {
  const double outer = core::diffuse_fresnel(1.4F).outer;
  const auto seen = [&](double color) { return outer + (1.0 - outer) * color; };
  const auto found =
      slab_reflectance(body("dielectric, ior: 1.4, roughness: 0.6", "[0.7, 0.9, 0.97]", "0"), 56);
  expect_near(found, {seen(0.69), seen(0.9), seen(0.97)}, 0.006, 0.009);
}

}  // namespace
}  // namespace hyades::test
