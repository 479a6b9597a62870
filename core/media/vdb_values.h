#pragma once

#include <cstddef>
#include <vector>

#include "core/media/vdb_cursor.h"
#include "core/media/vdb_tree.h"

namespace hyades::core {

/// What a node of a .vdb stores of its values.
struct VdbValues {
  std::vector<float> components;
  bool active_alone = false;  ///< only those of active places, one after the other; else all
};

/// Reads the values of a node of `places` places, `active` of which are active.
VdbValues read_vdb_values(VdbCursor& cursor, const VdbEncoding& encoding, size_t places,
                          size_t active);

}  // namespace hyades::core
