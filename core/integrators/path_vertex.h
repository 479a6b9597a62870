#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "core/lights/light.h"
#include "core/materials/shaded_surface.h"
#include "core/scene/scene.h"

namespace hyades::core {

/// A vertex of a subpath, which begins at the camera or at a light: a place where light scatters,
/// or the subpath's beginning.
///
/// Weights. A path of k vertices x_0 (on a light) ... x_{k-1} (on the lens) can be found by joining
/// a light subpath of s vertices to a camera subpath of t = k - s; p_s is the density with which
/// that strategy finds it. The power heuristic gives it the weight 1 / sum_i (p_i / p_s)^2 over all
/// strategies i that are possible (Veach 1997, section 10.2). Neighbours differ by one vertex,
/// p_i / p_{i+1} = backward(x_i) / forward(x_i): the densities with which it is chosen by a subpath
/// from the camera and from the light. So the part of the sum on the side of a subpath with the
/// vertices y_0 ... y_{n-1} is (reverse_{n-1} / density_{n-1})^2 (edge_{n-1} + beyond_{n-1}
/// reverse_{n-2}^2), where `reverse` are densities from the other side, and only the last two
/// depend on what it is joined to. Densities are per area or volume, those of infinitely far lights
/// per solid angle. What a delta lobe chooses has density 1 per solid angle, and backwards what
/// refraction makes of that; the lobes' own probabilities, roulette, and what media and surfaces
/// with an opacity let through are left out: the weights of a path add up to 1 all the same.
struct PathVertex {
  enum class Kind { lens, light, surface, medium };

  Kind kind = Kind::lens;
  Vec3 position{0.0F};
  Vec3 wo{0.0F};         ///< unit, towards the vertex before (not of the first)
  Rgb throughput{1.0F};  ///< what the subpath carries to this vertex
  SurfacePoint point;    ///< of surfaces; of lights on a surface position and normal
  std::optional<ShadedSurface> surface;
  const SceneObject* object = nullptr;  ///< of surfaces
  const Medium* medium = nullptr;       ///< of places in media
  MediumStack around;                   ///< the bodies around the way that led here
  uint32_t light = 0;                   ///< of lights: which
  bool infinitely_far = false;          ///< a light that is: `position` means nothing

  double density = 1.0;  ///< with which the subpath chose this vertex
  double edge = 0.0;     ///< (p_i / p_s)^2 of the strategy that joins this vertex to the one before
  double beyond = 0.0;   ///< factor of the sum over the strategies before that one
  double chain = 0.0;    ///< edge + beyond reverse^2, when the subpath has gone on from here

  bool scatters() const { return kind == Kind::surface || kind == Kind::medium; }

  /// Whether it can be joined to another vertex.
  bool joins() const { return kind == Kind::medium || (surface && surface->has_smooth()); }

  /// The normal that choosing among lights refers to.
  Vec3 selection_normal() const { return kind == Kind::surface ? point.ng : Vec3(0.0F); }

  /// The lists of objects that what is here is in, of a place that scatters in `scene`.
  ListBits lists(const Scene& scene) const {
    return kind == Kind::surface ? object->in_lists : scene.lists_within(around);
  }

  /// f |cos| between `out` and `in`, unit, both away from the vertex; `mode` is what comes along
  /// `out`.
  Rgb evaluate(const Vec3& out, const Vec3& in, TransportMode mode) const;

  /// The density per solid angle with which a subpath that came along `out` goes on along `in`. In
  /// media whose channels differ, that of channels chosen alike.
  double pdf(const Vec3& out, const Vec3& in, TransportMode mode) const;

  /// What turns a density per solid angle of direction `towards` (unit) at `from` into this
  /// vertex's measure.
  double per_direction(const Vec3& from, const Vec3& towards) const;

  /// What turns a density per area across `towards` (unit) into this vertex's measure.
  double across(const Vec3& towards) const;

  /// The bodies around a ray that leaves along `direction`.
  MediumStack around_towards(const Vec3& direction) const;
};

/// The vertices of a subpath. Memory is kept from one path to the next.
class Subpath {
 public:
  int size() const { return size_; }
  void clear() {
    size_ = 0;
    arena_.reset();
  }
  PathVertex& operator[](int i) { return vertices_[static_cast<size_t>(i)]; }
  const PathVertex& operator[](int i) const { return vertices_[static_cast<size_t>(i)]; }
  PathVertex& back() { return (*this)[size_ - 1]; }

  /// A fresh vertex at the end; others stay where they are.
  PathVertex& add(PathVertex::Kind kind);

  void drop_last() { --size_; }

  /// For the BSDFs of its vertices.
  BsdfArena& arena() { return arena_; }

 private:
  std::deque<PathVertex> vertices_;
  int size_ = 0;
  BsdfArena arena_;
};

/// A ray from `a` to `b` that meets neither's surface, both at shutter time `time`.
Ray ray_between(const PathVertex& a, const PathVertex& b, float time);

}  // namespace hyades::core
