#include "core/finish/feature_filter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/base/parallel.h"
#include "core/base/rect.h"
#include "core/finish/linear_fit.h"

namespace hyades::core {
namespace {

constexpr int kWindow = 9;  ///< pixels around one that are compared with it
constexpr int kPatch = 2;   ///< pixels around two that decide how alike they are
constexpr int kTile = 48;
constexpr int kSide = 2 * kWindow + 1;
/// Differences count in multiples of this many standard deviations.
constexpr float kTolerance = 0.5F;

/// A rectangle of floats.
class Plane {
 public:
  void reset(const PixelRect& rect) {
    rect_ = rect;
    values_.assign(static_cast<size_t>(rect.area()), 0.0F);
  }
  float& at(int x, int y) { return values_[index(x, y)]; }
  float at(int x, int y) const { return values_[index(x, y)]; }
  const PixelRect& rect() const { return rect_; }

 private:
  size_t index(int x, int y) const {
    return static_cast<size_t>(y - rect_.y0) * static_cast<size_t>(rect_.width()) +
           static_cast<size_t>(x - rect_.x0);
  }
  PixelRect rect_;
  std::vector<float> values_;
};

PixelRect grown(const PixelRect& rect, int by, const PixelRect& within) {
  return intersection({rect.x0 - by, rect.y0 - by, rect.x1 + by, rect.y1 + by}, within);
}

/// One tile of the picture. Fits are made for the pixels around it too, whose windows reach into
/// it.
class TileFilter {
 public:
  TileFilter(const GuidedPicture& picture, const PixelRect& tile)
      : picture_(picture),
        whole_{0, 0, picture.width, picture.height},
        tile_(tile),
        fitted_(grown(tile, kWindow, whole_)) {}

  void run(std::vector<Rgb>& out) {
    compare();
    fit();
    gather(out);
  }

 private:
  /// How alike pixel (x, y) and the one at the offset `o` are, 0 to 1.
  float& weight(size_t o, int x, int y) { return weights_[o].at(x, y); }

  static size_t offset_index(int dx, int dy) {
    return static_cast<size_t>((dy + kWindow) * kSide + dx + kWindow);
  }

  size_t pixel(int x, int y) const {
    return static_cast<size_t>(y) * static_cast<size_t>(picture_.width) + static_cast<size_t>(x);
  }

  /// Squared difference of two pixels in units of its standard deviation, less what noise makes.
  float difference(size_t p, size_t q) const {
    float sum = 0.0F;
    for (int c = 0; c < 3; ++c) {
      const float a = picture_.color[p][c];
      const float b = picture_.color[q][c];
      const float va = picture_.variance[p][c];
      const float vb = picture_.variance[q][c];
      const float d = a - b;
      // Both alike, so that a pixel is to another what that one is to it.
      const float expected = 2.0F * std::min(va, vb);
      sum += (d * d - expected) / (1e-10F + kTolerance * kTolerance * (va + vb));
    }
    return sum * (1.0F / 3.0F);
  }

  void compare() {
    weights_.resize(size_t{kSide} * kSide);
    Plane differences;
    Plane rows;
    for (int dy = -kWindow; dy <= kWindow; ++dy) {
      for (int dx = -kWindow; dx <= kWindow; ++dx) {
        compare_at(dx, dy, differences, rows, weights_[offset_index(dx, dy)]);
      }
    }
  }

  void compare_at(int dx, int dy, Plane& differences, Plane& rows, Plane& out) {
    out.reset(fitted_);
    // Where the neighbour lies in the picture.
    const PixelRect inside =
        intersection(whole_, {whole_.x0 - dx, whole_.y0 - dy, whole_.x1 - dx, whole_.y1 - dy});
    const PixelRect needed = intersection(grown(fitted_, kPatch, whole_), inside);
    if (needed.area() <= 0) return;
    differences.reset(needed);
    for (int y = needed.y0; y < needed.y1; ++y) {
      for (int x = needed.x0; x < needed.x1; ++x) {
        differences.at(x, y) = difference(pixel(x, y), pixel(x + dx, y + dy));
      }
    }
    rows.reset(needed);
    for (int y = needed.y0; y < needed.y1; ++y) {
      for (int x = needed.x0; x < needed.x1; ++x) {
        float sum = 0.0F;
        const int end = std::min(x + kPatch + 1, needed.x1);
        for (int i = std::max(x - kPatch, needed.x0); i < end; ++i) sum += differences.at(i, y);
        rows.at(x, y) = sum;
      }
    }
    const PixelRect wanted = intersection(fitted_, needed);
    for (int y = wanted.y0; y < wanted.y1; ++y) {
      const int first = std::max(y - kPatch, needed.y0);
      const int end = std::min(y + kPatch + 1, needed.y1);
      for (int x = wanted.x0; x < wanted.x1; ++x) {
        float sum = 0.0F;
        for (int i = first; i < end; ++i) sum += rows.at(x, i);
        const int columns = std::min(x + kPatch + 1, needed.x1) - std::max(x - kPatch, needed.x0);
        out.at(x, y) = similarity(sum / static_cast<float>(columns * (end - first)));
      }
    }
  }

  /// Like exp(-d), but 0 from d = 4 on.
  static float similarity(float d) {
    const float rest = 1.0F - 0.25F * std::max(d, 0.0F);
    if (!(rest > 0.0F)) return 0.0F;
    const float square = rest * rest;
    return square * square;
  }

  void fit() {
    const PixelRect used = grown(fitted_, kWindow, whole_);
    std::vector<LinearFit::Terms> terms(static_cast<size_t>(used.area()));
    const auto at = [&](int x, int y) {
      return static_cast<size_t>(y - used.y0) * static_cast<size_t>(used.width()) +
             static_cast<size_t>(x - used.x0);
    };
    for (int y = used.y0; y < used.y1; ++y) {
      for (int x = used.x0; x < used.x1; ++x) {
        const size_t p = pixel(x, y);
        terms[at(x, y)] = LinearFit::terms(picture_.features[p], picture_.color[p]);
      }
    }
    fits_.resize(static_cast<size_t>(fitted_.area()));
    size_t next = 0;
    for (int y = fitted_.y0; y < fitted_.y1; ++y) {
      for (int x = fitted_.x0; x < fitted_.x1; ++x) {
        LinearFit::Terms sums{};
        for (int dy = std::max(-kWindow, -y); dy <= std::min(kWindow, picture_.height - 1 - y);
             ++dy) {
          for (int dx = std::max(-kWindow, -x); dx <= std::min(kWindow, picture_.width - 1 - x);
               ++dx) {
            const float w = weight(offset_index(dx, dy), x, y);
            if (w > 0.0F) LinearFit::add(sums, w, terms[at(x + dx, y + dy)]);
          }
        }
        fits_[next++] = LinearFit::solve(sums);
      }
    }
  }

  void gather(std::vector<Rgb>& out) {
    for (int y = tile_.y0; y < tile_.y1; ++y) {
      for (int x = tile_.x0; x < tile_.x1; ++x) {
        const GuidedPicture::Features& features = picture_.features[pixel(x, y)];
        Rgb sum(0.0F);
        float total = 0.0F;
        for (int dy = std::max(-kWindow, -y); dy <= std::min(kWindow, picture_.height - 1 - y);
             ++dy) {
          for (int dx = std::max(-kWindow, -x); dx <= std::min(kWindow, picture_.width - 1 - x);
               ++dx) {
            const float w = weight(offset_index(dx, dy), x, y);
            if (w <= 0.0F) continue;
            sum += w * fits_[fit_index(x + dx, y + dy)].at(features);
            total += w;
          }
        }
        out[pixel(x, y)] = glm::max(sum / total, Rgb(0.0F));
      }
    }
  }

  size_t fit_index(int x, int y) const {
    return static_cast<size_t>(y - fitted_.y0) * static_cast<size_t>(fitted_.width()) +
           static_cast<size_t>(x - fitted_.x0);
  }

  const GuidedPicture& picture_;
  PixelRect whole_;
  PixelRect tile_;
  PixelRect fitted_;
  std::vector<Plane> weights_;
  std::vector<LinearFit> fits_;
};

}  // namespace

std::vector<Rgb> filter_by_features(const GuidedPicture& picture, int threads) {
  std::vector<Rgb> out(picture.color.size());
  const int columns = (picture.width + kTile - 1) / kTile;
  const int rows = (picture.height + kTile - 1) / kTile;
  const PixelRect whole{0, 0, picture.width, picture.height};
  const Status done = parallel_for(
      static_cast<size_t>(columns) * static_cast<size_t>(rows), threads, [&](size_t i) {
        const int x = static_cast<int>(i) % columns * kTile;
        const int y = static_cast<int>(i) / columns * kTile;
        TileFilter(picture, intersection(whole, {x, y, x + kTile, y + kTile})).run(out);
      });
  return done ? out : picture.color;
}

}  // namespace hyades::core
