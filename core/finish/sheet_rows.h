#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace hyades::core {

/// Pictures that stand side by side, all of the same height.
struct SheetRow {
  size_t first = 0;
  size_t end = 0;       ///< one past the last
  double height = 0.0;  ///< pixels, above 0
};

/// Breaks pictures, in their order, into rows `width` pixels wide with `gap` pixels between two
/// pictures, as a paragraph is broken into lines: each row is as high as makes it fill the width,
/// and all are as nearly as possible as high as what puts `columns` pictures into a row. Pictures
/// of one shape come to stand in a grid. A last row that would have to grow by more than a quarter
/// is left short. `aspects` are widths over heights, above 0; `columns` is at least 1.
std::vector<SheetRow> sheet_rows(std::span<const double> aspects, int columns, int width, int gap);

}  // namespace hyades::core
