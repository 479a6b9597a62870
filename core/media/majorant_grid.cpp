#include "core/media/majorant_grid.h"

#include <cassert>
#include <cstddef>

namespace hyades::core {

MajorantGrid::MajorantGrid(const DensityField& field, const Vec3i& cells, float slack)
    : bounds_(field.bounds()), cells_(cells), cell_size_(bounds_.size() / Vec3(cells)) {
  assert(cells.x > 0 && cells.y > 0 && cells.z > 0 && slack >= 1.0F);
  extents_.reserve(static_cast<size_t>(cells.x) * static_cast<size_t>(cells.y) *
                   static_cast<size_t>(cells.z));
  // A walk may believe to be in a cell when by rounding it is just outside.
  const Vec3 margin = 1e-5F * bounds_.size();
  for (int z = 0; z < cells.z; ++z) {
    for (int y = 0; y < cells.y; ++y) {
      for (int x = 0; x < cells.x; ++x) {
        const Vec3 lower = bounds_.lower + Vec3(x, y, z) * cell_size_;
        Extent extent = field.over({lower - margin, lower + cell_size_ + margin});
        extent.greatest *= slack;
        extents_.push_back(extent);
      }
    }
  }
}

Vec3i MajorantGrid::cells_for(const Bounds& bounds, int along_longest) {
  const Vec3 size = bounds.size();
  const float longest = max_component(size);
  Vec3i cells(1);
  for (int a = 0; a < 3; ++a) {
    const float share = longest > 0.0F ? size[a] / longest : 0.0F;
    cells[a] = std::max(1, static_cast<int>(std::ceil(share * static_cast<float>(along_longest))));
  }
  return cells;
}

}  // namespace hyades::core
