#include "core/finish/sheet_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hyades::core {
namespace {

/// How much higher than wanted a last row may become before it is left short.
constexpr double kMostGrowth = 1.25;
/// What a last row without pictures would cost, in units of squared logarithms of heights: little,
/// so that a grid stays one.
constexpr double kEmptiness = 0.02;

struct Line {
  double height = 0.0;
  double cost = 0.0;
};

/// `aspect` is the sum of a row's aspects, `room` what its pictures have of its width.
Line line_of(double aspect, double room, double wanted, bool last) {
  const double filling = std::max(room, 1.0) / aspect;
  if (last && filling > kMostGrowth * wanted)
    return {wanted, kEmptiness * (1.0 - wanted / filling)};
  const double off = std::log(filling / wanted);
  return {filling, off * off};
}

}  // namespace

std::vector<SheetRow> sheet_rows(std::span<const double> aspects, int columns, int width, int gap) {
  const size_t count = aspects.size();
  double sum = 0.0;
  for (const double aspect : aspects) sum += aspect;
  const double wanted =
      std::max(width - (columns - 1) * gap, 1) * static_cast<double>(count) / (columns * sum);
  // From the end: the cheapest way to break what begins with each picture.
  std::vector<double> costs(count + 1, std::numeric_limits<double>::infinity());
  std::vector<SheetRow> choices(count);
  costs[count] = 0.0;
  for (size_t first = count; first-- > 0;) {
    double aspect = 0.0;
    for (size_t end = first + 1; end <= count; ++end) {
      aspect += aspects[end - 1];
      const double room = width - static_cast<double>(end - first - 1) * gap;
      const Line line = line_of(aspect, room, wanted, end == count);
      if (line.cost + costs[end] < costs[first]) {
        costs[first] = line.cost + costs[end];
        choices[first] = {first, end, line.height};
      }
      // Rows below half of the height that is wanted are never the best, and sheets may be long.
      if (line.height < 0.5 * wanted) break;
    }
  }
  std::vector<SheetRow> rows;
  for (size_t first = 0; first < count; first = rows.back().end) rows.push_back(choices[first]);
  return rows;
}

}  // namespace hyades::core
