#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace hyades::coordinator {

/// The bytes of a file from `first` to `last`, both among them.
struct ByteRange {
  uint64_t first = 0;
  uint64_t last = 0;
};

/// What a header Range asks for.
enum class RangeAsked {
  whole,       ///< nothing, several ranges, or something that is none: the whole file is right
  part,        ///< `range` says which
  impossible,  ///< beyond the file's end
};
/// Reads the header Range (RFC 9110; empty: there is none) of a request for a file of `size` bytes.
RangeAsked read_range(std::string_view header, uint64_t size, ByteRange& range);

}  // namespace hyades::coordinator
