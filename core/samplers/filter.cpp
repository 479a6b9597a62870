#include "core/samplers/filter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/base/elementary.h"

namespace hyades::core {
namespace {

/// A function on an interval, linear between nodes. The filters are these, not their formulas: the
/// difference (1e-5 of the peak) cannot be seen, and samples have exactly the weights 1 or +-c.
class Profile {
 public:
  /// Nodes in ascending order; where the sign changes between two, a node with value 0 is added.
  Profile(const std::vector<float>& x, const std::vector<float>& f) {
    for (size_t i = 0; i < x.size(); ++i) {
      if (i > 0 && f[i - 1] * f[i] < 0.0F) {
        x_.push_back(x[i - 1] + (x[i] - x[i - 1]) * (f[i - 1] / (f[i - 1] - f[i])));
        f_.push_back(0.0F);
      }
      x_.push_back(x[i]);
      f_.push_back(f[i]);
    }
    const size_t cells = x_.size() - 1;
    cells_per_unit_ = static_cast<float>(cells) / (x_.back() - x_.front());
    std::vector<double> area(cells);
    double total = 0.0;
    double signed_total = 0.0;
    for (size_t i = 0; i < cells; ++i) {
      area[i] = 0.5 * std::fabs(double{f_[i]} + f_[i + 1]) * (double{x_[i + 1]} - x_[i]);
      total += area[i];
      signed_total += sign(i) * area[i];
    }
    scale_ = static_cast<float>(1.0 / signed_total);
    weight_ = static_cast<float>(total / signed_total);
    cumulative_.resize(cells + 1, 1.0F);
    double sum = 0.0;
    for (size_t i = 0; i < cells; ++i) {
      cumulative_[i] = static_cast<float>(sum / total);
      sum += area[i];
    }
    size_t cell = 0;
    for (size_t i = 0; i < guide_.size(); ++i) {
      const float u = static_cast<float>(i) / static_cast<float>(guide_.size());
      while (cell + 1 < cells && cumulative_[cell + 1] <= u) ++cell;
      guide_[i] = static_cast<uint32_t>(cell);
    }
  }

  /// A place drawn in proportion to |f|; multiplies `weight` by f / density there.
  float sample(float u, float& weight) const {
    size_t i = guide_[std::min(static_cast<size_t>(u * static_cast<float>(guide_.size())),
                               guide_.size() - 1)];
    while (i + 2 < x_.size() && cumulative_[i + 1] <= u) ++i;
    const float part = (u - cumulative_[i]) / (cumulative_[i + 1] - cumulative_[i]);
    // Inverse of the quadratic integral of a density linear from a to b.
    const float a = std::fabs(f_[i]);
    const float b = std::fabs(f_[i + 1]);
    const float root = std::sqrt(std::max(a * a + (b * b - a * a) * part, 0.0F));
    const float t = part > 0.0F ? std::min(part * (a + b) / (a + root), 1.0F) : 0.0F;
    weight *= sign(i) * weight_;
    return x_[i] + (x_[i + 1] - x_[i]) * t;
  }

  /// f / integral of f.
  float evaluate(float x) const {
    if (!(x >= x_.front() && x < x_.back())) return 0.0F;
    // The nodes are evenly spaced, up to rounding.
    const size_t last = x_.size() - 2;
    auto i = std::min(static_cast<size_t>((x - x_.front()) * cells_per_unit_), last);
    while (i > 0 && x < x_[i]) --i;
    while (i < last && x >= x_[i + 1]) ++i;
    const float t = (x - x_[i]) / (x_[i + 1] - x_[i]);
    return (f_[i] + (f_[i + 1] - f_[i]) * t) * scale_;
  }

 private:
  float sign(size_t cell) const { return f_[cell] + f_[cell + 1] < 0.0F ? -1.0F : 1.0F; }

  std::vector<float> x_;
  std::vector<float> f_;
  std::vector<float> cumulative_;      // of |f|, at the nodes
  std::array<uint32_t, 256> guide_{};  // cell of u = i / 256: the search starts there
  float cells_per_unit_ = 1.0F;
  float scale_ = 1.0F;
  float weight_ = 1.0F;  // integral of |f| over integral of f
};

/// Profile(x) Profile(y).
class SeparableFilter final : public PixelFilter {
 public:
  explicit SeparableFilter(Profile profile) : profile_(std::move(profile)) {}

  FilterSample sample(const Vec2& u) const override {
    FilterSample s;
    s.offset.x = profile_.sample(u.x, s.weight);
    s.offset.y = profile_.sample(u.y, s.weight);
    return s;
  }
  float evaluate(const Vec2& offset) const override {
    return profile_.evaluate(offset.x) * profile_.evaluate(offset.y);
  }
  float evaluate_along(float x) const override { return profile_.evaluate(x); }

 private:
  Profile profile_;
};

/// The same everywhere within its radius.
class BoxFilter final : public PixelFilter {
 public:
  explicit BoxFilter(float radius) : radius_(radius), value_(0.5F / radius) {}

  FilterSample sample(const Vec2& u) const override {
    return {Vec2(-radius_) + 2.0F * radius_ * u, 1.0F};
  }
  float evaluate(const Vec2& offset) const override {
    return evaluate_along(offset.x) * evaluate_along(offset.y);
  }
  float evaluate_along(float x) const override {
    return x >= -radius_ && x < radius_ ? value_ : 0.0F;
  }

 private:
  float radius_;
  float value_;
};

class CenterFilter final : public PixelFilter {
 public:
  FilterSample sample(const Vec2& /*u*/) const override { return {}; }
  float evaluate(const Vec2& /*offset*/) const override { return 0.0F; }
  float evaluate_along(float /*x*/) const override { return 0.0F; }
};

/// exp(-x^2 / (2 sigma^2)) with sigma = radius / 3, lowered to be 0 at the radius. x in radii.
float gaussian(float x) { return exp(-4.5F * x * x) - exp(-4.5F); }

/// Mitchell and Netravali 1988, equation 8 with B = C = 1/3; x in radii (the original has radius
/// 2).
float mitchell(float x) {
  const float a = 2.0F * std::fabs(x);
  if (a < 1.0F) return (7.0F * a - 12.0F) * a * a + 16.0F / 3.0F;
  return ((-7.0F / 3.0F * a + 12.0F) * a - 20.0F) * a + 32.0F / 3.0F;
}

/// Four-term window (Harris 1978, table 1: minimum 4-sample, -92 dB); x in radii.
float blackman_harris(float x) {
  return 0.35875F + 0.48829F * cos(kPi * x) + 0.14128F * cos(2.0F * kPi * x) +
         0.01168F * cos(3.0F * kPi * x);
}

Profile tabulate(float (*f)(float), float radius) {
  constexpr int kCells = 1024;
  std::vector<float> x(kCells + 1);
  std::vector<float> values(kCells + 1);
  for (int i = 0; i <= kCells; ++i) {
    const float t = static_cast<float>(2 * i - kCells) / kCells;
    x[i] = radius * t;
    values[i] = f(t);
  }
  return {x, values};
}

Profile make_profile(FilterShape shape, float radius) {
  switch (shape) {
    case FilterShape::gaussian:
      return tabulate(gaussian, radius);
    case FilterShape::mitchell:
      return tabulate(mitchell, radius);
    case FilterShape::blackman_harris:
      return tabulate(blackman_harris, radius);
    default:
      return {{-radius, 0.0F, radius}, {0.0F, 1.0F, 0.0F}};  // a triangle
  }
}

}  // namespace

std::unique_ptr<PixelFilter> make_pixel_filter(FilterShape shape, float radius) {
  if (shape == FilterShape::center || !(radius > 0.0F)) return std::make_unique<CenterFilter>();
  if (shape == FilterShape::box) return std::make_unique<BoxFilter>(radius);
  return std::make_unique<SeparableFilter>(make_profile(shape, radius));
}

}  // namespace hyades::core
