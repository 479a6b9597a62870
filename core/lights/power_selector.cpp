#include <algorithm>
#include <cmath>

#include "core/base/distribution.h"
#include "core/lights/light_selector.h"

namespace hyades::core {

namespace {

class PowerSelector : public LightSelector {
 public:
  explicit PowerSelector(const std::vector<float>& powers) : distribution_(powers) {}

  std::optional<SelectedLight> select(const Vec3& /*from*/, const Vec3& /*normal*/,
                                      float u) const override {
    if (distribution_.empty()) return std::nullopt;
    const Distribution1D::Choice choice = distribution_.sample(u);
    return SelectedLight{choice.index, choice.probability};
  }

  float probability(const Vec3& /*from*/, const Vec3& /*normal*/, uint32_t light) const override {
    return light < distribution_.size() ? distribution_.probability(light) : 0.0F;
  }

 private:
  Distribution1D distribution_;
};

}  // namespace

std::unique_ptr<LightSelector> make_power_selector(const std::vector<LightPtr>& lights) {
  std::vector<float> powers;
  powers.reserve(lights.size());
  for (const LightPtr& light : lights) {
    // A power beyond float still has to be chosen.
    powers.push_back(std::min(light->power(), 1e37F));
  }
  return std::make_unique<PowerSelector>(powers);
}

}  // namespace hyades::core
