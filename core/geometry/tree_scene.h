#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/geometry/box_tree.h"
#include "core/geometry/ray_scene.h"

namespace hyades::core {

/// The scene of the portable class. What a ray meets is decided by exact tests of surfaces in
/// double precision, ties by the numbers of what is met; boxes only leave out what cannot be it. So
/// hits depend neither on the hierarchy nor on the processor.
class TreeScene final : public RayScene {
 public:
  enum class Kind : uint8_t { mesh, curves, quadric, instance, scene, copies };

  /// What was added under one number.
  struct Geometry {
    Kind kind = Kind::mesh;
    bool stands = false;  ///< whether it is of triangles that never move
    unsigned mask = kAllRays;
    uint32_t number = 0;
    const MeshBuffers* mesh = nullptr;
    const CurveSet* curves = nullptr;
    const PlacedObject* object = nullptr;  ///< quadrics and instances
    const TreeScene* scene = nullptr;      ///< what instances, scenes and copies are of
    const InstancerScene* copies = nullptr;

    uint32_t size() const;  ///< primitives
    bool moves() const;
    /// In the space of the scene; empty: the primitive is never met.
    MovingBounds bounds_of(uint32_t primitive) const;
  };

  explicit TreeScene(std::vector<Geometry> geometries);

  std::optional<SceneHit> nearest(const Ray& ray, RayKind kind, float t_min) const override;
  bool occluded(const Ray& ray) const override;
  size_t memory() const override;

  Bounds bounds() const { return tree_.bounds(); }  ///< at all times
  bool moves() const { return moves_; }

 private:
  friend class TreeWalk;

  /// The box of a primitive as the hierarchy has it at `time`, 0 to 1: where something in the scene
  /// moves, with room for rounding.
  Bounds at_time(const MovingBounds& bounds, float time) const;
  /// As at_time(), of a primitive of a geometry.
  Bounds bounds_at(const Geometry& geometry, uint32_t primitive, float time) const {
    return at_time(geometry.bounds_of(primitive), time);
  }

  /// A primitive of a geometry.
  struct Item {
    uint32_t geometry;
    uint32_t primitive;
  };

  std::vector<Geometry> geometries_;
  std::vector<Item> items_;  ///< those of a leaf side by side
  /// Of items that are triangles which stand still; empty where there are none. Else they would be
  /// fetched from three places of their mesh.
  std::vector<std::array<Vec3, 3>> corners_;
  BoxTree tree_;
  bool moves_ = false;  ///< whether anything in it does
};

/// Fills a TreeScene.
class TreeBuilder final : public SceneBuilder {
 public:
  void add_mesh(const MeshBuffers& buffers, unsigned mask, uint32_t number) override;
  void add_curves(const CurveSet& curves, unsigned mask, uint32_t number) override;
  void add_quadric(const PlacedObject& object, unsigned mask, uint32_t number) override;
  void add_instance(const RayScene& scene, const PlacedObject& object, unsigned mask,
                    uint32_t number) override;
  void add_scene(const RayScene& scene, uint32_t number) override;
  void add_copies(const InstancerScene& copies) override;
  Result<std::shared_ptr<const RayScene>> commit() override;

 private:
  TreeScene::Geometry& add(TreeScene::Kind kind, unsigned mask, uint32_t number);

  std::vector<TreeScene::Geometry> geometries_;
};

}  // namespace hyades::core
