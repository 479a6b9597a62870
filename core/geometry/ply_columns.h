#pragma once

#include <array>
#include <cstring>
#include <vector>

#include "core/geometry/ply_layout.h"
#include "core/geometry/ply_source.h"

namespace hyades::core {

/// Rows of one size in a binary file.
struct PlyRows {
  const char* data = nullptr;  ///< of row 0
  size_t begin = 0;
  size_t end = 0;
};

/// Where in the rows of an element without lists its properties lie.
class PlyColumns {
 public:
  PlyColumns(const PlyElement& element, const PlyLayout& layout) : defaults_(layout.defaults) {
    for (size_t k = 0; k < element.properties.size(); ++k) {
      const PlySlot slot = layout.slots[k];
      if (slot != kIgnored) columns_[slot] = {true, stride_, element.properties[k].type};
      stride_ += size_of(element.properties[k].type);
    }
  }

  size_t stride() const { return stride_; }  ///< bytes of a row

  /// Reads N numbers of each row into `out` (of row 0), one row after the other.
  template <bool Swap, size_t N>
  void read(const PlyRows& rows, const std::array<PlySlot, N>& slots, float* out) const {
    if (!Swap && are_neighbours(slots)) {
      const char* from = rows.data + columns_[slots[0]].offset;
      for (size_t i = rows.begin; i < rows.end; ++i) {
        std::memcpy(out + i * N, from + i * stride_, N * sizeof(float));
      }
      return;
    }
    for (size_t k = 0; k < N; ++k) {
      const Column& column = columns_[slots[k]];
      const bool color = slots[k] >= kRed && slots[k] <= kAlpha;
      for (size_t i = rows.begin; i < rows.end; ++i) {
        float value = defaults_[slots[k]];
        if (column.given) {
          value = load_as<float, Swap>(column.type, rows.data + i * stride_ + column.offset);
          if (color) value = ply_color(column.type, slots[k], value);
        }
        out[i * N + k] = value;
      }
    }
  }

 private:
  struct Column {
    bool given = false;
    size_t offset = 0;
    PlyType type = PlyType::float32;
  };

  /// Whether they are floats that lie one after the other.
  template <size_t N>
  bool are_neighbours(const std::array<PlySlot, N>& slots) const {
    for (size_t k = 0; k < N; ++k) {
      const Column& column = columns_[slots[k]];
      if (!column.given || column.type != PlyType::float32) return false;
      if (column.offset != columns_[slots[0]].offset + k * sizeof(float)) return false;
    }
    return true;
  }

  PlyRow defaults_;
  std::array<Column, kPlySlots> columns_;
  size_t stride_ = 0;
};

}  // namespace hyades::core
