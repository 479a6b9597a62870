#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace hyades::core {

enum class PlyType : uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// Bytes of one binary value.
size_t size_of(PlyType type);
bool is_integer(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;  ///< of the value, or of a list's items
  bool is_list = false;
  PlyType count_type = PlyType::uint8;  ///< of a list's length
};

struct PlyElement {
  std::string name;
  uint64_t count = 0;
  std::vector<PlyProperty> properties;

  bool has_lists() const;
  /// Least bytes of one row in the given form: lists empty; in text a digit and a space per value.
  size_t least_row(bool text) const;
};

/// The part of a PLY file (Turk 1994, "The PLY Polygon File Format") before its data.
struct PlyHeader {
  enum class Form { text, little_endian, big_endian };
  Form form = Form::text;
  std::vector<PlyElement> elements;
  size_t size = 0;   ///< bytes up to the data
  size_t lines = 0;  ///< lines up to the data
};

/// Errors name the line.
Result<PlyHeader> parse_ply_header(std::span<const char> bytes);

}  // namespace hyades::core
