#include "core/film/coverage_cut.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace hyades::core {
namespace {

/// Columns [x0, x1) that hold the same batches: runs[begin, end) of their slab.
struct Column {
  int32_t x0 = 0;
  int32_t x1 = 0;
  size_t begin = 0;
  size_t end = 0;
  friend bool operator==(const Column&, const Column&) = default;
};

/// Rows [y0, y1) with the same content.
struct Slab {
  int32_t y0 = 0;
  int32_t y1 = 0;
  std::vector<Column> columns;
  std::vector<BatchRange> runs;

  bool same_content(const Slab& other) const {
    return columns == other.columns && runs == other.runs;
  }

  /// Adds a column on the right, or widens the last one if that holds the same.
  void append(const Column& column) {
    const auto at = [this](size_t i) { return runs.begin() + static_cast<ptrdiff_t>(i); };
    if (!columns.empty() && columns.back().x1 == column.x0 &&
        std::equal(at(columns.back().begin), at(columns.back().end), at(column.begin),
                   at(column.end))) {
      columns.back().x1 = column.x1;
      runs.resize(column.begin);
    } else {
      columns.push_back(column);
    }
  }
};

/// Sorted, each once.
void sort_unique(std::vector<int32_t>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

class Cutter {
 public:
  explicit Cutter(uint64_t max_pieces) : left_(max_pieces) {}

  /// Cuts the boxes that cross one run of rows at all their left and right sides. Returns false on
  /// overlap, or when there are too many pieces.
  bool cut_columns(std::vector<CoverageBox> crossing, Slab& slab) {
    std::vector<int32_t> sides;
    sides.reserve(2 * crossing.size());
    for (const CoverageBox& box : crossing) {
      sides.push_back(box.tile.x0);
      sides.push_back(box.tile.x1);
    }
    sort_unique(sides);
    std::sort(crossing.begin(), crossing.end(),
              [](const CoverageBox& a, const CoverageBox& b) { return a.tile.x0 < b.tile.x0; });

    std::vector<std::pair<BatchRange, int32_t>> active;  // runs and where they stop
    size_t next = 0;
    for (size_t i = 0; i + 1 < sides.size(); ++i) {
      const int32_t x0 = sides[i];
      std::erase_if(active, [x0](const auto& run) { return run.second <= x0; });
      for (; next < crossing.size() && crossing[next].tile.x0 == x0; ++next) {
        active.emplace_back(crossing[next].batches, crossing[next].tile.x1);
      }
      if (active.empty()) continue;
      if (active.size() > left_) return false;
      left_ -= active.size();
      std::sort(active.begin(), active.end(),
                [](const auto& a, const auto& b) { return a.first.first < b.first.first; });

      const size_t begin = slab.runs.size();
      for (const auto& [run, right] : active) {
        const bool touches = slab.runs.size() > begin && slab.runs.back().end() >= run.first;
        if (touches && slab.runs.back().end() > run.first) return false;
        if (touches) {
          slab.runs.back().count += run.count;
        } else {
          slab.runs.push_back(run);
        }
      }
      slab.append({x0, sides[i + 1], begin, slab.runs.size()});
    }
    return true;
  }

 private:
  uint64_t left_;
};

}  // namespace

std::optional<std::vector<CoverageBox>> cut_and_join(const std::vector<CoverageBox>& boxes,
                                                     uint64_t max_pieces) {
  std::vector<int32_t> cuts;
  cuts.reserve(2 * boxes.size());
  for (const CoverageBox& box : boxes) {
    if (box.tile.empty() || box.batches.count == 0) return std::nullopt;
    cuts.push_back(box.tile.y0);
    cuts.push_back(box.tile.y1);
  }
  sort_unique(cuts);
  std::vector<CoverageBox> by_top = boxes;
  std::sort(by_top.begin(), by_top.end(),
            [](const CoverageBox& a, const CoverageBox& b) { return a.tile.y0 < b.tile.y0; });

  Cutter cutter(max_pieces);
  std::vector<Slab> slabs;
  std::vector<CoverageBox> crossing;
  size_t next = 0;
  for (size_t i = 0; i + 1 < cuts.size(); ++i) {
    const int32_t y0 = cuts[i];
    std::erase_if(crossing, [y0](const CoverageBox& box) { return box.tile.y1 <= y0; });
    for (; next < by_top.size() && by_top[next].tile.y0 == y0; ++next) {
      crossing.push_back(by_top[next]);
    }
    if (crossing.empty()) continue;
    Slab slab{y0, cuts[i + 1], {}, {}};
    if (!cutter.cut_columns(crossing, slab)) return std::nullopt;
    if (!slabs.empty() && slabs.back().y1 == y0 && slabs.back().same_content(slab)) {
      slabs.back().y1 = slab.y1;
    } else {
      slabs.push_back(std::move(slab));
    }
  }

  std::vector<CoverageBox> result;
  for (const Slab& slab : slabs) {
    for (const Column& column : slab.columns) {
      for (size_t run = column.begin; run < column.end; ++run) {
        result.push_back({{column.x0, slab.y0, column.x1, slab.y1}, slab.runs[run]});
      }
    }
  }
  return result;
}

}  // namespace hyades::core
