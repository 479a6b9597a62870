#include "core/materials/anisotropic_energy.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <utility>

#include "core/base/elementary.h"
#include "core/base/fp_mode.h"
#include "core/materials/energy_grid.h"
#include "core/materials/facet_energy.h"
#include "core/materials/fresnel.h"

namespace hyades::core {
namespace {

constexpr float kLeastRatio = 0.1F;

struct Reflected {
  float all;
  float edge;  ///< by facets that reflect (1 - cosine)^5
};

/// Mean weight of visible normals over a lattice of the golden ratio.
Reflected integrate(const AnisotropicGgx& facets, float cosine, float across_x) {
  constexpr int kPoints = 384;
  constexpr float kGoldenRatio = 0.618033988749895F;
  const float z = std::max(cosine, 1e-7F);
  const float r = std::sqrt(1.0F - z * z);
  const Vec3 wo(r * across_x, r * std::sqrt(1.0F - across_x * across_x), z);
  Reflected sum{};
  float v = 0.5F;
  for (int i = 0; i < kPoints; ++i) {
    const float u = (static_cast<float>(i) + 0.5F) / kPoints;
    v += kGoldenRatio;
    if (v >= 1.0F) v -= 1.0F;
    const Vec3 m = facets.sample_normal(wo, {v, u});
    const Vec3 back = reflected(wo, m);
    if (!(back.z > 0.0F)) continue;
    const float weight = facets.reflect_weight(wo, back);
    const float fall = 1.0F - std::clamp(glm::dot(wo, m), 0.0F, 1.0F);
    sum.all += weight;
    sum.edge += weight * fifth_power(fall);
  }
  return {std::min(sum.all / kPoints, 1.0F), std::min(sum.edge / kPoints, 1.0F)};
}

/// The seen width of an azimuth over the greater one: from `ratio` across it to 1 along it.
float seen_part(float along_x2, float ratio) {
  return std::sqrt(along_x2 + ratio * ratio * (1.0F - along_x2));
}

/// Tables at fixed ratios, even in the root of the ratio.
class Tables {
 public:
  static constexpr int kCount = 9;  ///< the last is for ratio 1

  static float column_of(float ratio) {
    const float least = std::sqrt(kLeastRatio);
    return (std::sqrt(ratio) - least) / (1.0F - least);
  }

  static const AnisotropicTable* at(int node) {
    static std::array<std::once_flag, kCount> made;
    static std::array<std::unique_ptr<const AnisotropicTable>, kCount> tables;
    std::call_once(made[node], [node] {
      const float least = std::sqrt(kLeastRatio);
      const float root = lerp(least, 1.0F, static_cast<float>(node) / (kCount - 1));
      tables[node] = std::make_unique<const AnisotropicTable>(root * root);
    });
    return tables[node].get();
  }
};

}  // namespace

AnisotropicTable::AnisotropicTable(float ratio) : ratio_(ratio) {
  // The table is part of the picture: the same bits whoever asks first.
  const FpMode mode;
  for (int row = 0; row < kWidths; ++row) {
    const float root = static_cast<float>(row) / (kWidths - 1);
    // The first row is the limit of small widths, where E depends on cosine / width alone.
    const float width = std::max(root * root, 1e-3F);
    const AnisotropicGgx facets{width, width * ratio};
    for (int turn = 0; turn < kAzimuths; ++turn) {
      const float part = lerp(ratio, 1.0F, static_cast<float>(turn) / (kAzimuths - 1));
      const float x2 = ratio < 1.0F ? (part * part - ratio * ratio) / (1.0F - ratio * ratio) : 1.0F;
      const float x = std::sqrt(std::clamp(x2, 0.0F, 1.0F));
      for (int column = 0; column < kCosines; ++column) {
        const float c = static_cast<float>(column) / (kCosines - 1);
        const float cosine = energy_cosine(c, width * part);
        const Reflected back = integrate(facets, cosine, x);
        reflectance_[row][turn][column] = back.all;
        more_edge_[row][turn][column] = back.edge - back.all * fifth_power(1.0F - cosine);
      }
    }
  }
  // Of the interpolated table, so that the two lobes add up to one; even steps in the column.
  constexpr int kSteps = 64;
  constexpr int kTurns = 12;
  mean_loss_[0] = 0.0F;
  for (int i = 1; i < kMeans; ++i) {
    const float root = static_cast<float>(i) / (kMeans - 1);
    const float width = root * root;
    double lost = 0.0;
    for (int turn = 0; turn < kTurns; ++turn) {
      const auto [sine, cosine] =
          sin_cos(0.5F * kPi * (static_cast<float>(turn) + 0.5F) / static_cast<float>(kTurns));
      const float alpha = width * seen_part(cosine * cosine, ratio);
      float last = 0.0F;
      for (int step = 1; step <= kSteps; ++step) {
        const float next = energy_cosine(static_cast<float>(step) / kSteps, alpha);
        const float z = 0.5F * (last + next);
        const float r = std::sqrt(1.0F - z * z);
        lost += double{1.0F - reflectance({r * cosine, r * sine, z}, width)} *
                (2.0 * z * (next - last));
        last = next;
      }
    }
    mean_loss_[i] = static_cast<float>(lost / kTurns);
  }
}

float AnisotropicTable::seen_width(const Vec3& w, float along_x) const {
  const float across = w.x * w.x + w.y * w.y;
  return along_x * (across > 0.0F ? seen_part(w.x * w.x / across, ratio_) : 1.0F);
}

float AnisotropicTable::edge(const Vec3& w, float along_x) const {
  const float flat = fifth_power(1.0F - w.z) * reflectance(w, along_x);
  return std::max(0.0F, flat + look_up(more_edge_, w, along_x));
}

float AnisotropicTable::look_up(const Table& table, const Vec3& w, float along_x) const {
  const float alpha = seen_width(w, along_x);
  const float part = along_x > 0.0F ? alpha / along_x : 1.0F;
  const auto width = GridPlace::at(std::sqrt(along_x), kWidths);
  const auto turn =
      GridPlace::at(ratio_ < 1.0F ? (part - ratio_) / (1.0F - ratio_) : 0.0F, kAzimuths);
  const auto column = GridPlace::at(energy_column(w.z, alpha), kCosines);
  const auto along = [&](const auto& turns) {
    return lerp(column.in(turns[turn.node]), column.in(turns[turn.node + 1]), turn.part);
  };
  return lerp(along(table[width.node]), along(table[width.node + 1]), width.part);
}

float AnisotropicTable::mean_loss(float along_x) const {
  return GridPlace::at(std::sqrt(along_x), kMeans).in(mean_loss_);
}

AnisotropicEnergy::AnisotropicEnergy(const AnisotropicGgx& facets)
    : turned_(facets.along_y > facets.along_x), facets_(facets) {
  if (facets.along_x == facets.along_y) return;
  if (turned_) std::swap(facets_.along_x, facets_.along_y);
  const float ratio = facets_.along_y / facets_.along_x;
  const auto place = GridPlace::at(Tables::column_of(ratio), Tables::kCount);
  low_ = Tables::at(place.node);
  high_ = Tables::at(place.node + 1);
  even_ = Tables::at(Tables::kCount - 1);
  part_ = place.part;
}

float AnisotropicEnergy::reflectance(const Vec3& w) const {
  const float alpha = facets_.along_x;
  if (low_ == nullptr) return FacetEnergy::table().reflectance(w.z, alpha);
  const Vec3 v = turned(w);
  return lerp(low_->reflectance(v, alpha), high_->reflectance(v, alpha), part_);
}

float AnisotropicEnergy::mean_loss() const {
  const float alpha = facets_.along_x;
  if (low_ == nullptr) return FacetEnergy::table().mean_loss(alpha);
  return lerp(low_->mean_loss(alpha), high_->mean_loss(alpha), part_);
}

float AnisotropicEnergy::over_even(const Vec3& w, float f0) const {
  if (low_ == nullptr) return 1.0F;
  const Vec3 v = turned(w);
  const auto of = [&](const AnisotropicTable& table, float alpha) {
    return f0 * table.reflectance(v, alpha) + (1.0F - f0) * table.edge(v, alpha);
  };
  const float even = of(*even_, facets_.seen_from(v));
  const float alpha = facets_.along_x;
  return even > 0.0F ? lerp(of(*low_, alpha), of(*high_, alpha), part_) / even : 1.0F;
}

}  // namespace hyades::core
