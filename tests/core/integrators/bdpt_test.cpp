// Bidirectional path tracing, sample by sample, where chance alone would seldom come.
#include "core/integrators/bdpt.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/core/integrators/scene_of.h"

namespace hyades::core {
namespace {

/// Independent numbers, but the first place that is chosen on a lamp lies where `rim` says.
class RimSampler final : public Sampler {
 public:
  Vec2 rim{0.0F};

  void start(const SampleId& id) override { others_->start(id); }
  void set_dimension(uint32_t dimension) override {
    at_lamp_ = dimension == kCameraDimensions;
    others_->set_dimension(dimension);
  }
  float next_1d() override { return others_->next_1d(); }
  Vec2 next_2d() override { return others_->next_2d(); }
  Vec4 next_4d() override {
    Vec4 u = others_->next_4d();
    if (at_lamp_) u = {rim.x, rim.y, u.z, u.w};
    at_lamp_ = false;
    return u;
  }

 private:
  std::unique_ptr<Sampler> others_ = make_sampler(SamplerKind::independent);
  bool at_lamp_ = false;
};

// Of a ball the rim is seen edge-on: no light path leaves it that way, and densities per area
// vanish.
TEST(Bdpt, PlacesOnALampThatAreSeenEdgeOnCountFinitely) {
  const TestScene test(R"yaml(
integrator: {type: bdpt, max_depth: 2}
camera: {look_from: [0, 2, 3], look_at: [0, 0, 0]}
objects:
  floor: {shape: rectangle, size: [4, 4]}
  lamp: {shape: sphere, radius: 0.3, at: [0.4, 1.5, 0.2], emit: {radiance: 5}}
)yaml");
  const Ray ray =
      test.scene->camera->generate(Vec2(test.scene->resolution) * 0.5F, {0.5F, 0.5F}, 0.0F);
  const auto hit = test.scene->world->intersect(ray, RayKind::camera);
  ASSERT_TRUE(hit);
  const Vec3 from = test.scene->world->surface(ray, *hit).position;
  const auto integrator = make_integrator(test.job.integrator);
  RimSampler sampler;
  Workspace work;
  int edge_on = 0;
  for (uint32_t i = 0; i < 20000; ++i) {
    sampler.rim = {0.0F, static_cast<float>(i) / 20000.0F};
    const auto place = test.scene->lights[0]->sample_direct(from, 0.0F, 0.5F, sampler.rim);
    edge_on += place && glm::dot(place->normal, place->direction) == 0.0F;
    sampler.start({3, 1, {0, 0}, i});
    const PixelSample sample = integrator->sample(*test.scene, ray, sampler, work);
    ASSERT_TRUE(std::isfinite(luminance(sample.radiance))) << sampler.rim.y;
    work.splats.clear();
  }
  EXPECT_GT(edge_on, 10);
}

}  // namespace
}  // namespace hyades::core
