#include "core/geometry/obj_chunk.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "core/geometry/mesh_source.h"
#include "core/geometry/text_scanner.h"

namespace hyades::core {
namespace {

/// Of a colour without an alpha, as large as the largest code.
constexpr float kWholeAlpha = 1e9F;

constexpr const char* kExpectedCorners = "expected corners like 1, 1/2, 1//3 or 1/2/3";

/// Whether the line that ends with the line feed at `end` goes on in the next.
bool is_continued(const char* begin, const char* end) {
  if (end > begin && end[-1] == '\r') --end;
  return end > begin && end[-1] == '\\';
}

enum class Keyword { other, position, uv, normal, face, material, library, no_area };

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
  if ((*at == 'l' || *at == 'p') && blank(1)) return Keyword::no_area;
  if (word("curv") || word("curv2") || word("surf")) return Keyword::no_area;
  if (*at != 'v') return Keyword::other;
  if (blank(1)) return at += 1, Keyword::position;
  if (blank(2) && at[1] == 't') return at += 2, Keyword::uv;
  if (blank(2) && at[1] == 'n') return at += 2, Keyword::normal;
  return Keyword::other;
}

bool is_line_break(const char* at, const char* end) {
  return at < end && (*at == '\n' || *at == '\r');
}

void skip_blanks(const char*& at, const char* end) {
  while (at < end && (is_space(*at) || (*at == '\\' && is_line_break(at + 1, end)))) ++at;
}

/// Without blanks around it; there may be some within.
std::string rest_of_line(const char* at, const char* end) {
  while (at < end && is_space(*at)) ++at;
  while (at < end && is_space(end[-1])) --end;
  return {at, end};
}

/// Reads up to `most` finite numbers, at least `least` of them; how many, 0 where there are not.
int parse_floats(const char* at, const char* end, float* out, int least, int most) {
  for (int i = 0; i < most; ++i) {
    skip_blanks(at, end);
    if (i >= least && (at == end || *at == '#')) return i;
    at = scan_float(at, end, out[i]);
    if (at == nullptr || (at < end && !is_space(*at)) || !std::isfinite(out[i])) return 0;
  }
  return most;
}

/// Most of a file is indices, most of them short and plain: those are read by hand.
const char* scan_index(const char* at, const char* end, int64_t& index) {
  constexpr ptrdiff_t kShort = 9;
  const char* const last = at + std::min(end - at, kShort);
  int64_t value = 0;
  const char* digit = at;
  for (; digit < last && *digit >= '0' && *digit <= '9'; ++digit)
    value = value * 10 + (*digit - '0');
  const bool done = digit > at && (digit == end || *digit < '0' || *digit > '9');
  if (!done) return scan_integer(at, end, index);
  index = value;
  return digit;
}

}  // namespace

const char* obj_line_end(const char* at, const char* end, size_t& lines) {
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

void ObjChunk::count() {
  for (const char* at = begin_; at < end_; ++at) {
    const char* line = at;
    at = obj_line_end(at, end_, counts_.lines);
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

void ObjChunk::parse(const ObjCounts& before, const ObjCounts& total) {
  now_ = before;
  total_ = total;
  data_.positions.reserve(counts_.positions);
  data_.uvs.reserve(counts_.uvs);
  data_.normals.reserve(counts_.normals);
  for (const char* at = begin_; at < end_; ++at) {
    const char* line = at;
    size_t lines = 0;
    at = obj_line_end(at, end_, lines);
    if (const char* wrong = parse_line(line, at)) {
      error_ = Error{wrong}.in("line " + std::to_string(now_.lines + 1));
      return;
    }
    now_.lines += lines;
  }
}

const char* ObjChunk::parse_line(const char* at, const char* end) {
  switch (keyword_at(at, end)) {
    case Keyword::position:
      ++now_.positions;
      return parse_position(at, end);
    case Keyword::normal: {
      ++now_.normals;
      Vec3& n = data_.normals.emplace_back(0.0F);
      return parse_floats(at, end, &n.x, 3, 3) > 0 ? nullptr
                                                   : "expected 'vn x y z', finite numbers";
    }
    case Keyword::uv: {
      ++now_.uvs;
      Vec2& t = data_.uvs.emplace_back(0.0F);
      return parse_floats(at, end, &t.x, 1, 2) > 0 ? nullptr : "expected 'vt u v', finite numbers";
    }
    case Keyword::face:
      return parse_face(at, end);
    case Keyword::material:
      data_.materials.push_back({data_.sizes.size(), rest_of_line(at, end)});
      return nullptr;
    case Keyword::library:
      data_.libraries.push_back(rest_of_line(at, end));
      return nullptr;
    case Keyword::no_area:
      ++data_.left_out;
      return nullptr;
    case Keyword::other:
      return nullptr;
  }
  return nullptr;
}

const char* ObjChunk::parse_position(const char* at, const char* end) {
  float numbers[7] = {};
  const int count = parse_floats(at, end, numbers, 3, 7);
  if (count == 0) return "expected 'v x y z' or 'v x y z red green blue', finite numbers";
  data_.positions.emplace_back(numbers[0], numbers[1], numbers[2]);
  if (count < 6 && data_.colors.empty()) return nullptr;
  data_.colors.resize(data_.positions.size(), kNoColor);
  if (count < 6) return nullptr;
  const Vec3 color(numbers[3], numbers[4], numbers[5]);
  data_.colors.back() = Vec4(color, count == 7 ? numbers[6] : kWholeAlpha);
  largest_color_ = std::max({largest_color_, color.x, color.y, color.z});
  return nullptr;
}

const char* ObjChunk::parse_face(const char* at, const char* end) {
  uint32_t size = 0;
  while (true) {
    skip_blanks(at, end);
    if (at == end || *at == '#') break;
    ObjCorner corner;
    if (const char* wrong = parse_corner(at, end, corner)) return wrong;
    data_.corners.push_back(corner);
    if (++size > kMaxCorners) return "a face has more than 16384 corners";
  }
  if (size == 0) return "a face without corners";
  if (size < 3) {
    data_.corners.resize(data_.corners.size() - size);
    ++data_.left_out;
    return nullptr;
  }
  data_.sizes.push_back(size);
  return nullptr;
}

/// v, v/vt, v//vn or v/vt/vn.
const char* ObjChunk::parse_corner(const char*& at, const char* end, ObjCorner& corner) {
  if (const char* wrong = parse_index(at, end, &ObjCounts::positions, corner.v)) {
    return wrong;
  }
  if (at < end && *at == '/') {
    ++at;
    if (at < end && *at != '/') {
      if (const char* wrong = parse_index(at, end, &ObjCounts::uvs, corner.vt)) {
        return wrong;
      }
    }
    if (at < end && *at == '/') {
      ++at;
      if (const char* wrong = parse_index(at, end, &ObjCounts::normals, corner.vn)) {
        return wrong;
      }
    }
  }
  return at == end || is_space(*at) ? nullptr : kExpectedCorners;
}

/// Indices count from 1, or backwards from the last element read so far.
const char* ObjChunk::parse_index(const char*& at, const char* end, size_t ObjCounts::*kind,
                                  int32_t& out) {
  int64_t index = 0;
  const char* after = scan_index(at, end, index);
  if (after == nullptr) return kExpectedCorners;
  if (index == 0) return "an index is 0; they count from 1";
  const auto so_far = static_cast<int64_t>(now_.*kind);
  const auto total = static_cast<int64_t>(total_.*kind);
  const int64_t place = index > 0 ? index - 1 : so_far + index;
  if (place < 0 || place >= total) {
    const char* what = kind == &ObjCounts::positions ? "v" : kind == &ObjCounts::uvs ? "vt" : "vn";
    out_of_range_ =
        fmt::format("index {} is out of range: the file has {} lines of '{}'{}", index, total, what,
                    index < 0 ? fmt::format(", {} of them before", so_far) : "");
    return out_of_range_.c_str();
  }
  out = static_cast<int32_t>(place);
  at = after;
  return nullptr;
}

}  // namespace hyades::core
