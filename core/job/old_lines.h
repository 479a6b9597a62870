#pragma once

#include <span>
#include <vector>

#include "core/job/field_writer.h"

namespace hyades::core {

/// A line that descriptions of a kind have had since films are kept by the hash of their lines:
/// those stay as they are, in this order, however the keys are called and read today.
struct OldLine {
  const char* key;               ///< "step.*": all lines that begin so
  const char* absent = nullptr;  ///< its value where the description has no such key; none: no line
  const char* left_out = nullptr;  ///< a value for which there is no line
};

inline constexpr const char* kWhiteBits = "3f800000,3f800000,3f800000";
inline constexpr const char* kNoText = "0:";

/// Writes `lines` as `old` says. Keys that are newer follow, where they are not as in `defaults`:
/// that way films from before there was such a key stay good.
void write_in_old_order(FieldWriter& out, std::span<const OldLine> old,
                        const std::vector<FieldWriter::Line>& lines,
                        const std::vector<FieldWriter::Line>& defaults);

}  // namespace hyades::core
