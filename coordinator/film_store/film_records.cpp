#include "coordinator/film_store/film_records.h"

#include <algorithm>
#include <optional>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "coordinator/scheduler/tile_grid.h"
#include "core/film/film_codec.h"

namespace hyades::coordinator {
namespace {

/// The first byte of every record.
enum class Kind : uint8_t {
  cut = 1,
  unit = 2,
  finished = 3,
  delivered = 4,
  begun_again = 5,
  tile_voided = 6,
  dispute = 7
};
constexpr uint8_t kVersion = 2;

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

void put(std::vector<std::byte>& out, const core::PixelRect& rect) {
  for (const int32_t n : {rect.x0, rect.y0, rect.x1, rect.y1}) put(out, static_cast<uint32_t>(n));
}

core::PixelRect get_rect(std::span<const std::byte> bytes, size_t at) {
  const auto number = [&](size_t i) { return static_cast<int32_t>(get(bytes, at + 4 * i)); };
  return {number(0), number(1), number(2), number(3)};
}

void put(std::vector<std::byte>& out, const FrameKey& key) {
  for (const uint8_t byte : key) out.push_back(static_cast<std::byte>(byte));
}

FrameKey get_key(std::span<const std::byte> bytes, size_t at) {
  FrameKey key{};
  for (size_t i = 0; i < key.size(); ++i) key[i] = std::to_integer<uint8_t>(bytes[at + i]);
  return key;
}

/// The ids of the tile that is the window of `into`, and their names.
void cut_ids(const core::IdLayer& ids, core::IdLayer& into) {
  const core::PixelRect& tile = into.window();
  std::vector<core::IdCount> counts;
  uint32_t pixel = 0;
  for (int32_t y = tile.y0; y < tile.y1; ++y) {
    for (int32_t x = tile.x0; x < tile.x1; ++x, ++pixel) {
      for (const core::IdCount& entry : ids.at(x, y)) {
        counts.push_back({pixel, entry.id, entry.count});
        const auto named = ids.names().find(entry.id);
        if (named != ids.names().end()) into.name(entry.id, named->second);
      }
    }
  }
  into.deposit(std::move(counts));
}

/// The part of a film within one tile, of which `units` are all that it holds.
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
  for (const core::IdKind kind : {core::IdKind::object, core::IdKind::material}) {
    if (film.layout().layers.ids[static_cast<size_t>(kind)])
      cut_ids(film.ids(kind), part.mutable_ids(kind));
  }
  for (const core::Unit& unit : units) part.mutable_coverage().add({tile, unit.batches});
  return part;
}

constexpr size_t kHead = 2;
constexpr size_t kFrameAndKey = 4 + sizeof(FrameKey);
constexpr size_t kDeliveredHead = kFrameAndKey + sizeof(Digest) + 4;  ///< before the class

/// The film's bytes in a record of kind delivered, of which the head has been read.
core::Result<std::span<const std::byte>> film_of_delivered(std::span<const std::byte> bytes) {
  if (bytes.size() < kDeliveredHead) return core::Error{"a delivered film's record is too short"};
  const uint32_t length = get(bytes, kDeliveredHead - 4);
  if (length > bytes.size() - kDeliveredHead) {
    return core::Error{"a delivered film's class is cut off"};
  }
  return bytes.subspan(kDeliveredHead + length);
}

class Reader {
 public:
  Reader(LogContents& contents, const LogFilter& filter, const FilmLog& log)
      : contents_(contents), filter_(filter), log_(log) {}

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
        return read_finished(record.subspan(kHead));
      case Kind::delivered:
        return read_delivered(record.subspan(kHead));
      case Kind::begun_again:
        contents_.finished.erase(static_cast<int32_t>(get(record, kHead)));
        forget(static_cast<int32_t>(get(record, kHead)));
        return {};
      case Kind::tile_voided:
        return read_tile_voided(record.subspan(kHead));
      case Kind::dispute:
        contents_.disputed = get(record, kHead) != 0;
        return {};
    }
    return core::Error{"a record of an unknown kind"};
  }

  /// The first frame that is wanted and whose films are of other pixels.
  std::optional<int32_t> other_pixels() const { return other_pixels_; }

  /// Whether a frame, wanted or not, has films and is not finished.
  bool has_unfinished() const { return !unfinished_.empty(); }

 private:
  core::Status read_cut(std::span<const std::byte> bytes) {
    if (bytes.size() != 24) return core::Error{"the record of the cut has a wrong length"};
    const CutRecord cut{get_rect(bytes, 0), static_cast<int32_t>(get(bytes, 16)), get(bytes, 20)};
    if (cut.tile_size < 1) return core::Error{"an absurd tile size"};
    contents_.cut = cut;
    other_regions_ = other_regions_ || cut.region != filter_.region;
    return {};
  }

  core::Status read_unit(std::span<const std::byte> bytes) {
    if (bytes.size() < kFrameAndKey) return core::Error{"a film's record is too short"};
    const auto frame = static_cast<int32_t>(get(bytes, 0));
    // A film after the end means that the frame was begun again, because its outputs were gone.
    contents_.finished.erase(frame);
    unfinished_.insert(frame);
    if (!is_wanted(frame) || !has_key(frame, get_key(bytes, 4))) return {};
    if (filter_.places) {
      const auto units = note_place(frame, bytes.subspan(kFrameAndKey));
      return units ? core::Status() : units.error();
    }
    auto film = core::decode_film(bytes.subspan(kFrameAndKey));
    if (!film) return film.error();
    const bool splats = film->layout().layers.splats;
    // Splats of tiles that are not wanted cannot be told from those of others.
    if (splats && contents_.cut.region != filter_.region) return {};
    auto& whole = contents_.films[frame];
    if (!whole) whole = blank_like(*film);
    return other_regions_ && !splats ? merge_tiles(*film, *whole) : whole->merge(*film);
  }

  core::Status read_delivered(std::span<const std::byte> bytes) {
    const auto packed = film_of_delivered(bytes);
    if (!packed) return packed.error();
    const auto frame = static_cast<int32_t>(get(bytes, 0));
    const Digest digest = get_key(bytes, kFrameAndKey);
    std::string worker_class(bytes.size() - kDeliveredHead - packed->size(), '\0');
    for (size_t i = 0; i < worker_class.size(); ++i) {
      worker_class[i] = std::to_integer<char>(bytes[kDeliveredHead + i]);
    }
    contents_.finished.erase(frame);
    unfinished_.insert(frame);
    if (!is_wanted(frame) || !has_key(frame, get_key(bytes, 4))) return {};
    if (filter_.places) {
      const auto units = note_place(frame, *packed);
      if (!units) return units.error();
      note_units(*units, digest, worker_class);
      return {};
    }
    auto film = core::decode_film(*packed);
    if (!film) return film.error();
    auto& whole = contents_.films[frame];
    if (!whole) whole = blank_like(*film);
    if (core::Status merged = whole->merge(*film); !merged) return merged;
    if (contents_.cut.tile_size < 1) return {};
    note_units(units_of(frame, film->coverage(), filter_.region, contents_.cut.tile_size), digest,
               worker_class);
    return {};
  }

  void note_units(const std::vector<core::Unit>& units, const Digest& digest,
                  const std::string& worker_class) {
    for (const core::Unit& unit : units) {
      contents_.units[unit.frame].push_back(
          {unit, units.size() == 1 ? digest : Digest{}, worker_class});
    }
  }

  /// Takes where the film stands that is being read, if it could be merged with those before;
  /// returns its units.
  core::Result<std::vector<core::Unit>> note_place(int32_t frame,
                                                   std::span<const std::byte> packed) {
    if (contents_.cut.tile_size < 1 || contents_.cut.region != filter_.region) {
      return core::Error{"a film of another region"};
    }
    const auto coverage = core::decode_coverage(packed);
    if (!coverage) return coverage.error();
    auto units = units_of(frame, *coverage, filter_.region, contents_.cut.tile_size);
    Tiles& tiles = tiles_[frame];
    for (const core::Unit& unit : units) {
      if (tiles[{unit.tile.x0, unit.tile.y0}].overlap({unit.tile, unit.batches})) {
        return core::Error{"a film overlaps those before"};
      }
    }
    for (const core::Unit& unit : units) {
      tiles[{unit.tile.x0, unit.tile.y0}].add({unit.tile, unit.batches});
    }
    contents_.places[frame].push_back(log_.place());
    return units;
  }

  /// The frame's films count no more.
  void forget(int32_t frame) {
    contents_.films.erase(frame);
    contents_.units.erase(frame);
    contents_.places.erase(frame);
    tiles_.erase(frame);
  }

  core::Status read_tile_voided(std::span<const std::byte> bytes) {
    if (bytes.size() != 4 + 16) return core::Error{"a record has a wrong length"};
    const auto frame = static_cast<int32_t>(get(bytes, 0));
    const core::PixelRect tile = get_rect(bytes, 4);
    const auto film = contents_.films.find(frame);
    const auto places = contents_.places.find(frame);
    if (film != contents_.films.end()) film->second->erase(tile);
    if (places != contents_.places.end()) {
      places->second.push_back(log_.place());
      Tiles& left = tiles_[frame];
      left.erase({tile.x0, tile.y0});
      if (left.empty()) contents_.places.erase(places);
    }
    const auto units = contents_.units.find(frame);
    if (units != contents_.units.end()) {
      std::erase_if(units->second, [&](const AcceptedUnit& u) { return u.unit.tile == tile; });
      if (units->second.empty()) contents_.units.erase(units);
    }
    if (film != contents_.films.end() && film->second->coverage().volume() == 0) {
      contents_.films.erase(film);
    }
    return {};
  }

  core::Status read_finished(std::span<const std::byte> bytes) {
    if (bytes.size() != kFrameAndKey + 16) return core::Error{"a record has a wrong length"};
    const auto frame = static_cast<int32_t>(get(bytes, 0));
    const FinishedRecord finished{get_key(bytes, 4), get_rect(bytes, kFrameAndKey)};
    contents_.finished.erase(frame);
    unfinished_.erase(frame);
    if (filter_.frames.contains(frame)) {
      if (!has_key(frame, finished.key)) return {};
      // The outputs show another crop now, but the films may be of use.
      if (finished.region != filter_.region) return {};
    }
    contents_.finished[frame] = finished;
    forget(frame);
    return {};
  }

  std::shared_ptr<core::Film> blank_like(const core::Film& film) const {
    return std::make_shared<core::Film>(film.layout(), filter_.region, film.splats().region());
  }

  bool is_wanted(int32_t frame) {
    const bool wanted = filter_.frames.contains(frame);
    contents_.others = contents_.others || !wanted;
    return wanted;
  }

  bool has_key(int32_t frame, const FrameKey& key) {
    if (other_pixels_) return false;
    auto [known, fresh] = keys_.try_emplace(frame);
    if (fresh && filter_.key) known->second = filter_.key(frame);
    if (known->second == key) return true;
    other_pixels_ = frame;
    return false;
  }

  /// Takes from the film of another region what makes up whole tiles here and is not there yet.
  core::Status merge_tiles(const core::Film& film, core::Film& whole) const {
    const core::PixelRect common = core::intersection(film.window(), filter_.region);
    const int32_t size = contents_.cut.tile_size;
    if (size < 1) return core::Error{"a film stands before the record of its cut"};
    for (int32_t y = tile_begin(common.y0, size); y < common.y1; y += size) {
      for (int32_t x = tile_begin(common.x0, size); x < common.x1; x += size) {
        const core::PixelRect cell{x, y, x + size, y + size};
        const core::PixelRect tile = core::intersection(filter_.region, cell);
        if (filter_.judged && core::intersection(contents_.cut.region, cell) != tile) continue;
        if (core::Status merged = merge_tile(film, tile, whole); !merged) return merged;
      }
    }
    return {};
  }

  static core::Status merge_tile(const core::Film& film, const core::PixelRect& tile,
                                 core::Film& whole) {
    if (!film.window().contains(tile)) return {};
    std::vector<core::Unit> units;
    for (const core::CoverageBox& box : film.coverage().boxes()) {
      if (core::intersection(box.tile, tile).empty()) continue;
      // Sums cannot be taken apart: all that the film holds of the tile, or nothing.
      if (!box.tile.contains(tile) || whole.coverage().overlap({tile, box.batches})) return {};
      units.push_back({0, tile, box.batches});
    }
    return units.empty() ? core::Status() : whole.merge(cut_film(film, units));
  }

  LogContents& contents_;
  const LogFilter& filter_;
  const FilmLog& log_;
  /// What films hold that stay where they are: of each tile, by where it begins.
  using Tiles = std::map<std::pair<int32_t, int32_t>, core::Coverage>;
  std::map<int32_t, Tiles> tiles_;
  std::map<int32_t, FrameKey> keys_;  ///< of the frames met
  std::optional<int32_t> other_pixels_;
  std::set<int32_t> unfinished_;
  bool other_regions_ = false;  ///< films may reach beyond the region, or hold parts of its tiles
};

}  // namespace

std::vector<std::byte> encode_cut(const CutRecord& cut) {
  std::vector<std::byte> out = begin(Kind::cut);
  put(out, cut.region);
  put(out, static_cast<uint32_t>(cut.tile_size));
  put(out, cut.samples);
  return out;
}

std::vector<std::byte> encode_unit(int32_t frame, const FrameKey& key, const core::Film& film) {
  std::vector<std::byte> out = begin(Kind::unit);
  put(out, static_cast<uint32_t>(frame));
  put(out, key);
  const std::vector<std::byte> bytes = core::encode_film(film);
  out.insert(out.end(), bytes.begin(), bytes.end());
  return out;
}

core::Status merge_record(std::span<const std::byte> record, const core::PixelRect& region,
                          std::shared_ptr<core::Film>& whole) {
  if (record.size() < kHead + kFrameAndKey) {
    const bool voids =
        record.size() == kHead + 20 && record[0] == static_cast<std::byte>(Kind::tile_voided);
    if (!voids) return core::Error{"a record of another kind"};
    if (whole) whole->erase(get_rect(record, kHead + 4));
    return {};
  }
  const auto packed = record[0] == static_cast<std::byte>(Kind::delivered)
                          ? film_of_delivered(record.subspan(kHead))
                          : record.subspan(kHead + kFrameAndKey);
  if (!packed) return packed.error();
  auto film = core::decode_film(*packed, {.max_bytes = UINT64_MAX});
  if (!film) return film.error();
  if (whole) return whole->merge(*film);
  if (film->window() == region) {
    whole = std::make_shared<core::Film>(std::move(*film));
    return {};
  }
  whole = std::make_shared<core::Film>(film->layout(), region, film->splats().region());
  return whole->merge(*film);
}

std::vector<std::byte> encode_delivered(const AcceptedUnit& unit, const FrameKey& key,
                                        std::span<const std::byte> film) {
  std::vector<std::byte> out = begin(Kind::delivered);
  out.reserve(film.size() + unit.worker_class.size() + 128);
  put(out, static_cast<uint32_t>(unit.unit.frame));
  put(out, key);
  put(out, unit.digest);
  put(out, static_cast<uint32_t>(unit.worker_class.size()));
  for (const char c : unit.worker_class) out.push_back(static_cast<std::byte>(c));
  out.insert(out.end(), film.begin(), film.end());
  return out;
}

std::vector<std::byte> encode(const FrameRestartedRecord& record) {
  std::vector<std::byte> out = begin(Kind::begun_again);
  put(out, static_cast<uint32_t>(record.frame));
  return out;
}

std::vector<std::byte> encode(const TileVoidedRecord& record) {
  std::vector<std::byte> out = begin(Kind::tile_voided);
  put(out, static_cast<uint32_t>(record.frame));
  put(out, record.tile);
  return out;
}

std::vector<std::byte> encode(const DisputeRecord& record) {
  std::vector<std::byte> out = begin(Kind::dispute);
  put(out, record.open ? 1U : 0U);
  return out;
}

std::vector<std::byte> encode_finished(int32_t frame, const FinishedRecord& finished) {
  std::vector<std::byte> out = begin(Kind::finished);
  put(out, static_cast<uint32_t>(frame));
  put(out, finished.key);
  put(out, finished.region);
  return out;
}

core::Result<LogContents> read_log(FilmLog& log, const LogFilter& filter) {
  LogContents contents;
  Reader reader(contents, filter, log);
  auto report = log.replay([&](std::span<const std::byte> record) { return reader.read(record); });
  if (!report) return report.error();
  contents.bytes = report->bytes;
  contents.problems = std::move(report->problems);
  contents.unfinished = reader.has_unfinished();
  if (contents.cut.tile_size == 0) return contents;
  if (contents.cut.samples != filter.samples) {
    contents.other_picture =
        fmt::format("the kept films are of {} samples per pixel, the job has {}",
                    contents.cut.samples, filter.samples);
  } else if (const auto frame = reader.other_pixels()) {
    contents.other_picture = fmt::format(
        "the kept films of frame {} are of another picture: what decides its pixels has changed",
        *frame);
  }
  return contents;
}

std::vector<core::Unit> units_of(int32_t frame, const core::Coverage& coverage,
                                 const core::PixelRect& region, int32_t tile_size) {
  std::vector<core::Unit> units;
  for (const core::CoverageBox& box : coverage.boxes()) {
    for (int32_t y = tile_begin(box.tile.y0, tile_size); y < box.tile.y1; y += tile_size) {
      for (int32_t x = tile_begin(box.tile.x0, tile_size); x < box.tile.x1; x += tile_size) {
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

bool may_be_too_large(const core::Film& film) {
  return film.layout().layers.splats && film.memory() > FilmLog::kMaxRecordBytes;
}

core::Status write_film(int32_t frame, const FrameKey& key, const core::Film& film,
                        const CutRecord& cut, const std::string& worker_class,
                        const FilmLog::Sink& sink) {
  const std::vector<core::Unit> units = units_of(frame, film.coverage(), cut.region, cut.tile_size);
  if (units.empty()) return {};
  const auto put = [&](const core::Unit& first, const core::Film& part) {
    return sink(worker_class.empty() ? encode_unit(frame, key, part)
                                     : encode_delivered({first, Digest{}, worker_class}, key,
                                                        core::encode_film(part)));
  };
  if (film.layout().layers.splats) return put(units.front(), film);
  for (size_t first = 0; first < units.size();) {
    size_t end = first;
    while (end < units.size() && units[end].tile == units[first].tile) ++end;
    const core::Film part = cut_film(film, {units.data() + first, end - first});
    if (core::Status done = put(units[first], part); !done) return done;
    first = end;
  }
  return {};
}

}  // namespace hyades::coordinator
