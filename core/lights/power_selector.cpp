#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/base/distribution.h"
#include "core/lights/light_selector.h"

namespace hyades::core {

namespace {

class PowerSelector : public LightSelector {
 public:
  explicit PowerSelector(const std::vector<float>& powers) : distribution_(powers) {}

  std::optional<SelectedLight> select(const Vec3& /*from*/, const Vec3& /*normal*/, float u,
                                      ListBits /*lists*/) const override {
    return select_emitter(u);
  }

  float probability(const Vec3& /*from*/, const Vec3& /*normal*/, uint32_t light,
                    ListBits /*lists*/) const override {
    return emitter_probability(light);
  }

  std::optional<SelectedLight> select_along(const Ray& /*way*/, float /*length*/, float u,
                                            ListBits /*lists*/) const override {
    return select_emitter(u);
  }

  float probability_along(const Ray& /*way*/, float /*length*/, uint32_t light,
                          ListBits /*lists*/) const override {
    return emitter_probability(light);
  }

  std::optional<SelectedLight> select_emitter(float u) const override {
    if (distribution_.empty()) return std::nullopt;
    const Distribution1D::Choice choice = distribution_.sample(u);
    return SelectedLight{choice.index, choice.probability};
  }

  bool empty() const override { return distribution_.empty(); }

  float emitter_probability(uint32_t light) const override {
    return light < distribution_.size() ? distribution_.probability(light) : 0.0F;
  }

 private:
  Distribution1D distribution_;
};

}  // namespace

std::unique_ptr<LightSelector> make_power_selector(const std::vector<LightPtr>& lights) {
  std::vector<double> powers;
  double total[2] = {0.0, 0.0};  // of finite and of infinite lights
  for (const LightPtr& light : lights) {
    // A power beyond float still has to be chosen.
    const float power = light->power();
    powers.push_back(power > 0.0F ? static_cast<double>(std::min(power, 1e37F)) : 0.0);
    total[light->is_infinite() ? 1 : 0] += powers.back();
  }
  std::vector<float> weights;
  weights.reserve(lights.size());
  for (size_t i = 0; i < lights.size(); ++i) {
    const double kind = total[lights[i]->is_infinite() ? 1 : 0];
    weights.push_back(kind > 0.0 ? static_cast<float>(powers[i] / kind) : 0.0F);
  }
  return std::make_unique<PowerSelector>(weights);
}

}  // namespace hyades::core
