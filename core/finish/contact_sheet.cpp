#include "core/finish/contact_sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/base/color.h"
#include "core/finish/small_font.h"

namespace hyades::core {
namespace {

constexpr int kGap = 8;
constexpr int kLetterScale = 2;
constexpr int kLabel = (kGlyphHeight + 4) * kLetterScale;
constexpr float kPaper = 0.10F;
constexpr float kInk = 0.72F;

int height_at(const Image& picture, int width) {
  return std::max(
      1, static_cast<int>((static_cast<int64_t>(picture.height) * width + picture.width / 2) /
                          picture.width));
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

void paste(Image& sheet, const Image& picture, const int channels[3], int left, int top,
           int width) {
  const int height = height_at(picture, width);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < 3; ++c) {
        const float mean = covered_mean(picture, channels[c], x, y, width, height);
        sheet.at(left + x, top + y, c) = srgb_encode(std::clamp(mean, 0.0F, 1.0F));
      }
    }
  }
}

/// Letters that would go beyond `width` are left out.
void write(Image& sheet, const std::string& text, int left, int top, int width) {
  constexpr int kAdvance = (kGlyphWidth + 1) * kLetterScale;
  const size_t fitting = std::min(text.size(), static_cast<size_t>(width / kAdvance));
  for (size_t i = 0; i < fitting; ++i) {
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

}  // namespace

Result<Image> contact_sheet(std::span<const ContactPrint> prints, int columns, int width) {
  if (prints.empty() || columns < 1 || width < 1)
    return Error{"there is nothing to put on a sheet"};
  columns = std::min(columns, static_cast<int>(prints.size()));
  std::vector<int> tops;  // of rows; at the end, the sheet's height
  int64_t top = kGap;
  for (size_t i = 0; i < prints.size(); i += static_cast<size_t>(columns)) {
    tops.push_back(static_cast<int>(top));
    int tallest = 0;
    for (size_t k = i; k < std::min(i + static_cast<size_t>(columns), prints.size()); ++k)
      tallest = std::max(tallest, height_at(prints[k].picture, width));
    top += tallest + kLabel + kGap;
  }
  const int64_t sheet_width = int64_t{columns} * (width + kGap) + kGap;
  if (sheet_width * top > 1'000'000'000)
    return Error{fmt::format("the sheet would have {} x {} pixels, expected at most 1e9 in all",
                             sheet_width, top)};
  Image sheet = make_image(static_cast<int>(sheet_width), static_cast<int>(top), {"R", "G", "B"});
  std::fill(sheet.data.begin(), sheet.data.end(), kPaper);
  for (size_t i = 0; i < prints.size(); ++i) {
    const ContactPrint& print = prints[i];
    const int channels[3] = {print.picture.find_channel("R"), print.picture.find_channel("G"),
                             print.picture.find_channel("B")};
    if (std::min({channels[0], channels[1], channels[2]}) < 0)
      return Error{print.name + ": it has no channels R, G, B"};
    const int left = kGap + static_cast<int>(i % static_cast<size_t>(columns)) * (width + kGap);
    const int row_top = tops[i / static_cast<size_t>(columns)];
    paste(sheet, print.picture, channels, left, row_top, width);
    write(sheet, print.name, left, row_top + height_at(print.picture, width) + 2 * kLetterScale,
          width);
  }
  return sheet;
}

}  // namespace hyades::core
