#include "core/geometry/obj_parser.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "core/base/parallel.h"
#include "core/geometry/mesh_source.h"
#include "core/geometry/text_scanner.h"

namespace hyades::core {
namespace {

constexpr size_t kChunkBytes = size_t{1} << 18;

/// How many elements of each kind lie before some place in the file.
struct ObjCounts {
  size_t lines = 0;
  size_t positions = 0;
  size_t uvs = 0;
  size_t normals = 0;

  ObjCounts operator+(const ObjCounts& o) const {
    return {lines + o.lines, positions + o.positions, uvs + o.uvs, normals + o.normals};
  }
};

/// Whether the line that ends with the line feed at `end` goes on in the next.
bool is_continued(const char* begin, const char* end) {
  if (end > begin && end[-1] == '\r') --end;
  return end > begin && end[-1] == '\\';
}

/// The end of the logical line that starts at `at`: a line feed or `end`.
const char* line_end(const char* at, const char* end, size_t& lines) {
  const char* from = at;
  while (from < end) {
    const auto* feed =
        static_cast<const char*>(std::memchr(from, '\n', static_cast<size_t>(end - from)));
    if (feed == nullptr) return end;
    ++lines;
    if (!is_continued(at, feed)) return feed;
    from = feed + 1;
  }
  return end;
}

enum class Keyword { other, position, uv, normal, face, material, library };

Keyword keyword_at(const char*& at, const char* end) {
  while (at < end && (*at == ' ' || *at == '\t')) ++at;
  const auto blank = [&](size_t i) { return at + i >= end || is_space(at[i]); };
  if (at >= end) return Keyword::other;
  if (*at == 'f' && blank(1)) return at += 1, Keyword::face;
  const auto word = [&](std::string_view text) {
    return std::string_view(at, static_cast<size_t>(end - at)).starts_with(text) &&
           blank(text.size());
  };
  if (word("usemtl")) return at += 6, Keyword::material;
  if (word("mtllib")) return at += 6, Keyword::library;
  if (*at != 'v') return Keyword::other;
  if (blank(1)) return at += 1, Keyword::position;
  if (blank(2) && at[1] == 't') return at += 2, Keyword::uv;
  if (blank(2) && at[1] == 'n') return at += 2, Keyword::normal;
  return Keyword::other;
}

/// A run of whole lines.
class ObjChunk {
 public:
  ObjChunk(const char* begin, const char* end) : begin_(begin), end_(end) {}

  void count() {
    for (const char* at = begin_; at < end_; ++at) {
      const char* line = at;
      at = line_end(at, end_, counts_.lines);
      switch (keyword_at(line, at)) {
        case Keyword::position:
          ++counts_.positions;
          break;
        case Keyword::uv:
          ++counts_.uvs;
          break;
        case Keyword::normal:
          ++counts_.normals;
          break;
        default:
          break;
      }
    }
  }
  const ObjCounts& counts() const { return counts_; }

  /// Parses, given what lies before this chunk and what the whole file holds.
  void parse(const ObjCounts& before, const ObjCounts& total) {
    now_ = before;
    total_ = total;
    data_.positions.reserve(counts_.positions);
    data_.uvs.reserve(counts_.uvs);
    data_.normals.reserve(counts_.normals);
    for (const char* at = begin_; at < end_; ++at) {
      const char* line = at;
      size_t lines = 0;
      at = line_end(at, end_, lines);
      if (const char* wrong = parse_line(line, at)) {
        error_ = Error{wrong}.in("line " + std::to_string(now_.lines + 1));
        return;
      }
      now_.lines += lines;
    }
  }
  const std::optional<Error>& error() const { return error_; }
  ObjData& data() { return data_; }

 private:
  /// Null, or what is wrong.
  const char* parse_line(const char* at, const char* end) {
    switch (keyword_at(at, end)) {
      case Keyword::position: {
        ++now_.positions;
        Vec3& p = data_.positions.emplace_back(0.0F);
        return parse_floats(at, end, &p.x, 3, 3) ? nullptr : "expected 'v x y z', finite numbers";
      }
      case Keyword::normal: {
        ++now_.normals;
        Vec3& n = data_.normals.emplace_back(0.0F);
        return parse_floats(at, end, &n.x, 3, 3) ? nullptr : "expected 'vn x y z', finite numbers";
      }
      case Keyword::uv: {
        ++now_.uvs;
        Vec2& t = data_.uvs.emplace_back(0.0F);
        return parse_floats(at, end, &t.x, 1, 2) ? nullptr : "expected 'vt u v', finite numbers";
      }
      case Keyword::face:
        return parse_face(at, end);
      case Keyword::material:
        data_.materials.push_back({data_.sizes.size(), rest_of_line(at, end)});
        return nullptr;
      case Keyword::library:
        data_.libraries.push_back(rest_of_line(at, end));
        return nullptr;
      case Keyword::other:
        return nullptr;
    }
    return nullptr;
  }

  static void skip_blanks(const char*& at, const char* end) {
    while (at < end && (is_space(*at) || (*at == '\\' && is_line_break(at + 1, end)))) ++at;
  }

  /// Without blanks around it; there may be some within.
  static std::string rest_of_line(const char* at, const char* end) {
    while (at < end && is_space(*at)) ++at;
    while (at < end && is_space(end[-1])) --end;
    return {at, end};
  }

  static bool is_line_break(const char* at, const char* end) {
    return at < end && (*at == '\n' || *at == '\r');
  }

  /// Reads up to `most` finite numbers, at least `least` of them.
  static bool parse_floats(const char* at, const char* end, float* out, int least, int most) {
    for (int i = 0; i < most; ++i) {
      skip_blanks(at, end);
      if (i >= least && (at == end || *at == '#')) return true;
      at = scan_float(at, end, out[i]);
      if (at == nullptr || (at < end && !is_space(*at)) || !std::isfinite(out[i])) return false;
    }
    return true;
  }

  const char* parse_face(const char* at, const char* end) {
    uint32_t size = 0;
    while (true) {
      skip_blanks(at, end);
      if (at == end || *at == '#') break;
      ObjCorner corner;
      if (const char* wrong = parse_corner(at, end, corner)) return wrong;
      data_.corners.push_back(corner);
      if (++size > kMaxCorners) return "a face has more than 16384 corners";
    }
    if (size < 3) return "a face needs at least three corners";
    data_.sizes.push_back(size);
    return nullptr;
  }

  /// v, v/vt, v//vn or v/vt/vn.
  const char* parse_corner(const char*& at, const char* end, ObjCorner& corner) const {
    if (const char* wrong = parse_index(at, end, now_.positions, total_.positions, corner.v)) {
      return wrong;
    }
    if (at < end && *at == '/') {
      ++at;
      if (at < end && *at != '/') {
        if (const char* wrong = parse_index(at, end, now_.uvs, total_.uvs, corner.vt)) {
          return wrong;
        }
      }
      if (at < end && *at == '/') {
        ++at;
        if (const char* wrong = parse_index(at, end, now_.normals, total_.normals, corner.vn)) {
          return wrong;
        }
      }
    }
    return at == end || is_space(*at) ? nullptr : "expected corners like 1, 1/2, 1//3 or 1/2/3";
  }

  /// Indices count from 1, or backwards from the last element read so far.
  static const char* parse_index(const char*& at, const char* end, size_t so_far, size_t total,
                                 int32_t& out) {
    int64_t index = 0;
    const char* after = scan_integer(at, end, index);
    if (after == nullptr) return "expected corners like 1, 1/2, 1//3 or 1/2/3";
    if (index == 0) return "an index is 0; they count from 1";
    const int64_t place = index > 0 ? index - 1 : static_cast<int64_t>(so_far) + index;
    if (place < 0 || place >= static_cast<int64_t>(total)) return "an index is out of range";
    out = static_cast<int32_t>(place);
    at = after;
    return nullptr;
  }

  const char* begin_;
  const char* end_;
  ObjCounts counts_;
  ObjCounts now_;
  ObjCounts total_;
  ObjData data_;
  std::optional<Error> error_;
};

/// Cuts the file into chunks at the ends of logical lines.
std::vector<ObjChunk> cut(std::span<const char> bytes) {
  std::vector<ObjChunk> chunks;
  const char* end = bytes.data() + bytes.size();
  for (const char* at = bytes.data(); at < end;) {
    const char* to = end;
    if (static_cast<size_t>(end - at) > kChunkBytes) {
      // From the start of a physical line on, so that a backslash before it is seen.
      size_t ignored = 0;
      to = line_end(at + kChunkBytes, end, ignored);
      if (to < end) ++to;
    }
    chunks.emplace_back(at, to);
    at = to;
  }
  return chunks;
}

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
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
  ObjData all;
  all.positions.reserve(total.positions + 1);
  all.uvs.reserve(total.uvs);
  all.normals.reserve(total.normals);
  for (ObjChunk& c : chunks) {
    if (c.error()) return *c.error();
    append(all.positions, c.data().positions);
    append(all.uvs, c.data().uvs);
    append(all.normals, c.data().normals);
    append(all.corners, c.data().corners);
    append(all.libraries, c.data().libraries);
    for (ObjMaterial& material : c.data().materials) {
      material.first += all.sizes.size();
      all.materials.push_back(std::move(material));
    }
    append(all.sizes, c.data().sizes);
    c.data() = {};
  }
  return all;
}

}  // namespace hyades::core
