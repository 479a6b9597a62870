#include "core/image/icc_profile.h"

#include <array>
#include <cstddef>
#include <span>
#include <string_view>
#include <utility>

namespace hyades::core {
namespace {

using IccBytes = std::vector<uint8_t>;
/// The format's numbers with a fraction: signed, 16 bits behind the point (ICC.1:2010, 4.6).
using Fixed = int32_t;

constexpr std::array<Fixed, 3> kD50 = {63190, 65536, 54061};  // ICC.1:2010, 7.2.16
// XYZ of Rec.709's primaries, and the matrix that takes its white (x 0.3127, y 0.3290) to D50 by
// Bradford's cone responses (ICC.1:2010, annex E), with which they are multiplied.
constexpr std::array<Fixed, 3> kRed = {28576, 14581, 912};
constexpr std::array<Fixed, 3> kGreen = {25239, 46983, 6361};
constexpr std::array<Fixed, 3> kBlue = {9375, 3972, 46787};
constexpr std::array<Fixed, 9> kAdaptation = {68674, 1502, -3291, 1939, 64912,
                                              -1119, -606, 988,   49262};
// IEC 61966-2-1: ((x + 0.055) / 1.055)^2.4 from 0.04045 on, x / 12.92 below.
constexpr std::array<Fixed, 5> kSrgbCurve = {157286, 62119, 3417, 5072, 2651};
constexpr std::array<Fixed, 1> kNoCurve = {65536};

constexpr uint32_t kHeaderBytes = 128;
constexpr uint32_t kVersion = 0x04300000;

void add(IccBytes& bytes, std::string_view text) {
  for (const char letter : text) bytes.push_back(static_cast<uint8_t>(letter));
}

void add(IccBytes& bytes, uint32_t number) {
  for (unsigned shift = 32; shift > 0; shift -= 8) {
    bytes.push_back(static_cast<uint8_t>(number >> (shift - 8)));
  }
}

void add(IccBytes& bytes, std::span<const Fixed> numbers) {
  for (const Fixed number : numbers) add(bytes, static_cast<uint32_t>(number));
}

IccBytes element(std::string_view type, std::span<const Fixed> numbers) {
  IccBytes bytes;
  add(bytes, type);
  add(bytes, 0);
  add(bytes, numbers);
  return bytes;
}

/// parametricCurveType (ICC.1:2010, 10.15): function 3 is the sRGB curve's form, 0 a power.
IccBytes curve(uint32_t function, std::span<const Fixed> numbers) {
  IccBytes bytes;
  add(bytes, "para");
  add(bytes, 0);
  add(bytes, function << 16U);
  add(bytes, numbers);
  return bytes;
}

/// multiLocalizedUnicodeType (10.13) with one text, in English.
IccBytes text(std::string_view ascii) {
  IccBytes bytes;
  add(bytes, "mluc");
  add(bytes, 0);
  add(bytes, 1);
  add(bytes, 12);
  add(bytes, "enUS");
  add(bytes, static_cast<uint32_t>(2 * ascii.size()));
  add(bytes, 28);
  for (const char letter : ascii) {
    bytes.push_back(0);
    bytes.push_back(static_cast<uint8_t>(letter));
  }
  return bytes;
}

/// ICC.1:2010, 7.2; without a date, as files are to be the same whenever they are made.
IccBytes header(uint32_t size) {
  IccBytes bytes;
  add(bytes, size);
  add(bytes, 0);
  add(bytes, kVersion);
  add(bytes, "mntrRGB XYZ ");
  bytes.resize(36);
  add(bytes, "acsp");
  bytes.resize(68);
  add(bytes, kD50);
  bytes.resize(kHeaderBytes);
  return bytes;
}

}  // namespace

std::vector<uint8_t> icc_profile(ColorTag tag) {
  if (tag == ColorTag::none) return {};
  const bool srgb = tag == ColorTag::srgb;
  const IccBytes tone = srgb ? curve(3, kSrgbCurve) : curve(0, kNoCurve);
  const std::pair<std::string_view, IccBytes> tags[] = {
      {"desc", text(srgb ? "sRGB (Hyades)" : "Linear Rec.709 (Hyades)")},
      {"cprt", text("No copyright, use freely")},
      {"wtpt", element("XYZ ", kD50)},
      {"chad", element("sf32", kAdaptation)},
      {"rXYZ", element("XYZ ", kRed)},
      {"gXYZ", element("XYZ ", kGreen)},
      {"bXYZ", element("XYZ ", kBlue)},
      {"rTRC", tone},
      {"gTRC", tone},
      {"bTRC", tone},
  };
  constexpr uint32_t kTags = std::size(tags);
  const uint32_t data_at = kHeaderBytes + 4 + 12 * kTags;
  IccBytes table;
  IccBytes data;
  add(table, kTags);
  uint32_t at = data_at;
  for (const auto& [name, value] : tags) {
    // The three curves are one.
    if (!name.ends_with("TRC") || name == "rTRC") {
      at = data_at + static_cast<uint32_t>(data.size());
      data.insert(data.end(), value.begin(), value.end());
      data.resize((data.size() + 3) / 4 * 4);
    }
    add(table, name);
    add(table, at);
    add(table, static_cast<uint32_t>(value.size()));
  }
  IccBytes profile = header(data_at + static_cast<uint32_t>(data.size()));
  profile.insert(profile.end(), table.begin(), table.end());
  profile.insert(profile.end(), data.begin(), data.end());
  return profile;
}

}  // namespace hyades::core
