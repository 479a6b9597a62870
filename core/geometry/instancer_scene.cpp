#include "core/geometry/instancer_scene.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "core/geometry/chunks.h"
#include "core/geometry/placed_object.h"
#include "core/geometry/placed_world.h"
#include "core/geometry/placement_check.h"

namespace hyades::core {
namespace {

Affine affine_of(const PlaceMatrix& m) {
  return {glm::dmat3(Vec3d(m[0]), Vec3d(m[1]), Vec3d(m[2])), Vec3d(m[3])};
}

}  // namespace

InstancerScene::InstancerScene(std::shared_ptr<const PointInstancer> instancer,
                               std::vector<Placement> members,
                               std::shared_ptr<const PlacedWorld> inner)
    : instancer_(std::move(instancer)),
      members_(std::move(members)),
      inner_(std::move(inner)),
      motion_(instancer_->to_world) {}

Status InstancerScene::build(SceneBuilder& builder) {
  builder.add_copies(*this);
  auto scene = builder.commit();
  if (!scene) return scene.error();
  scene_ = *scene;
  bounds_ = bounds_of(inner_->bounds());
  return {};
}

Bounds InstancerScene::bounds_of(const Bounds& inner) const {
  const size_t copies = instancer_->places->size();
  std::vector<Bounds> parts(chunk_count(copies));
  for_chunks(copies, [&](size_t begin, size_t end) {
    Bounds b;
    for (size_t i = begin; i < end; ++i) {
      for (size_t step = 0; step < motion_.steps().size(); ++step) {
        b.include(bounds_of_copy(static_cast<uint32_t>(i), step, inner));
      }
    }
    parts[begin / kChunk] = b;
  });
  Bounds all;
  for (const Bounds& b : parts) all.include(b);
  return all;
}

bool InstancerScene::is_of(const PointInstancer& instancer,
                           const std::vector<Placement>& members) const {
  return instancer.places == instancer_->places && instancer.to_world == instancer_->to_world &&
         std::equal(members.begin(), members.end(), members_.begin(), members_.end(),
                    [](const Placement& a, const Placement& b) { return same_placement(a, b); });
}

CopyPose InstancerScene::pose(uint32_t copy, float time) const {
  const Affine place = affine_of((*instancer_->places)[copy]);
  const Affine to_world = motion_.at(time) * place;
  return {to_world, to_world.inverse()};
}

Bounds InstancerScene::bounds_of_copy(uint32_t copy, size_t step, const Bounds& inner) const {
  const Affine to_world = motion_.steps()[step] * affine_of((*instancer_->places)[copy]);
  return transform_bounds(to_world, inner);
}

size_t InstancerScene::memory() const {
  return instancer_->places->capacity() * sizeof(PlaceMatrix) + scene_->memory() + inner_->memory();
}

}  // namespace hyades::core
