// What every camera keeps: generate() and connect() are each other's inverse, and densities are
// what neighbouring rays say.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "core/base/frame.h"
#include "core/base/hash.h"
#include "core/cameras/make_camera.h"

namespace hyades::core {
namespace {

struct Kind {
  const char* name;
  std::function<std::unique_ptr<Camera>()> make;
};

void PrintTo(const Kind& kind, std::ostream* out) { *out << kind.name; }

constexpr Vec2i kFilm(40, 20);

CameraPose pose(float lens_radius, const Vec2& shift = Vec2(0.0F)) {
  CameraPose pose;
  pose.from = {1.0F, 2.0F, 5.0F};
  pose.at = {0.5F, 0.3F, -1.0F};
  pose.up = {0.2F, 1.0F, 0.1F};
  pose.fov = 0.9F;
  pose.height = 3.0F;
  pose.lens_radius = lens_radius;
  pose.focus_distance = 4.0F;
  pose.shift = shift;
  return pose;
}

std::vector<CameraPose> moving(float lens_radius) {
  CameraPose later = pose(lens_radius, {0.3F, -0.2F});
  later.from = {0.0F, 2.5F, 4.0F};
  later.at = {-0.5F, 0.6F, -1.2F};
  later.height = 2.0F;
  later.focus_distance = 3.0F;
  return {pose(lens_radius), later};
}

const Kind kKinds[] = {
    {"perspective", [] { return make_perspective_camera({pose(0.0F)}, kFilm, {}); }},
    {"shifted",
     [] {
       return make_perspective_camera({pose(0.0F, {0.7F, -1.2F})}, kFilm, {});
     }},
    {"shifted_pentagon",
     [] {
       return make_perspective_camera({pose(0.4F, {-0.4F, 0.8F})}, kFilm, {5, 0.3F});
     }},
    {"moving_lens", [] { return make_perspective_camera(moving(0.3F), kFilm, {}); }},
    {"orthographic", [] { return make_orthographic_camera({pose(0.0F)}, kFilm, {}); }},
    // Rays that slant by up to 27 degrees.
    {"orthographic_hexagon",
     [] {
       return make_orthographic_camera({pose(2.0F)}, kFilm, {6, 0.1F});
     }},
    {"moving_orthographic_lens", [] { return make_orthographic_camera(moving(0.5F), kFilm, {}); }},
    {"equirectangular", [] { return make_equirectangular_camera({pose(0.0F)}, kFilm); }},
    {"moving_equirectangular", [] { return make_equirectangular_camera(moving(0.0F), kFilm); }},
};

/// Numbers of one try, in [0, 1).
struct Numbers {
  explicit Numbers(uint64_t name) : key(name) {}
  float next() { return static_cast<float>(hash_combine(key, ++count) >> 40U) * 0x1p-24F; }
  uint64_t key;
  uint64_t count = 0;
};

class AllCameras : public testing::TestWithParam<Kind> {
 protected:
  /// Calls `test` with rays all over the film and their connections to a place on them.
  void for_rays(const std::function<void(const Camera&, const Vec2& film, const Vec2& lens,
                                         const Ray&, const CameraConnection&)>& test) const {
    const auto camera = GetParam().make();
    for (uint64_t i = 0; i < 2000; ++i) {
      Numbers u(i);
      const Vec2 film(u.next() * kFilm.x, 0.2F + u.next() * (kFilm.y - 0.4F));
      const Vec2 lens(u.next(), u.next());
      const Ray ray = camera->generate(film, lens, u.next());
      const auto seen =
          camera->connect(ray.origin + ray.direction * (0.5F + 9.0F * u.next()), lens, ray.time);
      ASSERT_TRUE(seen);
      test(*camera, film, lens, ray, *seen);
    }
  }
};

float distance(const Vec3& a, const Vec3& b) { return glm::length(a - b); }

TEST_P(AllCameras, ConnectIsTheInverseOfGenerate) {
  for_rays([](const Camera&, const Vec2& film, const Vec2&, const Ray& ray,
              const CameraConnection& seen) {
    EXPECT_NEAR(seen.film.x, film.x, 2e-3F);
    EXPECT_NEAR(seen.film.y, film.y, 2e-3F);
    EXPECT_LT(distance(seen.position, ray.origin), 1e-5F);
    EXPECT_LT(distance(seen.direction, ray.direction), 1e-5F);
    EXPECT_NEAR(glm::length(ray.direction), 1.0F, 1e-5F);
  });
}

/// Places beside the connected one, across the ray, are beside it on the film.
TEST_P(AllCameras, DensityIsThatOfNeighbouringRays) {
  for_rays([](const Camera& camera, const Vec2& film, const Vec2& lens, const Ray& ray,
              const CameraConnection& seen) {
    if (film.x < 1.0F || film.x > kFilm.x - 1.0F) return;
    const Frame frame = Frame::around(seen.direction);
    const float step = 2e-3F * seen.distance;
    const auto moved = [&](const Vec3& way) {
      const Vec3 point = seen.position + seen.direction * seen.distance;
      const auto ahead = camera.connect(point + way * step, lens, ray.time);
      const auto behind = camera.connect(point - way * step, lens, ray.time);
      return ahead && behind ? (ahead->film - behind->film) / (2.0F * step) : Vec2(0.0F);
    };
    const Vec2 a = moved(frame.s);
    const Vec2 b = moved(frame.t);
    const double area = std::abs(static_cast<double>(a.x) * b.y - static_cast<double>(a.y) * b.x);
    EXPECT_NEAR(seen.across / area, 1.0, 0.02) << film.x << ' ' << film.y;
  });
}

TEST_P(AllCameras, DensityOfDirectionsIsThatOfConnections) {
  for_rays([](const Camera& camera, const Vec2&, const Vec2&, const Ray& ray,
              const CameraConnection& seen) {
    const double distance = static_cast<double>(seen.distance);
    const double expected =
        camera.rays_are_parallel() ? seen.across : seen.across * distance * distance;
    EXPECT_NEAR(camera.film_density(ray.direction, ray.time) / expected, 1.0, 1e-4);
  });
}

/// By a regular grid over the sphere, where rays through a place of the lens differ in direction.
TEST_P(AllCameras, DensityIntegratesToTheFilm) {
  const auto camera = GetParam().make();
  if (camera->rays_are_parallel()) GTEST_SKIP() << "its rays have no density per solid angle";
  constexpr int kRows = 600;
  double film = 0.0;
  for (int row = 0; row < kRows; ++row) {
    const double z = (row + 0.5) / kRows * 2.0 - 1.0;
    for (int column = 0; column < 2 * kRows; ++column) {
      const double azimuth = (column + 0.5) / kRows * 3.14159265358979;
      const double sine = std::sqrt(1.0 - z * z);
      const Vec3 direction(Vec3d(sine * std::cos(azimuth), sine * std::sin(azimuth), z));
      const Vec2 lens(0.3F, 0.6F);
      const Vec3 origin = camera->generate({20.0F, 10.0F}, lens, 0.4F).origin;
      const auto seen = camera->connect(origin + 1e3F * direction, lens, 0.4F);
      if (!seen || seen->film.x < 0.0F || seen->film.x > kFilm.x || seen->film.y < 0.0F ||
          seen->film.y > kFilm.y) {
        continue;
      }
      film += static_cast<double>(camera->film_density(direction, 0.4F)) * 4.0 * 3.14159265358979 /
              (2.0 * kRows * kRows);
    }
  }
  EXPECT_NEAR(film / (kFilm.x * kFilm.y), 1.0, 0.01);
}

TEST_P(AllCameras, PlacesOfTheFilmAreThoseWithTheSameRay) {
  for_rays([](const Camera& camera, const Vec2& film, const Vec2& lens, const Ray& ray,
              const CameraConnection&) {
    std::vector<Vec2> places;
    camera.add_places(film, Vec2(-10.0F), Vec2(kFilm) + 10.0F, places);
    ASSERT_FALSE(places.empty());
    bool itself = false;
    for (const Vec2& place : places) {
      itself |= glm::length(place - film) < 1e-4F;
      EXPECT_TRUE(place.x > -10.0F && place.x < kFilm.x + 10.0F && place.y > -10.0F &&
                  place.y < kFilm.y + 10.0F);
      EXPECT_LT(distance(camera.generate(place, lens, ray.time).direction, ray.direction), 1e-5F);
    }
    EXPECT_TRUE(itself);
    places.clear();
    camera.add_places(film, {film.x + 0.1F, 0.0F}, {film.x + 0.2F, 20.0F}, places);
    EXPECT_TRUE(places.empty());
  });
}

/// Of the ray through the middle of the lens: as wide as its neighbours are apart, in the mean over
/// both directions.
TEST_P(AllCameras, PixelsCoverWhatLiesBetweenTheirRays) {
  if (std::string(GetParam().name).find("gon") != std::string::npos) {
    GTEST_SKIP() << "no number in the middle of the square stands for the middle of a polygon";
  }
  for_rays([](const Camera& camera, const Vec2& film, const Vec2&, const Ray& any,
              const CameraConnection& seen) {
    if (film.y < 1.0F || film.y > kFilm.y - 1.0F) return;
    const Vec2 middle(0.5F);
    const Ray ray = camera.generate(film, middle, any.time);
    const Vec3 point = ray.origin + ray.direction * seen.distance;
    const auto sharp = camera.connect(point, middle, any.time);
    const PixelCone cone = camera.pixel_at(point, any.time);
    EXPECT_NEAR(cone.width * std::sqrt(sharp->across), 1.0, 1e-3);
    EXPECT_LT(distance(cone.direction, ray.direction), 1e-4F);
  });
}

INSTANTIATE_TEST_SUITE_P(Kinds, AllCameras, testing::ValuesIn(kKinds),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace hyades::core
