#include <optional>
#include <string>
#include <vector>

#include "core/materials/make_material.h"

namespace hyades::core {
namespace {

/// Measured spectra n(lambda) + i k(lambda), brought to linear Rec.709 channels: each value is the
/// average of n (k) over 380-780 nm, weighed with the channel's matching function (the CIE 1931 2
/// degree observer through the Rec.709 matrix) times illuminant D65, normalised per channel.
/// Spectra:
/// - gold, silver, copper: Johnson and Christy 1972, "Optical Constants of the Noble Metals",
///   Phys. Rev. B 6, 4370
/// - chromium, cobalt, iron, nickel, palladium, titanium: Johnson and Christy 1974, "Optical
///   Constants of Transition Metals", Phys. Rev. B 9, 5056
/// - aluminium: Rakic 1995, "Algorithm for the Determination of Intrinsic Optical Constants of
/// Metal
///   Films: Application to Aluminum", Appl. Opt. 34, 4755
/// - platinum, tungsten: Rakic et al. 1998, "Optical Properties of Metallic Films for
///   Vertical-Cavity Optoelectronic Devices", Appl. Opt. 37, 5271 (Brendel-Bormann model)
/// - brass (70 % copper, 30 % zinc): Querry 1985, "Optical Constants", CRDC-CR-85034
struct MetalRow {
  const char* name;
  float eta[3];
  float k[3];
};

constexpr MetalRow kMetals[] = {
    {"aluminium", {1.4732F, 0.9856F, 0.5977F}, {7.6368F, 6.5562F, 5.3464F}},
    {"brass", {0.4210F, 0.5184F, 1.1230F}, {3.6556F, 2.6869F, 1.7704F}},
    {"chromium", {3.2491F, 3.1087F, 2.2791F}, {3.2874F, 3.3381F, 3.1244F}},
    {"cobalt", {2.2474F, 2.0341F, 1.7092F}, {4.2119F, 3.7938F, 3.2327F}},
    {"copper", {0.1790F, 1.0408F, 1.2904F}, {3.2702F, 2.6045F, 2.3663F}},
    {"gold", {0.0631F, 0.4973F, 1.4593F}, {3.6005F, 2.3297F, 1.8177F}},
    {"iron", {2.9233F, 2.9177F, 2.5454F}, {3.0740F, 2.9382F, 2.7498F}},
    {"nickel", {2.0208F, 1.9019F, 1.7242F}, {4.1645F, 3.5685F, 2.8853F}},
    {"palladium", {1.7855F, 1.6208F, 1.3920F}, {4.3376F, 3.8109F, 3.2045F}},
    {"platinum", {2.3406F, 2.0679F, 1.8219F}, {4.2256F, 3.6789F, 3.0835F}},
    {"silver", {0.0556F, 0.0547F, 0.0429F}, {4.3534F, 3.5350F, 2.5672F}},
    {"titanium", {2.7338F, 2.5087F, 2.2362F}, {3.8234F, 3.3996F, 3.0096F}},
    {"tungsten", {3.6636F, 3.4923F, 3.2964F}, {2.8129F, 2.7518F, 2.5950F}},
};

}  // namespace

std::optional<MetalIndex> find_metal(const std::string& name) {
  for (const MetalRow& row : kMetals) {
    if (name == row.name) {
      return MetalIndex{name, {row.eta[0], row.eta[1], row.eta[2]}, {row.k[0], row.k[1], row.k[2]}};
    }
  }
  return std::nullopt;
}

std::vector<std::string> metal_names() {
  std::vector<std::string> names;
  for (const MetalRow& row : kMetals) names.emplace_back(row.name);
  return names;
}

}  // namespace hyades::core
