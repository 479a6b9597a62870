#include "core/geometry/obj_parser.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/base/color.h"
#include "core/base/parallel.h"
#include "core/geometry/obj_chunk.h"

namespace hyades::core {
namespace {

constexpr size_t kChunkBytes = size_t{1} << 18;

/// Cuts the file into chunks at the ends of logical lines.
std::vector<ObjChunk> cut(std::span<const char> bytes) {
  std::vector<ObjChunk> chunks;
  const char* end = bytes.data() + bytes.size();
  for (const char* at = bytes.data(); at < end;) {
    const char* to = end;
    if (static_cast<size_t>(end - at) > kChunkBytes) {
      // From the start of a physical line on, so that a backslash before it is seen.
      size_t ignored = 0;
      to = obj_line_end(at + kChunkBytes, end, ignored);
      if (to < end) ++to;
    }
    chunks.emplace_back(at, to);
    at = to;
  }
  return chunks;
}

/// A colour as written, whose codes are parts of `largest`, as a linear one.
Vec4 linear_color(const Vec4& code, float largest) {
  if (code == kNoColor) return code;
  const Vec4 part = glm::clamp(code / largest, 0.0F, 1.0F);
  return {srgb_decode(Rgb(part)), part.w};
}

template <class T>
void copy_to(const std::vector<T>& from, std::vector<T>& to, size_t place) {
  std::copy(from.begin(), from.end(), to.begin() + static_cast<ptrdiff_t>(place));
}

/// Puts together what the chunks hold, and empties them; `before`: what lies before each.
ObjData join(std::vector<ObjChunk>& chunks, const std::vector<ObjCounts>& before) {
  ObjData all;
  std::vector<size_t> corners{0};
  std::vector<size_t> faces{0};
  bool colored = false;
  float largest_color = 0.0F;
  for (ObjChunk& c : chunks) {
    for (ObjMaterial& material : c.data().materials) {
      material.first += faces.back();
      all.materials.push_back(std::move(material));
    }
    all.left_out += c.data().left_out;
    all.libraries.insert(all.libraries.end(), c.data().libraries.begin(), c.data().libraries.end());
    corners.push_back(corners.back() + c.data().corners.size());
    faces.push_back(faces.back() + c.data().sizes.size());
    colored = colored || !c.data().colors.empty();
    largest_color = std::max(largest_color, c.largest_color());
  }
  largest_color = largest_color > 1.0F ? 255.0F : 1.0F;
  all.positions.reserve(before.back().positions + 1);
  all.positions.resize(before.back().positions);
  all.uvs.resize(before.back().uvs);
  all.normals.resize(before.back().normals);
  all.corners.resize(corners.back());
  all.sizes.resize(faces.back());
  if (colored) all.colors.resize(all.positions.size(), kNoColor);
  (void)parallel_for(chunks.size(), 0, [&](size_t i) {
    ObjData& part = chunks[i].data();
    for (Vec4& color : part.colors) color = linear_color(color, largest_color);
    copy_to(part.positions, all.positions, before[i].positions);
    if (colored) copy_to(part.colors, all.colors, before[i].positions);
    copy_to(part.uvs, all.uvs, before[i].uvs);
    copy_to(part.normals, all.normals, before[i].normals);
    copy_to(part.corners, all.corners, corners[i]);
    copy_to(part.sizes, all.sizes, faces[i]);
    part = {};
  });
  return all;
}

}  // namespace

Result<ObjData> parse_obj(std::span<const char> bytes) {
  std::vector<ObjChunk> chunks = cut(bytes);
  (void)parallel_for(chunks.size(), 0, [&](size_t i) { chunks[i].count(); });
  std::vector<ObjCounts> before{{}};
  for (const ObjChunk& c : chunks) before.push_back(before.back() + c.counts());
  const ObjCounts total = before.back();
  constexpr size_t kMost = std::numeric_limits<int32_t>::max();
  if (std::max({total.positions, total.uvs, total.normals}) > kMost) {
    return Error{"it has more than 2^31 vertices"};
  }
  if (Status s =
          parallel_for(chunks.size(), 0, [&](size_t i) { chunks[i].parse(before[i], total); });
      !s) {
    return s.error();
  }
  size_t corners = 0;
  for (ObjChunk& c : chunks) {
    if (c.error()) return *c.error();
    corners += c.data().corners.size();
  }
  if (corners > std::numeric_limits<uint32_t>::max()) {
    return Error{"its faces have more than 2^32 corners"};
  }
  return join(chunks, before);
}

}  // namespace hyades::core
