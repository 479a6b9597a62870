#include "core/geometry/read_mesh.h"

#include <algorithm>
#include <span>
#include <string_view>

#include "core/base/fp_mode.h"
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

}  // namespace

Result<std::shared_ptr<TriangleMesh>> read_mesh(AssetResolver& assets,
                                                const std::string& reference) {
  const Result<Bytes> bytes = assets.open(reference);
  if (!bytes) return bytes.error();
  const FpMode mode;
  std::span<const char> chars(bytes->chars(), bytes->size());
  if (std::string_view(chars.data(), chars.size()).starts_with(kByteOrderMark)) {
    chars = chars.subspan(kByteOrderMark.size());
  }
  const std::string_view text(chars.data(), chars.size());
  Result<std::shared_ptr<TriangleMesh>> mesh = is_ply(text)    ? read_ply(chars)
                                               : is_text(text) ? read_obj(chars)
                                                               : Error{kNoMesh};
  if (!mesh) return mesh.error().in(reference);
  (*mesh)->name = reference;
  return mesh;
}

}  // namespace hyades::core
