#include "core/finish/contact_sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/color.h"
#include "core/finish/sheet_rows.h"
#include "core/finish/small_font.h"

namespace hyades::core {
namespace {

constexpr int kGap = 8;
constexpr int kLetterScale = 2;
constexpr int kLabel = (kGlyphHeight + 4) * kLetterScale;
constexpr int64_t kMostPixels = 1'000'000'000;
constexpr float kPaper = 0.10F;
constexpr float kInk = 0.72F;

Error too_large(int64_t width, int64_t height) {
  return Error{fmt::format("the sheet would have {} x {} pixels, expected at most 1e9 in all",
                           width, height)};
}

/// The mean of channel `c` over what one pixel of the scaled picture covers.
float covered_mean(const Image& picture, int c, int x, int y, int width, int height) {
  const auto range = [](int i, int count, int size) {
    const int first = static_cast<int>(int64_t{i} * size / count);
    const int end = static_cast<int>(int64_t{i + 1} * size / count);
    return std::pair(first, std::max(end, first + 1));
  };
  const auto [x0, x1] = range(x, width, picture.width);
  const auto [y0, y1] = range(y, height, picture.height);
  float sum = 0.0F;
  for (int j = y0; j < y1; ++j) {
    for (int i = x0; i < x1; ++i) sum += picture.at(i, j, c);
  }
  return sum / static_cast<float>((x1 - x0) * (y1 - y0));
}

/// Where a picture comes to stand on the sheet, in pixels.
struct Place {
  int left = 0, top = 0, width = 1, height = 1;
};

void paste(Image& sheet, const Image& picture, const int channels[3], const Place& at) {
  for (int y = 0; y < at.height; ++y) {
    for (int x = 0; x < at.width; ++x) {
      for (int c = 0; c < 3; ++c) {
        const float mean = covered_mean(picture, channels[c], x, y, at.width, at.height);
        sheet.at(at.left + x, at.top + y, c) = srgb_encode(std::clamp(mean, 0.0F, 1.0F));
      }
    }
  }
}

constexpr int kAdvance = (kGlyphWidth + 1) * kLetterScale;

/// Of a name that is too long the end, which has the frame's number.
std::string shortened(const std::string& name, size_t letters) {
  constexpr std::string_view kDots = "...";
  if (name.size() <= letters) return name;
  if (letters <= 2 * kDots.size()) return name.substr(name.size() - letters);
  return std::string(kDots) + name.substr(name.size() - letters + kDots.size());
}

void write(Image& sheet, const std::string& name, int left, int top, int width) {
  const std::string text = shortened(name, static_cast<size_t>(width / kAdvance));
  for (size_t i = 0; i < text.size(); ++i) {
    const auto rows = glyph_of(text[i]);
    for (int y = 0; y < kGlyphHeight * kLetterScale; ++y) {
      for (int x = 0; x < kGlyphWidth * kLetterScale; ++x) {
        const int bit = kGlyphWidth - 1 - x / kLetterScale;
        if ((rows[static_cast<size_t>(y / kLetterScale)] >> bit & 1) == 0) continue;
        for (int c = 0; c < 3; ++c)
          sheet.at(left + static_cast<int>(i) * kAdvance + x, top + y, c) = kInk;
      }
    }
  }
}

double aspect_of(const Image& picture) {
  return static_cast<double>(picture.width) / picture.height;
}

/// The places of all pictures, row by row, on a sheet that is `width` pixels wide within its
/// margins.
std::vector<Place> places_of(std::span<const ContactPrint> prints, int columns, int width) {
  std::vector<double> aspects;
  for (const ContactPrint& print : prints) aspects.push_back(aspect_of(print.picture));
  std::vector<Place> places;
  int64_t top = kGap;
  for (const SheetRow& row : sheet_rows(aspects, columns, width, kGap)) {
    const int height = std::max(1, static_cast<int>(std::lround(row.height)));
    double edge = kGap;
    for (size_t i = row.first; i < row.end; ++i) {
      const double next = edge + aspects[i] * row.height;
      // Edges are rounded, not widths, so that all rows end at the same place.
      const int left = static_cast<int>(std::lround(edge));
      const int right = static_cast<int>(std::lround(next));
      places.push_back({left, static_cast<int>(top), std::max(1, right - left), height});
      edge = next + kGap;
    }
    top += height + kLabel + kGap;
    if (top > kMostPixels) break;
  }
  return places;
}

}  // namespace

Result<Image> contact_sheet(std::span<const ContactPrint> prints, int columns, int width) {
  if (prints.empty() || columns < 1 || width < 1)
    return Error{"there is nothing to put on a sheet"};
  columns = std::min(columns, static_cast<int>(prints.size()));
  const int64_t sheet_width = int64_t{columns} * (width + kGap) + kGap;
  if (sheet_width > kMostPixels) return too_large(sheet_width, 1);
  const auto places = places_of(prints, columns, static_cast<int>(sheet_width) - 2 * kGap);
  const int64_t sheet_height = int64_t{places.back().top} + places.back().height + kLabel + kGap;
  if (places.size() < prints.size() || sheet_width * sheet_height > kMostPixels)
    return too_large(sheet_width, sheet_height);
  Image sheet =
      make_image(static_cast<int>(sheet_width), static_cast<int>(sheet_height), {"R", "G", "B"});
  std::fill(sheet.data.begin(), sheet.data.end(), kPaper);
  for (size_t i = 0; i < prints.size(); ++i) {
    const ContactPrint& print = prints[i];
    const int channels[3] = {print.picture.find_channel("R"), print.picture.find_channel("G"),
                             print.picture.find_channel("B")};
    if (std::min({channels[0], channels[1], channels[2]}) < 0)
      return Error{print.name + ": it has no channels R, G, B"};
    const Place& place = places[i];
    paste(sheet, print.picture, channels, place);
    write(sheet, print.name, place.left, place.top + place.height + 2 * kLetterScale, place.width);
  }
  return sheet;
}

}  // namespace hyades::core
