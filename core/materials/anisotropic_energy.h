#pragma once

#include <array>

#include "core/materials/ggx.h"

namespace hyades::core {

/// What stretched GGX facets that reflect everything give off again by single scattering, for one
/// ratio of their widths: E(w, along_x), as FacetEnergy is for facets that are alike in all
/// directions. Tabulated by quadrature (80 ms) within 0.005 (one standard
/// deviation: 0.0015).
class AnisotropicTable {
 public:
  /// `ratio`: along_y over along_x.
  explicit AnisotropicTable(float ratio);

  /// `w` above the surface. Interpolated over the angle to the surface, the width seen from `w`,
  /// and along_x.
  float reflectance(const Vec3& w, float along_x) const {
    return look_up(reflectance_, w, along_x);
  }

  /// The reflectance of facets that reflect (1 - cosine)^5, as dielectrics do at their edge.
  float edge(const Vec3& w, float along_x) const;

  /// The mean over the hemisphere of 1 - E, weighed with the cosine.
  float mean_loss(float along_x) const;

 private:
  static constexpr int kCosines = 24;
  static constexpr int kAzimuths = 9;  ///< of a quarter, even in the width that is seen
  static constexpr int kWidths = 16;   ///< even in the root of along_x
  static constexpr int kMeans = 64;

  using Table = std::array<std::array<std::array<float, kCosines>, kAzimuths>, kWidths>;

  float seen_width(const Vec3& w, float along_x) const;
  float look_up(const Table& table, const Vec3& w, float along_x) const;

  float ratio_;
  Table reflectance_;
  Table more_edge_;  ///< edge() less what it would be if all facets lay flat
  std::array<float, kMeans> mean_loss_;
};

/// What AnisotropicTable tells for any facets, interpolated between tables at fixed ratios, each
/// made at first use. Facets that are alike in all directions have FacetEnergy's. Cheap to make;
/// thread-safe.
class AnisotropicEnergy {
 public:
  /// Facets of which neither width is more than ten times the other; beyond, it is as there.
  explicit AnisotropicEnergy(const AnisotropicGgx& facets);

  float reflectance(const Vec3& w) const;
  float mean_loss() const;

  /// What facets of a dielectric that reflects `f0` straight on give off, over what even ones of
  /// the width seen from `w` do, both by Schlick's formula (1994).
  float over_even(const Vec3& w, float f0) const;

 private:
  Vec3 turned(const Vec3& w) const { return turned_ ? Vec3(w.y, w.x, w.z) : w; }

  bool turned_ = false;                    ///< it is that along y
  const AnisotropicTable* low_ = nullptr;  ///< null: even
  const AnisotropicTable* high_ = nullptr;
  float part_ = 0.0F;
  const AnisotropicTable* even_ = nullptr;  ///< of ratio 1
  AnisotropicGgx facets_;                   ///< with the greater width along x
};

}  // namespace hyades::core
