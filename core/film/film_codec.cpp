#include "core/film/film_codec.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <string>
#include <utility>

#include "core/base/hash.h"
#include "core/film/byte_planes.h"
#include "core/film/id_codec.h"
#include "core/film/splat_codec.h"

namespace hyades::core {
namespace {

static_assert(std::endian::native == std::endian::little, "the format is little-endian");

constexpr uint32_t kMagic = 0x4D465948;  // "HYFM"
constexpr uint16_t kVersion = 3;         ///< of films with layers that older versions do not know
constexpr uint64_t kFreeBytes = uint64_t{64} << 20U;
constexpr uint64_t kMaxExpansion = 4096;
constexpr int32_t kMaxCoordinate = 1 << 24;
constexpr size_t kBoxBytes = 24;
constexpr uint64_t kBoxMemory =
    400;  ///< of a box of the coverage, while it is sorted and looked at
constexpr size_t kHeaderBytes = 28;

/// How a channel is stored.
enum class ChannelForm : uint8_t {
  constant = 0,  ///< one number follows, that of all pixels
  floats = 1,    ///< all are 32-bit floats (one batch): 4 byte planes; minima always so
  fixed = 2,     ///< 16 byte planes
};

uint16_t layer_bits(const LayerSet& layers) {
  return static_cast<uint16_t>((layers.depth ? 1 : 0) | (layers.albedo ? 2 : 0) |
                               (layers.normal ? 4 : 0) | (layers.splats ? 8 : 0));
}

LayerSet layers_of(uint16_t bits) {
  return {(bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0, (bits & 8) != 0};
}

Result<LayerSet> read_layers(ByteReader& in, uint16_t version) {
  const auto bits = in.number<uint16_t>();
  if (version == kVersion) {
    const std::span<const std::byte> text = in.take(bits);
    if (in.failed()) return Error{"it is truncated"};
    Result<LayerSet> layers =
        parse_layers({reinterpret_cast<const char*>(text.data()), text.size()});
    if (layers && film_version(*layers) != kVersion) return Error{"it has unknown layers"};
    return layers;
  }
  if (version == 0 || bits > 15 || film_version(layers_of(bits)) != version) {
    return Error{"it has unknown layers"};
  }
  return layers_of(bits);
}

bool float_of(const Fixed128& value, float& result) {
  result = static_cast<float>(to_double(value));
  return to_fixed(result) == value;
}

void append_channel(std::vector<std::byte>& out, std::span<const Fixed128> plane, MergeRule rule) {
  if (std::all_of(plane.begin(), plane.end(), [&](const Fixed128& v) { return v == plane[0]; })) {
    append_number(out, ChannelForm::constant);
    append_number(out, plane.empty() ? Fixed128{} : plane[0]);
    return;
  }
  std::vector<float> floats(plane.size());
  bool exact = true;
  for (size_t i = 0; i < plane.size() && exact; ++i) {
    if (rule == MergeRule::min) {
      floats[i] = std::bit_cast<float>(static_cast<uint32_t>(plane[i].low));
    } else {
      exact = float_of(plane[i], floats[i]);
    }
  }
  if (exact) {
    append_number(out, ChannelForm::floats);
    append_planes(out, std::as_bytes(std::span(floats)), sizeof(float));
  } else {
    append_number(out, ChannelForm::fixed);
    append_planes(out, std::as_bytes(plane), sizeof(Fixed128));
  }
}

/// Infinities and NaN would not be sums, nor would values beyond the range of Fixed128.
bool is_sum(float value) { return value > -0x1p63F && value < 0x1p63F; }

Status read_channel(ByteReader& in, std::span<Fixed128> plane, const FilmChannel& channel) {
  const Error damaged{"channel " + channel.name + " is damaged"};
  const bool minima = channel.rule == MergeRule::min;
  switch (in.number<ChannelForm>()) {
    case ChannelForm::constant: {
      const auto value = in.number<Fixed128>();
      if (in.failed()) return damaged;
      std::fill(plane.begin(), plane.end(), value);
      return {};
    }
    case ChannelForm::floats: {
      std::vector<float> floats(plane.size());
      const auto bytes = std::as_writable_bytes(std::span(floats));
      if (!read_planes(in, bytes, sizeof(float))) return damaged;
      for (size_t i = 0; i < plane.size(); ++i) {
        if (!minima && !is_sum(floats[i])) return damaged;
        plane[i] = minima ? Fixed128{std::bit_cast<uint32_t>(floats[i]), 0} : to_fixed(floats[i]);
      }
      return {};
    }
    case ChannelForm::fixed:
      if (minima || !read_planes(in, std::as_writable_bytes(plane), sizeof(Fixed128))) {
        return damaged;
      }
      return {};
  }
  return damaged;
}

/// What a film takes while it is read, at most; `splats`: pixels that have some. Ids and splats of
/// parts are looked at when their numbers are known.
uint64_t memory_to_read(const FilmLayout& layout, const PixelRect& window, uint64_t splats) {
  return film_memory(layout, window) + splat_memory(splats);
}

Result<PixelRect> read_window(ByteReader& in) {
  PixelRect window;
  for (int32_t* side : {&window.x0, &window.y0, &window.x1, &window.y1}) {
    *side = in.number<int32_t>();
    if (*side < -kMaxCoordinate || *side > kMaxCoordinate) return Error{"its window is absurd"};
  }
  if (window.x1 < window.x0 || window.y1 < window.y0) return Error{"its window is absurd"};
  return window;
}

Result<Coverage> read_coverage(ByteReader& in, const FilmLimits& limits, uint64_t left) {
  const auto count = in.number<uint32_t>();
  if (count > in.left() / kBoxBytes) return Error{"it is truncated"};
  if (count > limits.max_boxes || count * kBoxMemory > left) {
    return Error{fmt::format("it has {} boxes", count)};
  }
  std::vector<CoverageBox> boxes(count);
  for (CoverageBox& box : boxes) {
    for (int32_t* side : {&box.tile.x0, &box.tile.y0, &box.tile.x1, &box.tile.y1}) {
      *side = in.number<int32_t>();
    }
    box.batches.first = in.number<uint32_t>();
    box.batches.count = in.number<uint32_t>();
  }
  return Coverage::from_canonical(boxes);
}

/// What stands before the coverage.
struct Beginning {
  FilmLayout layout;
  PixelRect window;
  PixelRect region;     ///< of the splats
  uint32_t splats = 0;  ///< pixels that have some

  /// While the film is read, but for its coverage, ids and the splats of parts.
  uint64_t memory() const { return memory_to_read(layout, window, splats); }
};

Result<uint16_t> read_version(ByteReader& in) {
  if (in.number<uint32_t>() != kMagic) return Error{"these bytes are no film"};
  const auto version = in.number<uint16_t>();
  if (version > kVersion) {
    return Error{fmt::format("it has format version {}; this build knows {}", version, kVersion)};
  }
  return version;
}

Result<Beginning> read_beginning(ByteReader& in) {
  const Result<uint16_t> version = read_version(in);
  if (!version) return version.error();
  const Result<LayerSet> layers = read_layers(in, *version);
  if (!layers) return layers.error();
  Beginning begun;
  begun.layout = make_film_layout(*layers);
  const Result<PixelRect> window = read_window(in);
  if (!window) return window.error();
  begun.window = begun.region = *window;
  if (begun.layout.layers.splats) {
    const Result<PixelRect> whole = read_window(in);
    if (!whole) return whole.error();
    begun.region = *whole;
    begun.splats = in.number<uint32_t>();
    if (begun.splats > begun.region.area() || begun.region.area() > UINT32_MAX) {
      return Error{"it has more splats than pixels"};
    }
  }
  return begun;
}

Status check_whole(std::span<const std::byte> bytes) {
  if (bytes.size() < kHeaderBytes + sizeof(uint32_t)) return Error{"it is truncated"};
  const std::span<const std::byte> body = bytes.first(bytes.size() - sizeof(uint32_t));
  if (crc32c(body) != ByteReader(bytes.subspan(body.size())).number<uint32_t>()) {
    return Error{"its checksum does not match: it is damaged or truncated"};
  }
  return {};
}

Result<Film> decode(std::span<const std::byte> bytes, const FilmLimits& limits) {
  ByteReader first(bytes);
  if (const Result<uint16_t> version = read_version(first); !version) return version.error();
  if (const Status whole = check_whole(bytes); !whole) return whole.error();
  ByteReader in(bytes);
  Result<Beginning> begun = read_beginning(in);
  if (!begun) return begun.error();
  const PixelRect window = begun->window;
  const PixelRect region = begun->region;
  const uint32_t splats = begun->splats;
  const uint64_t memory = begun->memory();
  if (memory > limits.max_bytes) {
    return Error{fmt::format("it is {} x {} pixels and would take {} MB; the limit is {} MB",
                             window.width(), window.height(), memory >> 20U,
                             limits.max_bytes >> 20U)};
  }
  if (memory > kFreeBytes + kMaxExpansion * bytes.size()) {
    return Error{fmt::format("it claims {} x {} pixels, which {} bytes cannot hold", window.width(),
                             window.height(), bytes.size())};
  }
  uint64_t left = std::min(limits.max_bytes, kFreeBytes + kMaxExpansion * bytes.size()) - memory;
  Result<Coverage> coverage = read_coverage(in, limits, left);
  if (!coverage) return coverage.error().in("its coverage is damaged");

  Film film(std::move(begun->layout), window, region);
  film.mutable_coverage() = std::move(*coverage);
  for (size_t c = 0; c < film.layout().channels.size(); ++c) {
    const Status read =
        read_channel(in, film.mutable_plane(static_cast<int>(c)), film.layout().channels[c]);
    if (!read) return read.error();
  }
  if (film.layout().layers.splats) {
    const Status read = read_splats(in, splats, film.mutable_splats());
    if (!read) return read.error();
  }
  for (PartSplatLayer& part : film.mutable_part_splats()) {
    const auto count = in.number<uint32_t>();
    // What parts brought is a part of all.
    if (count > splats || splat_memory(count) > left) return Error{"its splats are damaged"};
    left -= splat_memory(count);
    if (const Status read = read_splats(in, count, part); !read) return read.error();
  }
  for (const IdKind kind : {IdKind::object, IdKind::material}) {
    if (!film.layout().layers.ids[static_cast<size_t>(kind)]) continue;
    if (const Status read = read_ids(in, film.mutable_ids(kind), left); !read) return read.error();
  }
  const Status agrees = film.check();
  if (!agrees) return agrees.error();
  return film;
}

}  // namespace

Result<Coverage> decode_coverage(std::span<const std::byte> bytes) {
  ByteReader in(bytes);
  const Result<Beginning> begun = read_beginning(in);
  if (!begun) return begun.error();
  return read_coverage(in, {}, UINT64_MAX);
}

uint64_t memory_to_decode(std::span<const std::byte> bytes) {
  ByteReader in(bytes);
  const Result<Beginning> begun = read_beginning(in);
  if (!begun) return 0;
  if (begun->layout.layers.has_ids()) return UINT64_MAX;
  const auto boxes = in.number<uint32_t>();
  return begun->memory() + begun->layout.part_count() * splat_memory(begun->splats) +
         boxes * kBoxMemory;
}

std::vector<std::byte> encode_film(const Film& film) {
  std::vector<std::byte> out;
  append_number(out, kMagic);
  const LayerSet& layers = film.layout().layers;
  const bool splats = layers.splats;
  const auto version = static_cast<uint16_t>(film_version(layers));
  append_number(out, version);
  if (version == kVersion) {
    const std::string text = layers_text(layers);
    append_number(out, static_cast<uint16_t>(text.size()));
    for (const char c : text) append_number(out, c);
  } else {
    append_number(out, layer_bits(layers));
  }
  append_number(out, film.window());
  const auto touched = static_cast<uint32_t>(film.splats().count());
  if (splats) {
    append_number(out, film.splats().region());
    append_number(out, touched);
  }
  const std::vector<CoverageBox> boxes = film.coverage().canonical();
  append_number(out, static_cast<uint32_t>(boxes.size()));
  for (const CoverageBox& box : boxes) append_number(out, box);
  for (size_t c = 0; c < film.layout().channels.size(); ++c) {
    append_channel(out, film.plane(static_cast<int>(c)), film.layout().channels[c].rule);
  }
  if (splats) append_splats(out, film.splats());
  for (const PartSplatLayer& part : film.part_splats()) {
    append_number(out, static_cast<uint32_t>(part.count()));
    append_splats(out, part);
  }
  for (const IdKind kind : {IdKind::object, IdKind::material}) {
    if (layers.ids[static_cast<size_t>(kind)]) append_ids(out, film.ids(kind));
  }
  // Large and nearly empty films are padded, so that a reader can tell them from bytes that claim
  // more than they hold.
  const uint64_t memory = memory_to_read(film.layout(), film.window(), touched);
  if (memory > kFreeBytes) {
    const uint64_t least = (memory - kFreeBytes) / kMaxExpansion + 1;
    if (out.size() < least) out.resize(static_cast<size_t>(least));
  }
  append_number(out, crc32c(out));
  return out;
}

Result<Film> decode_film(std::span<const std::byte> bytes, const FilmLimits& limits) {
  Result<Film> film = decode(bytes, limits);
  if (!film) return film.error().in("film of " + std::to_string(bytes.size()) + " bytes");
  return film;
}

}  // namespace hyades::core
