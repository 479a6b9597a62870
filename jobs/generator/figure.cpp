#include "jobs/generator/figure.h"

#include "jobs/generator/implicit.h"
#include "jobs/generator/surface_nets.h"

namespace hyades::gallery {
namespace {

void add_trunk(Body& body) {
  for (const float side : {-1.0F, 1.0F}) {
    body.add({side * 0.06F, 0.64F, 0.0F}, {side * 0.05F, 0.82F, 0.03F}, 0.115F, 0.095F);
    body.add({side * 0.05F, 0.82F, 0.03F}, {side * 0.08F, 1.06F, 0.03F}, 0.095F, 0.125F);
    // Shoulder, breast, flank, buttock, and the muscle beside the spine.
    body.add({0.0F, 1.19F, 0.03F}, {side * 0.19F, 1.165F, 0.03F}, 0.07F, 0.062F);
    body.add({side * 0.085F, 1.07F, 0.125F}, {0.085F, 0.062F, 0.045F});
    body.add({side * 0.135F, 0.98F, 0.0F}, {0.05F, 0.14F, 0.08F});
    body.add({side * 0.085F, 0.61F, -0.07F}, {0.09F, 0.095F, 0.09F});
    body.add({side * 0.06F, 1.0F, -0.075F}, {side * 0.09F, 1.14F, -0.07F}, 0.05F, 0.055F, 0.03F);
    // Two rows of the belly's muscles.
    for (int row = 0; row < 3; ++row) {
      body.add({side * 0.042F, 0.97F - 0.085F * static_cast<float>(row), 0.115F},
               {0.042F, 0.043F, 0.03F}, 0.015F);
    }
  }
  // A cloth around the hips.
  body.add({0.0F, 0.70F, 0.0F}, {0.0F, 0.58F, 0.02F}, 0.15F, 0.185F, 0.03F);
}

void add_head(Body& body) {
  body.add({0.0F, 1.2F, 0.05F}, {0.0F, 1.29F, 0.2F}, 0.07F, 0.055F, 0.05F);
  // Bent, so that the globe lies on the neck.
  body.add({0.0F, 1.315F, 0.265F}, {0.08F, 0.095F, 0.105F}, 0.03F);
  body.add({0.0F, 1.25F, 0.31F}, {0.052F, 0.06F, 0.05F}, 0.03F);                 // jaw
  body.add({0.0F, 1.3F, 0.355F}, {0.0F, 1.262F, 0.375F}, 0.014F, 0.02F, 0.02F);  // nose
  body.add({0.0F, 1.205F, 0.33F}, {0.035F, 0.055F, 0.035F}, 0.03F);              // beard
  for (const float side : {-1.0F, 1.0F}) {
    body.add({side * 0.03F, 1.322F, 0.352F}, {0.03F, 0.012F, 0.015F}, 0.015F);  // brow
    body.add({side * 0.08F, 1.29F, 0.26F}, {0.012F, 0.026F, 0.018F}, 0.01F);    // ear
  }
}

void add_arm(Body& body, float side) {
  const Vec3 shoulder(side * 0.21F, 1.16F, 0.03F);
  const Vec3 elbow(side * 0.5F, 1.22F, 0.07F);
  const Vec3 wrist(side * 0.565F, 1.49F, -0.06F);
  body.add(shoulder, {0.075F, 0.075F, 0.075F}, 0.04F);
  body.add(shoulder, elbow, 0.062F, 0.045F);
  body.add(0.5F * (shoulder + elbow) + Vec3(0.0F, 0.025F, 0.01F), {0.085F, 0.045F, 0.045F});
  body.add(elbow, wrist, 0.048F, 0.03F);
  body.add(elbow + 0.3F * (wrist - elbow), {0.05F, 0.08F, 0.05F});
  // A hand that lies against the globe, which bulges towards it.
  const Vec3 palm(side * 0.575F, 1.56F, -0.085F);
  body.add(wrist, palm, 0.032F, 0.036F, 0.02F);
  for (int finger = 0; finger < 4; ++finger) {
    const float spread = 0.027F * (static_cast<float>(finger) - 1.5F);
    body.add(palm + Vec3(0.0F, 0.015F, spread),
             palm + Vec3(side * 0.065F, 0.105F, 1.5F * spread - 0.01F), 0.016F, 0.012F, 0.012F);
  }
  body.add(palm, palm + Vec3(-side * 0.005F, 0.05F, 0.085F), 0.018F, 0.013F, 0.015F);
}

void add_leg(Body& body, const Vec3& hip, const Vec3& knee, const Vec3& ankle, const Vec3& toes) {
  body.add(hip, knee, 0.1F, 0.062F, 0.05F);
  body.add(hip + 0.45F * (knee - hip), Vec3(0.085F), 0.05F);
  body.add(knee, {0.06F, 0.06F, 0.06F});
  body.add(knee, ankle, 0.056F, 0.036F);
  const Vec3 shin = ankle - knee;
  const Vec3 behind = glm::normalize(glm::cross(Vec3(1.0F, 0.0F, 0.0F), shin));
  body.add(knee + 0.32F * shin + 0.022F * behind, Vec3(0.062F), 0.05F);  // calf
  body.add(ankle, {0.04F, 0.045F, 0.045F});
  body.add(ankle + 0.1F * (ankle - knee), toes, 0.036F, 0.022F, 0.04F);
}

float distance_to_atlas(const Vec3& p) {
  Body body(p);
  add_trunk(body);
  add_head(body);
  add_arm(body, -1.0F);
  add_arm(body, 1.0F);
  // The right knee is on the ground, the left foot stands.
  add_leg(body, {-0.1F, 0.6F, 0.0F}, {-0.15F, 0.075F, 0.1F}, {-0.15F, 0.075F, -0.34F},
          {-0.15F, 0.02F, -0.46F});
  add_leg(body, {0.1F, 0.6F, 0.02F}, {0.16F, 0.54F, 0.46F}, {0.16F, 0.075F, 0.43F},
          {0.18F, 0.025F, 0.64F});
  return body.distance();
}

}  // namespace

Mesh make_atlas(float cell) {
  return make_surface({{-0.8F, -0.08F, -0.62F}, {0.8F, 1.8F, 0.8F}, cell}, distance_to_atlas);
}

}  // namespace hyades::gallery
