#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "core/geometry/obj_parser.h"

namespace hyades::core {

/// How many elements of each kind lie before some place in an OBJ file.
struct ObjCounts {
  size_t lines = 0;
  size_t positions = 0;
  size_t uvs = 0;
  size_t normals = 0;

  ObjCounts operator+(const ObjCounts& o) const {
    return {lines + o.lines, positions + o.positions, uvs + o.uvs, normals + o.normals};
  }
};

/// The end of the logical line that starts at `at`: a line feed that no backslash stands before, or
/// `end`. `lines` grows by the physical lines that end.
const char* obj_line_end(const char* at, const char* end, size_t& lines);

/// A run of whole lines of an OBJ file, which one thread parses.
class ObjChunk {
 public:
  ObjChunk(const char* begin, const char* end) : begin_(begin), end_(end) {}

  /// The first round.
  void count();
  const ObjCounts& counts() const { return counts_; }

  /// The second one, given what lies before this chunk and what the whole file holds. It stops at
  /// the first error, which names its line.
  void parse(const ObjCounts& before, const ObjCounts& total);
  const std::optional<Error>& error() const { return error_; }

  /// What the lines hold; colours as written, materials counted from the chunk's first face.
  ObjData& data() { return data_; }
  /// The largest channel of a colour, as written.
  float largest_color() const { return largest_color_; }

 private:
  // Null, or what is wrong.
  const char* parse_line(const char* at, const char* end);
  const char* parse_position(const char* at, const char* end);
  const char* parse_face(const char* at, const char* end);
  const char* parse_corner(const char*& at, const char* end, ObjCorner& corner);
  const char* parse_index(const char*& at, const char* end, size_t ObjCounts::*kind, int32_t& out);

  const char* begin_;
  const char* end_;
  ObjCounts counts_;
  ObjCounts now_;
  ObjCounts total_;
  ObjData data_;
  float largest_color_ = 0.0F;
  std::string out_of_range_;  ///< what is wrong, where an index is
  std::optional<Error> error_;
};

}  // namespace hyades::core
