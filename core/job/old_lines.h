#pragma once

#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "core/job/field_writer.h"
#include "core/job/kinds_of.h"

namespace hyades::core {

/// A line that descriptions of a kind have had since films are kept by the hash of their lines:
/// those stay as they are, in this order, however the keys are called and read today.
struct OldLine {
  const char* key;               ///< "step.*": all lines that begin so
  const char* absent = nullptr;  ///< its value where the description has no such key; none: no line
  const char* left_out = nullptr;  ///< a value for which there is no line
  const char* beside = nullptr;    ///< a key whose lines stand among its own
};

inline constexpr const char* kWhiteBits = "3f800000,3f800000,3f800000";
inline constexpr const char* kZeroBits = "00000000,00000000,00000000";
inline constexpr const char* kNoText = "0:";

/// Writes `lines` as `old` says. Keys that are newer follow, where they are not as in `defaults`:
/// that way films from before there was such a key stay good.
void write_in_old_order(FieldWriter& out, std::span<const OldLine> old,
                        const std::vector<FieldWriter::Line>& lines,
                        const std::function<std::vector<FieldWriter::Line>()>& defaults);

/// The lines that the list of keys of `desc` has.
template <class Desc>
std::vector<FieldWriter::Line> lines_of(FieldWriter& out, const Desc& desc) {
  return out.collect([&] { Desc::fields(desc, out); });
}

/// Writes `desc` below `noun`: its name and type, and then `lines(desc)`, those of its keys, as
/// `old` says.
template <class Desc, class Lines>
void write_desc(FieldWriter& out, std::string_view noun, const Desc& desc,
                std::span<const OldLine> old, const Lines& lines) {
  Desc plain;
  out.enter(noun);
  if constexpr (requires { desc.name; }) out.put("name", desc.name);
  if constexpr (requires { desc.kind; }) {
    using Kinds = KindsOf<decltype(desc.kind)>;
    out.put("type", Kinds::name(desc.kind));
    plain.kind = Kinds::make(desc.kind.index());
  }
  if constexpr (requires { desc.type; }) {
    out.put("type", desc.type);
    plain.type = desc.type;
  }
  if constexpr (requires { desc.shape; }) {
    out.put("shape", desc.shape);
    plain.shape = desc.shape;
  }
  write_in_old_order(out, old, lines(desc), [&] { return lines(plain); });
  out.leave();
}
template <class Desc>
void write_desc(FieldWriter& out, std::string_view noun, const Desc& desc,
                std::span<const OldLine> old) {
  write_desc(out, noun, desc, old, [&](const Desc& of) { return lines_of(out, of); });
}

}  // namespace hyades::core
