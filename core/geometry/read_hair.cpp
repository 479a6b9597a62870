#include "core/geometry/read_hair.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/base/fp_mode.h"
#include "core/base/gunzip.h"

namespace hyades::core {
namespace {

static_assert(std::endian::native == std::endian::little, "the file's numbers are copied");

constexpr std::string_view kSignature = "HAIR";

/// Which arrays follow the header, in this order.
enum Arrays : uint32_t {
  kSegments = 1,      ///< uint16 per strand: its points less one
  kPoints = 2,        ///< 3 floats per point
  kThickness = 4,     ///< a float per point
  kTransparency = 8,  ///< a float per point
  kColors = 16,       ///< 3 floats per point
};

struct Header {
  std::array<char, 4> signature{'H', 'A', 'I', 'R'};
  uint32_t strands = 0;
  uint32_t points = 0;
  uint32_t arrays = 0;
  uint32_t segments = 0;  ///< of strands where there is no array of it; as what follows
  float thickness = 1.0F;
  float transparency = 0.0F;
  std::array<float, 3> color{1.0F, 1.0F, 1.0F};
  std::array<char, 88> information{};
};
static_assert(sizeof(Header) == 128);

/// About what a point takes while a scene is made: it, its piece and Embree's hierarchy.
constexpr size_t kBytesPerPoint = 256;

/// The numbers of the file, one array after the other.
class HairSource {
 public:
  explicit HairSource(std::span<const char> bytes) : bytes_(bytes) {}

  /// The next `count` of T; false where the file ends before.
  template <class T>
  bool take(size_t count, std::vector<T>& out) {
    if (count > bytes_.size() / sizeof(T)) return false;
    out.resize(count);
    if (count > 0) std::memcpy(out.data(), bytes_.data(), count * sizeof(T));
    bytes_ = bytes_.subspan(count * sizeof(T));
    return true;
  }

 private:
  std::span<const char> bytes_;
};

Error cut_short(const Header& header) {
  return Error{fmt::format("the file is too short for {} strands of {} points", header.strands,
                           header.points)};
}

Result<StrandList> read_strands(std::span<const char> bytes, size_t room) {
  Header header;
  if (bytes.size() < kSignature.size() ||
      std::string_view(bytes.data(), kSignature.size()) != kSignature) {
    return Error{"it is no file of strands; expected one that begins with HAIR"};
  }
  if (bytes.size() < sizeof(Header)) return Error{"the file ends within its header"};
  std::memcpy(&header, bytes.data(), sizeof(Header));
  HairSource source(bytes.subspan(sizeof(Header)));
  if ((header.arrays & kPoints) == 0) return Error{"it has no points"};
  if (header.strands > bytes.size() || header.points > bytes.size() / sizeof(Vec3)) {
    return cut_short(header);
  }
  if (room > 0 && header.points > room / kBytesPerPoint) {
    return Error{fmt::format("{} points of strands take about {} MB, but there are {} MB only",
                             header.points, size_t{header.points} * kBytesPerPoint >> 20U,
                             room >> 20U)};
  }
  StrandList list;
  std::vector<uint16_t> segments;
  if ((header.arrays & kSegments) != 0) {
    if (!source.take(header.strands, segments)) return cut_short(header);
    for (const uint16_t n : segments) list.sizes.push_back(uint32_t{n} + 1);
  } else {
    if (header.segments >= header.points) return cut_short(header);
    list.sizes.assign(header.strands, header.segments + 1);
  }
  size_t all = 0;
  for (const uint32_t size : list.sizes) all += size;
  if (all != header.points) {
    return Error{
        fmt::format("its strands have {} points in all, but it says {}", all, header.points)};
  }
  if (!source.take(header.points, list.points)) return cut_short(header);
  if ((header.arrays & kThickness) != 0) {
    if (!source.take(header.points, list.radii)) return cut_short(header);
  } else {
    list.radii.assign(header.points, header.thickness);
  }
  for (float& r : list.radii) r *= 0.5F;
  std::vector<float> transparency;
  if ((header.arrays & kTransparency) != 0 && !source.take(header.points, transparency)) {
    return cut_short(header);
  }
  if ((header.arrays & kColors) != 0) {
    if (!source.take(header.points, list.colors)) return cut_short(header);
  } else if (header.color != std::array<float, 3>{1.0F, 1.0F, 1.0F}) {
    list.colors.assign(header.points, {header.color[0], header.color[1], header.color[2]});
  }
  for (const Vec3& c : list.colors) {
    for (int k = 0; k < 3; ++k) {
      if (c[k] >= 0.0F && c[k] <= 1.0F) continue;
      return Error{fmt::format("one of its colours is {}, expected 0 to 1{}", c[k],
                               c[k] > 1.0F ? "; if they go from 0 to 255, divide by 255" : "")};
    }
  }
  return list;
}

template <class T>
void put(std::byte*& at, const std::vector<T>& values) {
  if (values.empty()) return;
  std::memcpy(at, values.data(), values.size() * sizeof(T));
  at += values.size() * sizeof(T);
}

}  // namespace

Result<std::shared_ptr<const CurveSet>> read_hair(AssetResolver& assets,
                                                  const std::string& reference, CurveBasis basis,
                                                  size_t room) {
  const Result<Bytes> bytes = open_unpacked(assets, reference);
  if (!bytes) return bytes.error();
  const FpMode mode;
  const auto list = read_strands({bytes->chars(), bytes->size()}, room);
  if (!list) return list.error().in(reference);
  auto set = make_curve_set(*list, basis);
  if (!set) return set.error().in(reference);
  (*set)->name = reference;
  return std::shared_ptr<const CurveSet>(std::move(*set));
}

Bytes hair_bytes(const StrandList& strands) {
  Header header;
  header.strands = static_cast<uint32_t>(strands.sizes.size());
  header.points = static_cast<uint32_t>(strands.points.size());
  header.arrays = kSegments | kPoints | kThickness | (strands.colors.empty() ? 0U : kColors);
  std::vector<uint16_t> segments;
  segments.reserve(strands.sizes.size());
  for (const uint32_t size : strands.sizes) segments.push_back(static_cast<uint16_t>(size - 1));
  std::vector<float> thickness = strands.radii;
  for (float& t : thickness) t *= 2.0F;
  const size_t size = sizeof(Header) + segments.size() * sizeof(uint16_t) +
                      strands.points.size() * (sizeof(Vec3) + sizeof(float)) +
                      strands.colors.size() * sizeof(Vec3);
  const std::shared_ptr<std::byte[]> out(new std::byte[size]);
  std::byte* at = out.get();
  std::memcpy(at, &header, sizeof(Header));
  at += sizeof(Header);
  put(at, segments);
  put(at, strands.points);
  put(at, thickness);
  put(at, strands.colors);
  return {out, {out.get(), size}};
}

}  // namespace hyades::core
