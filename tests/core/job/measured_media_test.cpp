#include "core/job/measured_media.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "core/job/parse.h"
#include "tests/core/job/test_assets.h"

namespace hyades::core {
namespace {

using testing::HasSubstr;

/// Undiluted coefficients in 1/mm as another table has them, which lists scattering reduced by
/// (1 - g) and no g.
struct ReducedRow {
  const char* name;
  double reduced_scattering[3];
  double absorption[3];
};

// clang-format off
constexpr ReducedRow kUndiluted[] = {
    {"lowfat-milk", {0.89187, 1.5136, 2.532}, {0.002875, 0.00575, 0.0115}},
    {"reduced-milk", {2.4858, 3.1669, 4.5214}, {0.0025556, 0.0051111, 0.012778}},
    {"regular-milk", {4.5513, 5.8294, 7.136}, {0.0015333, 0.0046, 0.019933}},
    {"espresso", {0.72378, 0.84557, 1.0247}, {4.7984, 6.5751, 8.8493}},
    {"mint-mocha-coffee", {0.31602, 0.38538, 0.48131}, {3.772, 5.8228, 7.82}},
    {"lowfat-soy-milk", {0.30576, 0.34233, 0.61664}, {0.0014375, 0.0071875, 0.035937}},
    {"regular-soy-milk", {0.59223, 0.73866, 1.4693}, {0.0019167, 0.0095833, 0.065167}},
    {"lowfat-chocolate-milk", {0.64925, 0.83916, 1.1057}, {0.0115, 0.0368, 0.1564}},
    {"regular-chocolate-milk", {1.4585, 2.1289, 2.9527}, {0.010063, 0.043125, 0.14375}},
    {"coke", {8.9053e-05, 8.372e-05, 0}, {0.10014, 0.16503, 0.2468}},
    {"pepsi", {6.1697e-05, 4.2564e-05, 0}, {0.091641, 0.14158, 0.20729}},
    {"sprite", {6.0306e-06, 6.4139e-06, 6.5504e-06}, {0.001886, 0.0018308, 0.0020025}},
    {"gatorade", {0.0024574, 0.003007, 0.0037325}, {0.024794, 0.019289, 0.008878}},
    {"chardonnay", {1.7982e-05, 1.3758e-05, 1.2023e-05}, {0.010782, 0.011855, 0.023997}},
    {"white-zinfandel", {1.7501e-05, 1.9069e-05, 1.288e-05}, {0.012072, 0.016184, 0.019843}},
    {"merlot", {2.1129e-05, 0, 0}, {0.11632, 0.25191, 0.29434}},
    {"budweiser-beer", {2.4356e-05, 2.4079e-05, 1.0564e-05}, {0.011492, 0.024911, 0.057786}},
    {"coors-light-beer", {5.0922e-05, 4.301e-05, 0}, {0.006164, 0.013984, 0.034983}},
    {"clorox", {0.0024035, 0.0031373, 0.003991}, {0.0033542, 0.014892, 0.026297}},
    {"apple-juice", {0.00013612, 0.00015836, 0.000227}, {0.012957, 0.023741, 0.052184}},
    {"cranberry-juice", {0.00010402, 0.00011646, 7.8139e-05}, {0.039437, 0.094223, 0.12426}},
    {"grape-juice", {5.382e-05, 0, 0}, {0.10404, 0.23958, 0.29325}},
    {"ruby-grapefruit-juice", {0.011002, 0.010927, 0.011036}, {0.085867, 0.18314, 0.25262}},
    {"white-grapefruit-juice", {0.22826, 0.23998, 0.32748}, {0.0138, 0.018831, 0.056781}},
    {"shampoo", {0.0007176, 0.0008303, 0.0009016}, {0.014107, 0.045693, 0.061717}},
    {"strawberry-shampoo", {0.00015671, 0.00015947, 1.518e-05}, {0.01449, 0.05796, 0.075823}},
    {"head-and-shoulders-shampoo", {0.023805, 0.028804, 0.034306}, {0.084621, 0.15688, 0.20365}},
    {"lemon-tea-powder", {0.040224, 0.045264, 0.051081}, {2.4288, 4.5757, 7.2127}},
    {"orange-juice-powder", {0.00015617, 0.00017482, 0.0001762}, {0.001449, 0.003441, 0.007863}},
    {"pink-lemonade-powder", {0.00012103, 0.00013073, 0.00012528}, {0.001165, 0.002366, 0.003195}},
    {"cappuccino-powder", {1.8436, 2.5851, 2.1662}, {35.844, 49.547, 61.084}},
    {"salt-powder", {0.027333, 0.032451, 0.031979}, {0.28415, 0.3257, 0.34148}},
    {"sugar-powder", {0.00022272, 0.00025513, 0.000271}, {0.012638, 0.031051, 0.050124}},
    {"suisse-mocha-powder", {2.7979, 3.5452, 4.3365}, {17.502, 27.004, 35.433}},
    {"pacific-ocean-surface-water", {0.0001764, 0.00032095, 0.00019617}, {0.031845, 0.031324, 0.030147}},
};
// clang-format on

TEST(MeasuredMedia, ReducedScatteringAgreesAcrossPublishedTables) {
  for (const ReducedRow& row : kUndiluted) {
    const MeasuredMedium* medium = find_measured_medium(row.name);
    ASSERT_NE(medium, nullptr) << row.name;
    for (int c = 0; c < 3; ++c) {
      const double reduced = 1e-3 * medium->scattering[c] * (1.0 - double{medium->g[c]});
      EXPECT_NEAR(reduced, row.reduced_scattering[c], 0.005 * row.reduced_scattering[c])
          << row.name << " channel " << c;
      EXPECT_NEAR(1e-3 * medium->absorption[c], row.absorption[c], 0.005 * row.absorption[c])
          << row.name << " channel " << c;
    }
  }
}

/// What Jensen et al. 2001 list beside the coefficients: the diffuse reflectance of a thick block,
/// which their dipole gives.
struct ReflectanceRow {
  const char* name;
  double reflectance[3];
};

/// The paper's 0.10 is not what its formula gives (0.126).
constexpr double kLeftOut = -1.0;

constexpr ReflectanceRow kReflectances[] = {
    {"apple", {0.85, 0.84, 0.53}},      {"chicken-1", {0.31, 0.15, kLeftOut}},
    {"chicken-2", {0.32, 0.16, 0.10}},  {"cream", {0.98, 0.90, 0.73}},
    {"ketchup", {0.16, 0.01, 0.00}},    {"marble", {0.83, 0.79, 0.75}},
    {"potato", {0.77, 0.62, 0.21}},     {"skim-milk", {0.81, 0.81, 0.69}},
    {"skin-1", {0.44, 0.22, 0.13}},     {"skin-2", {0.63, 0.44, 0.34}},
    {"spectralon", {1.00, 1.00, 1.00}}, {"whole-milk", {0.91, 0.88, 0.76}},
};

/// Jensen et al. 2001, section 2.2: Rd of the dipole, with their fit of the inner reflectance.
double dipole_reflectance(double scattering, double absorption, double eta) {
  const double inner = -1.440 / (eta * eta) + 0.710 / eta + 0.668 + 0.0636 * eta;
  const double boundary = (1.0 + inner) / (1.0 - inner);
  const double albedo = scattering / (scattering + absorption);
  const double root = std::sqrt(3.0 * (1.0 - albedo));
  return 0.5 * albedo * (1.0 + std::exp(-4.0 / 3.0 * boundary * root)) * std::exp(-root);
}

TEST(MeasuredMedia, GiveTheReflectancesThatTheirPaperLists) {
  for (const ReflectanceRow& row : kReflectances) {
    const MeasuredMedium* medium = find_measured_medium(row.name);
    ASSERT_NE(medium, nullptr) << row.name;
    EXPECT_FALSE(medium->g_measured);
    for (int c = 0; c < 3; ++c) {
      if (row.reflectance[c] == kLeftOut) continue;
      const double found =
          dipole_reflectance(medium->scattering[c], medium->absorption[c], medium->index);
      EXPECT_NEAR(found, row.reflectance[c], 0.012) << row.name << " channel " << c;
    }
  }
}

TEST(MeasuredMedia, AreUsable) {
  EXPECT_EQ(measured_media().size(), 47U);
  for (const MeasuredMedium& medium : measured_media()) {
    for (int c = 0; c < 3; ++c) {
      EXPECT_TRUE(std::isfinite(medium.scattering[c]) && medium.scattering[c] >= 0.0F);
      EXPECT_TRUE(std::isfinite(medium.absorption[c]) && medium.absorption[c] >= 0.0F);
      EXPECT_LT(std::abs(medium.g[c]), 1.0F) << medium.name;
      // What does not scatter has no direction: some copies hold 0 / 0 there.
      if (medium.scattering[c] == 0.0F) {
        EXPECT_EQ(medium.g[c], 0.0F) << medium.name;
      }
    }
    EXPECT_TRUE(medium.index == 1.3F || medium.index == 1.33F || medium.index == 1.5F);
    EXPECT_EQ(find_measured_medium(medium.name), &medium);
  }
  EXPECT_EQ(find_measured_medium("Skim Milk"), find_measured_medium("skim-milk"));
  EXPECT_EQ(find_measured_medium("Wholemilk"), find_measured_medium("whole-milk"));
  EXPECT_EQ(find_measured_medium("tar"), nullptr);
}

TEST(MeasuredMedia, AreAllInTheReference) {
  std::ifstream file("docs/job.md");
  std::stringstream page;
  page << file.rdbuf();
  const std::string text = page.str();
  for (const char* source : {"Jensen et al. 2001", "Narasimhan et al. 2006"}) {
    std::string row = std::string("| ") + source + " | ";
    for (const MeasuredMedium& medium : measured_media()) {
      if (medium.source != source) continue;
      row += (row.ends_with("| ") ? "" : ", ") + medium.name;
    }
    EXPECT_THAT(text, HasSubstr(row + " |"));
  }
}

struct ReadMedia {
  Job job;
  std::string complaints;
};

ReadMedia read_media(const std::string& text) {
  MemoryAssets assets;
  Diagnostics diagnostics;
  ReadMedia result;
  result.job = parse_job("hyades: 1\n" + text, "job.yaml", assets, diagnostics);
  result.complaints = diagnostics.to_string();
  return result;
}

TEST(Presets, MeanTheSameInEveryUnit) {
  for (const auto& [unit, metres] : {std::pair("m", 1.0F), std::pair("mm", 0.001F)}) {
    const ReadMedia found = read_media(
        std::string("media: {milk: {preset: whole-milk, scale: 2}}\nunits: ") + unit + "\n");
    ASSERT_EQ(found.complaints, "");
    const MediumDesc& milk = found.job.media.at(0);
    EXPECT_NEAR(milk.scattering.constant.x / metres, 2550.0F, 0.01F);
    EXPECT_NEAR(milk.absorption.constant.z / metres, 14.0F, 1e-4F);
    EXPECT_EQ(milk.scale.constant, 2.0F);
    EXPECT_EQ(milk.index->constant, 1.3F);
  }
  const ReadMedia beer = read_media("media: {beer: {preset: budweiser beer, index: 1.35}}");
  ASSERT_EQ(beer.complaints, "");
  EXPECT_EQ(beer.job.media[0].g.constant, Rgb(0.917F, 0.956F, 0.982F));
  EXPECT_EQ(beer.job.media[0].index->constant, 1.35F);
}

TEST(Presets, ComplainOnceWithASuggestion) {
  EXPECT_EQ(read_media("media: {milk: {preset: skimm-milk}}").complaints,
            "job.yaml:2:24: preset is 'skimm-milk', expected the name of a measured "
            "material ('hyades media' lists them), did you mean 'skim-milk'?\n");
  EXPECT_EQ(read_media("media: {milk: {preset: cream, g: 0.5}}").complaints,
            "job.yaml:2:34: medium 'milk' has both preset and g, expected a preset with scale, "
            "emission or index alone\n");
  EXPECT_THAT(read_media("media: {milk: {preset: [cream]}}").complaints,
              HasSubstr("preset is a list of 1, expected the name of a measured material"));
}

}  // namespace
}  // namespace hyades::core
