#include "core/geometry/read_mesh.h"

#include <algorithm>
#include <span>
#include <string_view>

#include "core/base/fp_mode.h"
#include "core/base/gunzip.h"
#include "core/geometry/mesh_source.h"

namespace hyades::core {
namespace {

/// Some editors begin a text with it; it is no part of any format.
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

bool is_ply(std::string_view text) {
  return text.starts_with("ply\n") || text.starts_with("ply\r\n") || text.starts_with("ply ");
}

/// Text holds no zero bytes; formats that are not text nearly always do within a page.
bool is_text(std::string_view text) {
  return text.substr(0, 4096).find('\0') == std::string_view::npos;
}

/// A mesh file in memory, without a byte order mark.
struct MeshText {
  Bytes bytes;
  std::span<const char> chars;
  enum class Format { ply, obj, unknown } format = Format::unknown;
};

Result<MeshText> open_mesh(AssetResolver& assets, const std::string& reference) {
  const Result<Bytes> bytes = open_unpacked(assets, reference);
  if (!bytes) return bytes.error();
  MeshText text;
  text.bytes = *bytes;
  text.chars = {bytes->chars(), bytes->size()};
  if (std::string_view(text.chars.data(), text.chars.size()).starts_with(kByteOrderMark)) {
    text.chars = text.chars.subspan(kByteOrderMark.size());
  }
  const std::string_view view(text.chars.data(), text.chars.size());
  if (is_ply(view)) {
    text.format = MeshText::Format::ply;
  } else if (is_text(view)) {
    text.format = MeshText::Format::obj;
  }
  return text;
}

}  // namespace

Result<std::shared_ptr<TriangleMesh>> read_mesh(AssetResolver& assets,
                                                const std::string& reference) {
  const auto text = open_mesh(assets, reference);
  if (!text) return text.error();
  const FpMode mode;
  using Format = MeshText::Format;
  Result<std::shared_ptr<TriangleMesh>> mesh = text->format == Format::ply   ? read_ply(text->chars)
                                               : text->format == Format::obj ? read_obj(text->chars)
                                                                             : Error{kNoMesh};
  if (!mesh) return mesh.error().in(reference);
  (*mesh)->name = reference;
  return mesh;
}

Result<MeshParts> read_mesh_parts(AssetResolver& assets, const std::string& reference) {
  const auto text = open_mesh(assets, reference);
  if (!text) return text.error();
  if (text->format != MeshText::Format::obj) {
    auto whole = read_mesh(assets, reference);
    if (!whole) return whole.error();
    return MeshParts{{{kNoMaterial, *whole}}, {}};
  }
  const FpMode mode;
  auto parts = read_obj_parts(text->chars);
  if (!parts) return parts.error().in(reference);
  return parts;
}

}  // namespace hyades::core
