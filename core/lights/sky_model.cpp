#include "core/lights/sky_model.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/base/elementary.h"
#include "core/base/warp.h"

namespace hyades::core {
namespace {

constexpr float kGround = 6360e3F;  // m from the Earth's middle
constexpr float kTop = 6460e3F;
constexpr float kEye = 2.0F;  // m above the ground

const Rgb kRayleigh(5.802e-6F, 13.558e-6F, 33.1e-6F);  // 1/m at the ground
constexpr float kRayleighHeight = 8000.0F;
constexpr float kMieHeight = 1200.0F;
constexpr float kMieAlbedo = 0.9F;
constexpr float kMieCosine = 0.8F;
const Rgb kOzone(0.650e-6F, 1.881e-6F, 0.085e-6F);  // 1/m where it is densest
constexpr float kOzoneMiddle = 25e3F;
constexpr float kOzoneHalfWidth = 15e3F;
const Rgb kHazeColor(0.759F, 1.0F, 1.337F);  // (550 nm / wavelength)^1.3 at 680, 550, 440 nm

constexpr int kTransmittanceWidth = 128;
constexpr int kTransmittanceHeight = 48;
constexpr int kMultipleWidth = 32;
constexpr int kMultipleHeight = 16;

Rgb exp3(const Rgb& x) { return {exp(x.x), exp(x.y), exp(x.z)}; }

float root(float x) { return std::sqrt(std::max(x, 0.0F)); }

/// How far it is to the sphere of `sphere` metres around the Earth's middle, from within.
float way_out(float radius, float mu, float sphere) {
  return std::max(-radius * mu + root(radius * radius * (mu * mu - 1.0F) + sphere * sphere), 0.0F);
}

bool meets_ground(float radius, float mu) {
  return mu < 0.0F && radius * radius * (mu * mu - 1.0F) + kGround * kGround >= 0.0F;
}

/// Bilinear; `x` and `y` in cells between the table's middles, clamped.
Rgb look_up(const std::vector<Rgb>& table, int width, int height, float x, float y) {
  const auto place = [](float at, int size, int& first) {
    const float clamped = std::clamp(at, 0.0F, static_cast<float>(size - 1));
    first = std::min(static_cast<int>(clamped), size - 2);
    return clamped - static_cast<float>(first);
  };
  int column = 0;
  int row = 0;
  const float u = place(x, width, column);
  const float v = place(y, height, row);
  const Rgb* p = table.data() + row * width + column;
  return (p[0] * (1.0F - u) + p[1] * u) * (1.0F - v) +
         (p[width] * (1.0F - u) + p[width + 1] * u) * v;
}

float rayleigh_phase(float cosine) { return 0.1875F * kInvPi * (1.0F + cosine * cosine); }

/// Cornette & Shanks 1992, as in Bruneton & Neyret (equation 4).
float mie_phase(float cosine) {
  constexpr float g = kMieCosine;
  const float base = 1.0F + g * g - 2.0F * g * cosine;
  return 0.375F * kInvPi * (1.0F - g * g) * (1.0F + cosine * cosine) /
         ((2.0F + g * g) * base * std::sqrt(base));
}

constexpr float kIsotropic = 0.25F * kInvPi;

}  // namespace

SkyModel::SkyModel(float turbidity, const Rgb& ground_albedo) : ground_albedo_(ground_albedo) {
  const float thickness = kRayleigh.y * kRayleighHeight * std::max(turbidity - 1.0F, 0.0F);
  mie_extinction_ = kHazeColor * (thickness / kMieHeight);
  mie_scattering_ = mie_extinction_ * kMieAlbedo;
  tabulate_transmittance();
  tabulate_multiple();
}

SkyModel::Matter SkyModel::matter(float height) const {
  const float air = exp(-height / kRayleighHeight);
  const float haze = exp(-height / kMieHeight);
  const float ozone = std::max(1.0F - std::abs(height - kOzoneMiddle) / kOzoneHalfWidth, 0.0F);
  Matter m;
  m.rayleigh = kRayleigh * air;
  m.mie = mie_scattering_ * haze;
  m.extinction = m.rayleigh + mie_extinction_ * haze + kOzone * ozone;
  return m;
}

Rgb SkyModel::integrate_to_space(float radius, float mu) const {
  constexpr int kSteps = 64;
  const float length = way_out(radius, mu, kTop);
  Rgb thickness(0.0F);
  for (int i = 0; i < kSteps; ++i) {
    // Shorter steps near the beginning, where low rays meet most.
    const float a = static_cast<float>(i) / kSteps;
    const float b = static_cast<float>(i + 1) / kSteps;
    const float t = length * 0.5F * (a * a + b * b);
    const float r = root(radius * radius + t * t + 2.0F * radius * mu * t);
    thickness += matter(std::max(r - kGround, 0.0F)).extinction * (length * (b * b - a * a));
  }
  return exp3(-thickness);
}

void SkyModel::tabulate_transmittance() {
  transmittance_.resize(size_t{kTransmittanceWidth} * kTransmittanceHeight);
  const float horizon = root(kTop * kTop - kGround * kGround);
  for (int y = 0; y < kTransmittanceHeight; ++y) {
    const float rho = horizon * static_cast<float>(y) / (kTransmittanceHeight - 1);
    const float radius = root(rho * rho + kGround * kGround);
    const float nearest = kTop - radius;
    for (int x = 0; x < kTransmittanceWidth; ++x) {
      const float d =
          nearest + (rho + horizon - nearest) * static_cast<float>(x) / (kTransmittanceWidth - 1);
      const float mu =
          d > 0.0F ? (horizon * horizon - rho * rho - d * d) / (2.0F * radius * d) : 1.0F;
      transmittance_[static_cast<size_t>(y * kTransmittanceWidth + x)] =
          integrate_to_space(radius, std::clamp(mu, -1.0F, 1.0F));
    }
  }
}

Rgb SkyModel::to_space(float radius, float mu) const {
  const float horizon = root(kTop * kTop - kGround * kGround);
  const float rho = root(radius * radius - kGround * kGround);
  const float nearest = kTop - radius;
  const float d = way_out(radius, mu, kTop);
  const float x = (d - nearest) / std::max(rho + horizon - nearest, 1.0F);
  return look_up(transmittance_, kTransmittanceWidth, kTransmittanceHeight,
                 x * (kTransmittanceWidth - 1), rho / horizon * (kTransmittanceHeight - 1));
}

Rgb SkyModel::sunlight(float radius, float mu) const {
  return meets_ground(radius, mu) ? Rgb(0.0F) : to_space(radius, mu);
}

SkyModel::Gathered SkyModel::gather(float radius, const Vec3& direction, const Vec3& sun, int steps,
                                    Phases phases) const {
  Gathered out;
  const float mu = direction.y;
  const bool ground = meets_ground(radius, mu);
  const float length =
      ground ? -radius * mu - root(radius * radius * (mu * mu - 1.0F) + kGround * kGround)
             : way_out(radius, mu, kTop);
  const bool isotropic = phases == Phases::isotropic;
  const float cosine = glm::dot(direction, sun);
  const float rayleigh = isotropic ? kIsotropic : rayleigh_phase(cosine);
  const float mie = isotropic ? kIsotropic : mie_phase(cosine);
  Rgb passed(1.0F);
  for (int i = 0; i < steps; ++i) {
    const float a = static_cast<float>(i) / static_cast<float>(steps);
    const float b = static_cast<float>(i + 1) / static_cast<float>(steps);
    const float t = length * 0.5F * (a * a + b * b);
    const float dt = length * (b * b - a * a);
    const Vec3 at = Vec3(0.0F, radius, 0.0F) + direction * t;
    const float r = std::clamp(root(glm::dot(at, at)), kGround, kTop);
    const float mu_sun = glm::dot(at, sun) / r;
    const Matter m = matter(r - kGround);
    Rgb source = sunlight(r, mu_sun) * (m.rayleigh * rayleigh + m.mie * mie);
    if (!isotropic) source += multiple(r, mu_sun) * m.scattering();
    // Light from a step of constant density, exactly.
    const Rgb through = exp3(-m.extinction * dt);
    const Rgb share = passed * (1.0F - through) / glm::max(m.extinction, Rgb(1e-12F));
    out.light += share * source;
    out.transfer += share * m.scattering();
    passed *= through;
  }
  if (ground) {
    const Vec3 at = Vec3(0.0F, radius, 0.0F) + direction * length;
    const float mu_sun = glm::dot(at, sun) / root(glm::dot(at, at));
    out.light +=
        passed * ground_albedo_ * (kInvPi * std::max(mu_sun, 0.0F)) * sunlight(kGround, mu_sun);
  }
  return out;
}

void SkyModel::tabulate_multiple() {
  constexpr int kDirections = 8;  // squared
  constexpr int kSteps = 20;
  multiple_.resize(size_t{kMultipleWidth} * kMultipleHeight);
  for (int y = 0; y < kMultipleHeight; ++y) {
    const float share = static_cast<float>(y) / (kMultipleHeight - 1);
    const float radius = kGround + 1.0F + (kTop - kGround - 2.0F) * share;
    for (int x = 0; x < kMultipleWidth; ++x) {
      const float mu = 2.0F * static_cast<float>(x) / (kMultipleWidth - 1) - 1.0F;
      const Vec3 sun(root(1.0F - mu * mu), mu, 0.0F);
      Rgb light(0.0F);
      Rgb transfer(0.0F);
      for (int k = 0; k < kDirections * kDirections; ++k) {
        const Vec2 u((static_cast<float>(k % kDirections) + 0.5F) / kDirections,
                     (static_cast<float>(k / kDirections) + 0.5F) / kDirections);
        const SinCos turn = sin_cos(2.0F * kPi * u.x);
        const float height = 1.0F - 2.0F * u.y;
        const float across = root(1.0F - height * height);
        const Gathered g = gather(radius, {across * turn.cos, height, across * turn.sin}, sun,
                                  kSteps, Phases::isotropic);
        light += g.light;
        transfer += g.transfer;
      }
      constexpr float kShare = 1.0F / (kDirections * kDirections);
      // All further orders scatter alike (equations 7 to 10).
      multiple_[static_cast<size_t>(y * kMultipleWidth + x)] =
          light * kShare / (1.0F - transfer * kShare);
    }
  }
}

Rgb SkyModel::multiple(float radius, float mu_sun) const {
  const float y = (radius - kGround) / (kTop - kGround) * (kMultipleHeight - 1);
  const float x = 0.5F * (mu_sun + 1.0F) * (kMultipleWidth - 1);
  return look_up(multiple_, kMultipleWidth, kMultipleHeight, x, y);
}

Rgb SkyModel::transmittance(float sine) const { return sunlight(kGround + kEye, sine); }

Rgb SkyModel::radiance(const Vec3& direction, const Vec3& sun) const {
  constexpr int kSteps = 40;
  return gather(kGround + kEye, direction, sun, kSteps, Phases::real).light;
}

}  // namespace hyades::core
