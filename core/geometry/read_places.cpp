#include "core/geometry/read_places.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <utility>

#include "core/base/fp_mode.h"
#include "core/base/gunzip.h"
#include "core/geometry/chunks.h"
#include "core/geometry/ply_header.h"
#include "core/geometry/ply_source.h"

namespace hyades::core {
namespace {

/// What a property means: its place in a row of floats.
enum Slot : size_t { kX, kY, kZ, kScale, kSx, kSy, kSz, kQx, kQy, kQz, kQw, kMatrix, kSlots = 23 };

constexpr std::array<const char*, kSlots> kColumnNames{
    "x",   "y",   "z",   "scale", "scale_x", "scale_y", "scale_z", "qx",  "qy",  "qz",  "qw", "m00",
    "m01", "m02", "m03", "m10",   "m11",     "m12",     "m13",     "m20", "m21", "m22", "m23"};

using Row = std::array<float, kSlots>;

/// Which of them a file gives.
class Given {
 public:
  static Result<Given> of(const PlyElement& vertices) {
    Given given;
    for (const PlyProperty& p : vertices.properties) {
      if (p.is_list) return Error{"its vertices have lists, expected numbers only"};
      const auto name = std::find(kColumnNames.begin(), kColumnNames.end(), p.name);
      const auto slot = static_cast<size_t>(name - kColumnNames.begin());
      const bool first = name != kColumnNames.end() && !std::exchange(given.seen_[slot], true);
      given.slots_.push_back(first ? slot : size_t{kSlots});
    }
    const auto all = [&](size_t from, size_t to) {
      return std::all_of(given.seen_.begin() + static_cast<ptrdiff_t>(from),
                         given.seen_.begin() + static_cast<ptrdiff_t>(to),
                         [](bool seen) { return seen; });
    };
    const auto any = [&](size_t from, size_t to) {
      return std::any_of(given.seen_.begin() + static_cast<ptrdiff_t>(from),
                         given.seen_.begin() + static_cast<ptrdiff_t>(to),
                         [](bool seen) { return seen; });
    };
    given.matrix_ = all(kMatrix, kSlots);
    if (!given.matrix_ && any(kMatrix, kSlots)) {
      return Error{"its vertices have some of m00 to m23, expected all twelve"};
    }
    if (given.matrix_) return given;
    if (!all(kX, kScale)) return Error{"its vertices have no x, y and z, and no m00 to m23"};
    given.turned_ = all(kQx, kMatrix);
    if (!given.turned_ && any(kQx, kMatrix)) {
      return Error{"its vertices have some of qx, qy, qz and qw, expected all four"};
    }
    given.scaled_ = all(kSx, kQx);
    if (!given.scaled_ && any(kSx, kQx)) {
      return Error{"its vertices have some of scale_x, scale_y and scale_z, expected all three"};
    }
    return given;
  }

  /// Of each property; kSlots: of no interest.
  const std::vector<size_t>& slots() const { return slots_; }

  /// The place that a row says; null, or what is wrong.
  const char* place(const Row& row, PlaceMatrix& out) const {
    if (matrix_) {
      for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 4; ++c) {
          out[c][r] = row[kMatrix + static_cast<size_t>(4 * r + c)];
          if (!std::isfinite(out[c][r])) return "a number of its matrix is not finite";
        }
      }
      return nullptr;
    }
    Vec3d scale(1.0);
    if (seen_[kScale]) scale = Vec3d(static_cast<double>(row[kScale]));
    if (scaled_) scale *= Vec3d(row[kSx], row[kSy], row[kSz]);
    glm::dmat3 turn(1.0);
    if (turned_) {
      glm::dvec4 q(row[kQx], row[kQy], row[kQz], row[kQw]);
      const double length2 = glm::dot(q, q);
      if (!(length2 > 0.0) || !std::isfinite(length2)) return "its rotation has no direction";
      q /= std::sqrt(length2);
      turn = rotation(q);
    }
    for (int c = 0; c < 3; ++c) out[c] = Vec3(turn[c] * scale[c]);
    out[3] = {row[kX], row[kY], row[kZ]};
    for (int c = 0; c < 4; ++c) {
      const Vec3& v = out[c];
      if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z)) {
        return c < 3 ? "its scale is not finite" : "its position is not finite";
      }
    }
    return nullptr;
  }

 private:
  static glm::dmat3 rotation(const glm::dvec4& q) {
    const double x = q.x;
    const double y = q.y;
    const double z = q.z;
    const double w = q.w;
    return {Vec3d(1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + z * w), 2.0 * (x * z - y * w)),
            Vec3d(2.0 * (x * y - z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + x * w)),
            Vec3d(2.0 * (x * z + y * w), 2.0 * (y * z - x * w), 1.0 - 2.0 * (x * x + y * y))};
  }

  std::vector<size_t> slots_;
  std::array<bool, kSlots> seen_{};
  bool matrix_ = false;
  bool turned_ = false;
  bool scaled_ = false;
};

Error at_row(size_t row, const std::string& what) {
  return Error{what}.in("vertex " + std::to_string(row));
}

template <bool Swap>
Status read_binary(PlyBinary<Swap> source, const PlyElement& e, const Given& given,
                   std::vector<PlaceMatrix>& places) {
  size_t stride = 0;
  for (const PlyProperty& p : e.properties) stride += size_of(p.type);
  if (e.count > source.left() / stride) return source.truncated();
  const char* data = source.at();
  std::atomic<size_t> first_bad{e.count};
  for_chunks(e.count, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      Row row{};
      const char* at = data + i * stride;
      for (size_t k = 0; k < e.properties.size(); ++k) {
        const PlyType type = e.properties[k].type;
        if (given.slots()[k] != kSlots) row[given.slots()[k]] = load_as<float, Swap>(type, at);
        at += size_of(type);
      }
      if (given.place(row, places[i]) == nullptr) continue;
      size_t known = first_bad.load();
      while (i < known && !first_bad.compare_exchange_weak(known, i)) {
      }
      return;
    }
  });
  if (first_bad == e.count) return {};
  // Once more, for what is wrong with it.
  Row row{};
  const char* at = data + first_bad * stride;
  for (size_t k = 0; k < e.properties.size(); ++k) {
    const PlyType type = e.properties[k].type;
    if (given.slots()[k] != kSlots) row[given.slots()[k]] = load_as<float, Swap>(type, at);
    at += size_of(type);
  }
  PlaceMatrix ignored;
  return at_row(first_bad, given.place(row, ignored));
}

Status read_text(PlyText source, const PlyElement& e, const Given& given,
                 std::vector<PlaceMatrix>& places) {
  for (size_t i = 0; i < e.count; ++i) {
    Row row{};
    for (size_t k = 0; k < e.properties.size(); ++k) {
      float value = 0.0F;
      if (!source.number(e.properties[k].type, value)) return at_row(i, source.truncated().message);
      if (given.slots()[k] != kSlots) row[given.slots()[k]] = value;
    }
    if (const char* wrong = given.place(row, places[i])) return at_row(i, wrong);
  }
  return {};
}

Result<std::shared_ptr<const std::vector<PlaceMatrix>>> read(std::span<const char> bytes,
                                                             size_t room) {
  const auto header = parse_ply_header(bytes);
  if (!header) return Error{"it is no PLY file of places: " + header.error().message};
  if (header->elements.empty() || header->elements[0].name != "vertex") {
    return Error{"expected the element 'vertex' first"};
  }
  const PlyElement& e = header->elements[0];
  const auto given = Given::of(e);
  if (!given) return given.error();
  const std::span<const char> data = bytes.subspan(header->size);
  const bool text = header->form == PlyHeader::Form::text;
  if (e.count == 0) return Error{"it has no places"};
  if (e.count > std::numeric_limits<int32_t>::max() ||
      e.count > (data.size() + 1) / e.least_row(text)) {
    return Error{"the file is too short for " + std::to_string(e.count) + " places"};
  }
  if (room > 0 && e.count > room / kBytesPerCopy) {
    return Error{std::to_string(e.count) + " copies take about " +
                 std::to_string(e.count * kBytesPerCopy >> 20) + " MB, but there are " +
                 std::to_string(room >> 20) + " MB only"};
  }
  auto places = std::make_shared<std::vector<PlaceMatrix>>(e.count);
  Status s;
  switch (header->form) {
    case PlyHeader::Form::text:
      s = read_text(PlyText(data, header->lines + 1), e, *given, *places);
      break;
    case PlyHeader::Form::little_endian:
      s = read_binary(PlyBinary<false>(data), e, *given, *places);
      break;
    case PlyHeader::Form::big_endian:
      s = read_binary(PlyBinary<true>(data), e, *given, *places);
      break;
  }
  if (!s) return s.error();
  return std::shared_ptr<const std::vector<PlaceMatrix>>(std::move(places));
}

}  // namespace

Result<std::shared_ptr<const std::vector<PlaceMatrix>>> read_places(AssetResolver& assets,
                                                                    const std::string& reference,
                                                                    size_t room) {
  const Result<Bytes> bytes = open_unpacked(assets, reference);
  if (!bytes) return bytes.error();
  const FpMode mode;
  auto places = read({bytes->chars(), bytes->size()}, room);
  if (!places) return places.error().in(reference);
  return places;
}

Bytes places_bytes(std::span<const PlaceMatrix> places) {
  static_assert(std::endian::native == std::endian::little);
  std::string header = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                       std::to_string(places.size()) + "\n";
  for (size_t i = kMatrix; i < kSlots; ++i)
    header += std::string("property float ") + kColumnNames[i] + "\n";
  header += "end_header\n";
  constexpr size_t kRow = 12 * sizeof(float);
  const size_t size = header.size() + places.size() * kRow;
  const std::shared_ptr<std::byte[]> out(new std::byte[size]);
  std::memcpy(out.get(), header.data(), header.size());
  for_chunks(places.size(), [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const glm::mat3x4 rows = glm::transpose(places[i]);
      std::memcpy(out.get() + header.size() + i * kRow, &rows[0][0], kRow);
    }
  });
  return {out, {out.get(), size}};
}

}  // namespace hyades::core
