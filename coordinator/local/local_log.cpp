#include "coordinator/local/local_log.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "core/film/film_codec.h"

namespace hyades::coordinator {
namespace {

/// The first byte of every record.
enum class Kind : uint8_t { cut = 1, unit = 2, finished = 3 };
constexpr uint8_t kVersion = 1;

// Numbers are little-endian, 32 bits.
void put(std::vector<std::byte>& out, uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8) {
    out.push_back(static_cast<std::byte>((value >> shift) & 0xFFU));
  }
}

uint32_t get(std::span<const std::byte> bytes, size_t at) {
  uint32_t value = 0;
  for (size_t i = 0; i < 4; ++i) value |= std::to_integer<uint32_t>(bytes[at + i]) << (8 * i);
  return value;
}

std::vector<std::byte> begin(Kind kind) {
  return {static_cast<std::byte>(kind), static_cast<std::byte>(kVersion)};
}

constexpr size_t kHead = 2;

class Reader {
 public:
  Reader(LogContents& contents, const core::PixelRect& region, const std::set<int32_t>& frames)
      : contents_(contents), region_(region), frames_(frames) {}

  core::Status read(std::span<const std::byte> record) {
    if (record.size() < kHead + 4) return core::Error{"a record is too short"};
    if (record[1] != static_cast<std::byte>(kVersion)) {
      return core::Error{"a record of another version"};
    }
    contents_.empty = false;
    switch (static_cast<Kind>(record[0])) {
      case Kind::cut:
        return read_cut(record.subspan(kHead));
      case Kind::unit:
        return read_unit(record.subspan(kHead));
      case Kind::finished:
        contents_.finished.insert(static_cast<int32_t>(get(record, kHead)));
        contents_.films.erase(static_cast<int32_t>(get(record, kHead)));
        return {};
    }
    return core::Error{"a record of an unknown kind"};
  }

 private:
  core::Status read_cut(std::span<const std::byte> bytes) {
    if (bytes.size() != 24) return core::Error{"the first record has a wrong length"};
    const auto number = [&](size_t i) { return static_cast<int32_t>(get(bytes, 4 * i)); };
    contents_.cut = {{number(0), number(1), number(2), number(3)}, number(4), get(bytes, 20)};
    if (contents_.cut.tile_size < 1) return core::Error{"an absurd tile size"};
    return {};
  }

  core::Status read_unit(std::span<const std::byte> bytes) {
    const auto frame = static_cast<int32_t>(get(bytes, 0));
    // A film after the end means that the frame was begun again, because its outputs were gone.
    contents_.finished.erase(frame);
    if (!frames_.contains(frame)) return {};
    auto film = core::decode_film(bytes.subspan(4));
    if (!film) return film.error();
    auto& whole = contents_.films[frame];
    if (!whole) whole = std::make_shared<core::Film>(film->layout(), region_);
    return whole->merge(*film);
  }

  LogContents& contents_;
  const core::PixelRect region_;
  const std::set<int32_t>& frames_;
};

}  // namespace

std::vector<std::byte> encode_cut(const CutRecord& cut) {
  std::vector<std::byte> out = begin(Kind::cut);
  for (const int32_t n :
       {cut.region.x0, cut.region.y0, cut.region.x1, cut.region.y1, cut.tile_size}) {
    put(out, static_cast<uint32_t>(n));
  }
  put(out, cut.samples);
  return out;
}

std::vector<std::byte> encode_unit(int32_t frame, const core::Film& film) {
  std::vector<std::byte> out = begin(Kind::unit);
  put(out, static_cast<uint32_t>(frame));
  const std::vector<std::byte> bytes = core::encode_film(film);
  out.insert(out.end(), bytes.begin(), bytes.end());
  return out;
}

std::vector<std::byte> encode_finished(int32_t frame) {
  std::vector<std::byte> out = begin(Kind::finished);
  put(out, static_cast<uint32_t>(frame));
  return out;
}

core::Result<LogContents> read_log(FilmLog& log, const core::PixelRect& region, uint32_t samples,
                                   const std::set<int32_t>& frames) {
  LogContents contents;
  Reader reader(contents, region, frames);
  auto report = log.replay([&](std::span<const std::byte> record) { return reader.read(record); });
  if (!report) return report.error();
  contents.problems = std::move(report->problems);
  if (contents.cut.tile_size == 0) return contents;
  if (contents.cut.region != region || contents.cut.samples != samples) {
    return core::Error{
        fmt::format("the kept films are of {}x{} pixels and {} samples, the job has {}x{} and {}",
                    contents.cut.region.width(), contents.cut.region.height(), contents.cut.samples,
                    region.width(), region.height(), samples)};
  }
  return contents;
}

std::vector<core::Unit> units_of(int32_t frame, const core::Film& film,
                                 const core::PixelRect& region, int32_t tile_size) {
  std::vector<core::Unit> units;
  for (const core::CoverageBox& box : film.coverage().boxes()) {
    for (int32_t y = box.tile.y0; y < box.tile.y1; y += tile_size) {
      for (int32_t x = box.tile.x0; x < box.tile.x1; x += tile_size) {
        const core::PixelRect tile =
            core::intersection(region, {x, y, x + tile_size, y + tile_size});
        units.push_back({frame, tile, box.batches});
      }
    }
  }
  std::sort(units.begin(), units.end(), [](const core::Unit& a, const core::Unit& b) {
    return std::tie(a.tile.y0, a.tile.x0, a.batches.first) <
           std::tie(b.tile.y0, b.tile.x0, b.batches.first);
  });
  return units;
}

core::Film cut_film(const core::Film& film, std::span<const core::Unit> units) {
  const core::PixelRect& tile = units.front().tile;
  core::Film part(film.layout(), tile);
  const auto width = static_cast<size_t>(tile.width());
  const auto stride = static_cast<size_t>(film.window().width());
  for (size_t c = 0; c < film.layout().channels.size(); ++c) {
    const core::Fixed128* from = film.plane(static_cast<int>(c)).data();
    core::Fixed128* into = part.mutable_plane(static_cast<int>(c)).data();
    for (int32_t y = tile.y0; y < tile.y1; ++y, into += width) {
      const size_t row = static_cast<size_t>(y - film.window().y0) * stride +
                         static_cast<size_t>(tile.x0 - film.window().x0);
      std::copy_n(from + row, width, into);
    }
  }
  for (const core::Unit& unit : units) part.mutable_coverage().add({tile, unit.batches});
  return part;
}

}  // namespace hyades::coordinator
