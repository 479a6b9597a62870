#include "core/job/measured_media.h"
#include "core/base/text.h"

namespace hyades::core {
namespace {

/// Jensen et al. 2001, figure 5: reduced scattering and absorption in 1/mm. Copies differ in the
/// red absorption of chicken; only these values give the diffuse reflectance of the same row.
struct ReducedRow {
  const char* name;
  float reduced_scattering[3];
  float absorption[3];
  float index;
};

constexpr ReducedRow kReduced[] = {
    {"apple", {2.29F, 2.39F, 1.97F}, {0.0030F, 0.0034F, 0.046F}, 1.3F},
    {"chicken-1", {0.15F, 0.21F, 0.38F}, {0.015F, 0.077F, 0.19F}, 1.3F},
    {"chicken-2", {0.19F, 0.25F, 0.32F}, {0.018F, 0.088F, 0.20F}, 1.3F},
    {"cream", {7.38F, 5.47F, 3.15F}, {0.0002F, 0.0028F, 0.0163F}, 1.3F},
    {"ketchup", {0.18F, 0.07F, 0.03F}, {0.061F, 0.97F, 1.45F}, 1.3F},
    {"marble", {2.19F, 2.62F, 3.00F}, {0.0021F, 0.0041F, 0.0071F}, 1.5F},
    {"potato", {0.68F, 0.70F, 0.55F}, {0.0024F, 0.0090F, 0.12F}, 1.3F},
    {"skim-milk", {0.70F, 1.22F, 1.90F}, {0.0014F, 0.0025F, 0.0142F}, 1.3F},
    {"skin-1", {0.74F, 0.88F, 1.01F}, {0.032F, 0.17F, 0.48F}, 1.3F},
    {"skin-2", {1.09F, 1.59F, 1.79F}, {0.013F, 0.070F, 0.145F}, 1.3F},
    {"spectralon", {11.6F, 20.4F, 14.9F}, {0.0F, 0.0F, 0.0F}, 1.3F},
    {"whole-milk", {2.55F, 3.21F, 3.77F}, {0.0011F, 0.0024F, 0.014F}, 1.3F},
};

/// Narasimhan et al. 2006: extinction and scattering in 1/100 mm of `volume` ml of the material
/// (for powders teaspoons of 4.928 ml, cups of 236.59 ml) in 23 l of water; undiluted it has 23000
/// / volume times as much. Where nothing scatters, g is 0 here. The index is that of water.
struct DilutedRow {
  const char* name;
  double volume;
  double extinction[3];
  double scattering[3];
  double g[3];
};

constexpr double kTank = 23000.0;  ///< ml
constexpr float kWaterIndex = 1.33F;

// clang-format off
constexpr DilutedRow kDiluted[] = {
    {"lowfat-milk", 16.0, {0.9126, 1.0748, 1.2500}, {0.9124, 1.0744, 1.2492}, {0.932, 0.902, 0.859}},
    {"reduced-milk", 18.0, {1.0750, 1.2213, 1.3941}, {1.0748, 1.2209, 1.3931}, {0.819, 0.797, 0.746}},
    {"regular-milk", 15.0, {1.1874, 1.3296, 1.4602}, {1.1873, 1.3293, 1.4589}, {0.750, 0.714, 0.681}},
    {"espresso", 8.0, {0.4376, 0.5115, 0.6048}, {0.2707, 0.2828, 0.2970}, {0.907, 0.896, 0.880}},
    {"mint-mocha-coffee", 6.0, {0.1900, 0.2600, 0.3500}, {0.0916, 0.1081, 0.1460}, {0.910, 0.907, 0.914}},
    {"lowfat-soy-milk", 16.0, {0.1419, 0.1625, 0.2740}, {0.1418, 0.1620, 0.2715}, {0.850, 0.853, 0.842}},
    {"regular-soy-milk", 12.0, {0.2434, 0.2719, 0.4597}, {0.2433, 0.2714, 0.4563}, {0.873, 0.858, 0.832}},
    {"lowfat-chocolate-milk", 10.0, {0.4282, 0.5014, 0.5791}, {0.4277, 0.4998, 0.5723}, {0.934, 0.927, 0.916}},
    {"regular-chocolate-milk", 16.0, {0.7359, 0.9172, 1.0688}, {0.7352, 0.9142, 1.0588}, {0.862, 0.838, 0.806}},
    {"coke", 1600.0, {0.7143, 1.1688, 1.7169}, {0.0177, 0.0208, 0.0000}, {0.965, 0.972, 0.000}},
    {"pepsi", 1600.0, {0.6433, 0.9990, 1.4420}, {0.0058, 0.0141, 0.0000}, {0.926, 0.979, 0.000}},
    {"sprite", 15000.0, {0.1299, 0.1283, 0.1395}, {0.0069, 0.0089, 0.0089}, {0.943, 0.953, 0.952}},
    {"gatorade", 1500.0, {0.4009, 0.4185, 0.4324}, {0.2392, 0.2927, 0.3745}, {0.933, 0.933, 0.935}},
    {"chardonnay", 3300.0, {0.1577, 0.1748, 0.3512}, {0.0030, 0.0047, 0.0069}, {0.914, 0.958, 0.975}},
    {"white-zinfandel", 3300.0, {0.1763, 0.2370, 0.2913}, {0.0031, 0.0048, 0.0066}, {0.919, 0.943, 0.972}},
    {"merlot", 1500.0, {0.7639, 1.6429, 1.9196}, {0.0053, 0.0000, 0.0000}, {0.974, 0.000, 0.000}},
    {"budweiser-beer", 2900.0, {0.1486, 0.3210, 0.7360}, {0.0037, 0.0069, 0.0074}, {0.917, 0.956, 0.982}},
    {"coors-light-beer", 1000.0, {0.0295, 0.0663, 0.1521}, {0.0027, 0.0055, 0.0000}, {0.918, 0.966, 0.000}},
    {"clorox", 1200.0, {0.1600, 0.2500, 0.3300}, {0.1425, 0.1723, 0.1928}, {0.912, 0.905, 0.892}},
    {"apple-juice", 1800.0, {0.1215, 0.2101, 0.4407}, {0.0201, 0.0243, 0.0323}, {0.947, 0.949, 0.945}},
    {"cranberry-juice", 1500.0, {0.2700, 0.6300, 0.8300}, {0.0128, 0.0155, 0.0196}, {0.947, 0.951, 0.974}},
    {"grape-juice", 1200.0, {0.5500, 1.2500, 1.5300}, {0.0072, 0.0000, 0.0000}, {0.961, 0.000, 0.000}},
    {"ruby-grapefruit-juice", 240.0, {0.2513, 0.3517, 0.4305}, {0.1617, 0.1606, 0.1669}, {0.929, 0.929, 0.931}},
    {"white-grapefruit-juice", 160.0, {0.3609, 0.3800, 0.5632}, {0.3513, 0.3669, 0.5237}, {0.548, 0.545, 0.565}},
    {"shampoo", 300.0, {0.0288, 0.0710, 0.0952}, {0.0104, 0.0114, 0.0147}, {0.910, 0.905, 0.920}},
    {"strawberry-shampoo", 300.0, {0.0217, 0.0788, 0.1022}, {0.0028, 0.0032, 0.0033}, {0.927, 0.935, 0.994}},
    {"head-and-shoulders-shampoo", 240.0, {0.3674, 0.4527, 0.5211}, {0.2791, 0.2890, 0.3086}, {0.911, 0.896, 0.884}},
    {"lemon-tea-powder", 24.64, {0.3400, 0.5800, 0.8800}, {0.0798, 0.0898, 0.1073}, {0.946, 0.946, 0.949}},
    {"orange-juice-powder", 23000.0, {0.3377, 0.5573, 1.0122}, {0.1928, 0.2132, 0.2259}, {0.919, 0.918, 0.922}},
    {"pink-lemonade-powder", 23000.0, {0.2400, 0.3700, 0.4500}, {0.1235, 0.1334, 0.1305}, {0.902, 0.902, 0.904}},
    {"cappuccino-powder", 1.232, {0.2574, 0.3536, 0.4840}, {0.0654, 0.0882, 0.1568}, {0.849, 0.843, 0.926}},
    {"salt-powder", 414.03, {0.7600, 0.8685, 0.9363}, {0.2485, 0.2822, 0.3216}, {0.802, 0.793, 0.821}},
    {"sugar-powder", 1182.94, {0.0795, 0.1759, 0.2780}, {0.0145, 0.0162, 0.0202}, {0.921, 0.919, 0.931}},
    {"suisse-mocha-powder", 2.464, {0.5098, 0.6476, 0.7944}, {0.3223, 0.3583, 0.4148}, {0.907, 0.894, 0.888}},
    {"pacific-ocean-surface-water", 23000.0, {3.3645, 3.3158, 3.2428}, {0.1800, 0.1834, 0.2281}, {0.902, 0.825, 0.914}},
};
// clang-format on

Rgb rgb(const float (&v)[3]) { return {v[0], v[1], v[2]}; }
Vec3d vec3d(const double (&v)[3]) { return {v[0], v[1], v[2]}; }

std::vector<MeasuredMedium> make_media() {
  constexpr float kPerMillimetre = 1000.0F;
  std::vector<MeasuredMedium> media;
  for (const ReducedRow& row : kReduced) {
    MeasuredMedium medium;
    medium.name = row.name;
    medium.absorption = rgb(row.absorption) * kPerMillimetre;
    medium.scattering = rgb(row.reduced_scattering) * kPerMillimetre;
    medium.index = row.index;
    medium.source = "Jensen et al. 2001";
    media.push_back(medium);
  }
  for (const DilutedRow& row : kDiluted) {
    const double undiluted = 0.01 * kPerMillimetre * kTank / row.volume;
    MeasuredMedium medium;
    medium.name = row.name;
    medium.absorption = Rgb((vec3d(row.extinction) - vec3d(row.scattering)) * undiluted);
    medium.scattering = Rgb(vec3d(row.scattering) * undiluted);
    medium.g = Rgb(vec3d(row.g));
    medium.g_measured = true;
    medium.index = kWaterIndex;
    medium.source = "Narasimhan et al. 2006";
    media.push_back(medium);
  }
  return media;
}

/// Letters and digits alone, in lower case.
std::string plain(std::string_view name) {
  std::string result = lower_case(name);
  std::erase_if(result, [](char c) { return c == ' ' || c == '-' || c == '_'; });
  return result;
}

}  // namespace

std::span<const MeasuredMedium> measured_media() {
  static const std::vector<MeasuredMedium> media = make_media();
  return media;
}

const MeasuredMedium* find_measured_medium(std::string_view name) {
  const std::string wanted = plain(name);
  for (const MeasuredMedium& medium : measured_media()) {
    if (plain(medium.name) == wanted) return &medium;
  }
  return nullptr;
}

const std::vector<std::string>& measured_medium_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const MeasuredMedium& medium : measured_media()) all.push_back(medium.name);
    return all;
  }();
  return names;
}

}  // namespace hyades::core
