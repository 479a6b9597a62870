#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "core/textures/make_texture.h"

namespace hyades::core {
namespace {

class Ramp final : public Texture {
 public:
  Ramp(TexturePtr input, std::vector<RampStop> stops, RampShape shape)
      : input_(std::move(input)), stops_(std::move(stops)), shape_(shape) {}

  Rgb color(const TexturePoint& at) const override {
    const Place place = place_of(input_->scalar(at));
    const Rgb before = stops_[place.before].color->color(at);
    if (place.share == 0.0F) return before;
    return (1.0F - place.share) * before + place.share * stops_[place.before + 1].color->color(at);
  }

  ScalarGradient gradient(const TexturePoint& at, const Vec4& weights) const override {
    const ScalarGradient input = input_->scalar_gradient(at);
    const Place place = place_of(input.value);
    // Alpha is 1: a ramp is opaque whatever its colours are made of.
    const Vec4 w(Vec3(weights), 0.0F);
    ScalarGradient result = stops_[place.before].color->gradient(at, w);
    if (place.share != 0.0F || place.slope != 0.0F) {
      const ScalarGradient after = stops_[place.before + 1].color->gradient(at, w);
      const float step = after.value - result.value;
      result = weighted_sum(1.0F - place.share, result, place.share, after);
      const float value = result.value;
      result = weighted_sum(1.0F, result, step * place.slope, input);
      result.value = value;
    }
    result.value += weights.w;
    return result;
  }

 private:
  /// Between two stops: the share of the second, and how it changes with the number.
  struct Place {
    size_t before = 0;
    float share = 0.0F;
    float slope = 0.0F;
  };

  Place place_of(float x) const {
    if (!(x >= stops_.front().at)) return {};
    const auto after =
        std::upper_bound(stops_.begin(), stops_.end(), x,
                         [](float value, const RampStop& s) { return value < s.at; });
    const auto before = static_cast<size_t>(after - stops_.begin()) - 1;
    if (after == stops_.end() || shape_ == RampShape::steps) return {before, 0.0F, 0.0F};
    const float scale = 1.0F / (after->at - stops_[before].at);
    const float u = (x - stops_[before].at) * scale;
    if (shape_ == RampShape::linear) return {before, u, scale};
    return {before, u * u * (3.0F - 2.0F * u), 6.0F * u * (1.0F - u) * scale};
  }

  TexturePtr input_;
  std::vector<RampStop> stops_;
  RampShape shape_;
};

}  // namespace

TexturePtr make_ramp_texture(TexturePtr input, std::vector<RampStop> stops, RampShape shape) {
  if (stops.empty()) stops.push_back({0.0F, make_constant_texture(Rgb(0.0F))});
  std::stable_sort(stops.begin(), stops.end(),
                   [](const RampStop& a, const RampStop& b) { return a.at < b.at; });
  return std::make_shared<Ramp>(std::move(input), std::move(stops), shape);
}

}  // namespace hyades::core
