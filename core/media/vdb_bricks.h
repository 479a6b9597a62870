#pragma once

#include <cmath>
#include <cstdint>
#include <memory>

#include <fmt/format.h>

#include "core/base/result.h"
#include "core/media/read_vdb.h"
#include "core/media/vdb_tree.h"

namespace hyades::core {

/// The voxels of a tree as look-ups want them. Errors: nothing active, or spread over more than
/// can be indexed; a transform that nothing undoes.
template <class T>
Result<std::shared_ptr<const VdbGrid<T>>> bricks_of(const VdbTree<T>& tree, const Mat4& to_file) {
  if (tree.block_count() == 0 || tree.lower().x > tree.upper().x) {
    return Error{"has no active voxels"};
  }
  const Vec3i size = tree.upper() - tree.lower() + 1;
  // Bricks are indexed one by one, also where there is nothing.
  const double bricks = (size.x / 8.0 + 1) * (size.y / 8.0 + 1) * (size.z / 8.0 + 1);
  const double most = 0x1p24 + 4096.0 * static_cast<double>(tree.block_count());
  if (bricks > most || bricks * sizeof(int32_t) > 0.25 * static_cast<double>(kMostVdbBytes)) {
    return Error{
        fmt::format("spans {} x {} x {} voxels, more than can be read", size.x, size.y, size.z)};
  }
  if (!(std::abs(glm::determinant(to_file)) > 0.0F) || !std::isfinite(glm::determinant(to_file))) {
    return Error{"has a transform that flattens it, or is not finite"};
  }
  Vec3i last(0);
  const typename VdbTree<T>::Block* block = tree.block(last);
  const auto value = [&](const Vec3i& p) {
    if ((p >> 3) != (last >> 3)) block = tree.block(p);
    last = p;
    return block != nullptr ? block->values[VdbTree<T>::place(p)] : T(0.0F);
  };
  const auto blocks = [&](const auto& visit) {
    tree.visit_blocks([&](const Vec3i& origin) { visit(origin, origin + 7); });
  };
  return std::make_shared<const VdbGrid<T>>(
      VdbGrid<T>{BrickGrid<T>(tree.lower(), tree.upper(), value, blocks), to_file});
}

}  // namespace hyades::core
