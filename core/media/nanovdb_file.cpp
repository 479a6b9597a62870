#include "core/media/nanovdb_file.h"

#include <blosc.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <string_view>

#include <fmt/format.h>

#include "core/media/read_vdb.h"
#include "core/media/vdb_cursor.h"

namespace hyades::core {
namespace {

/// "NanoVDB0" until version 32.6, "NanoVDB2" for files since then.
constexpr uint64_t kMagic = 0x304244566f6e614eU;
constexpr uint64_t kMagicOfFiles = 0x324244566f6e614eU;

constexpr uint32_t kMajor = 32;

enum Codec : uint16_t { kNone = 0, kZip = 1, kBlosc = 2 };

/// Larger grids are compressed piece by piece.
constexpr uint64_t kBloscPiece = uint64_t{1} << 30U;

/// No compressor that is used here gains more: what claims to is refused before memory is taken.
constexpr uint64_t kMostGain = 1100;

/// What stands before each grid's name.
constexpr size_t kEntryBytes = 176;

NanoEntry read_entry(VdbCursor& cursor, uint64_t& stored) {
  NanoEntry entry;
  VdbCursor fields(cursor.take(kEntryBytes));
  entry.size = fields.read<uint64_t>();
  stored = fields.read<uint64_t>();
  fields.take(16);  // the name's hash, the number of active voxels
  entry.type = static_cast<NanoType>(fields.read<uint32_t>());
  fields.take(4 + 48 + 24 + 24);  // class, bounds twice, the size of a voxel
  const auto name_size = fields.read<uint32_t>();
  fields.take(16 + 12);  // numbers of nodes and of tiles
  entry.codec = fields.read<uint16_t>();
  const auto name = cursor.take(name_size);
  entry.name.assign(reinterpret_cast<const char*>(name.data()), name.size());
  entry.name.resize(std::min(entry.name.size(), entry.name.find('\0')));
  return entry;
}

bool unzip(std::span<const std::byte> packed, std::span<std::byte> out) {
  uLongf length = out.size();
  return uncompress(reinterpret_cast<Bytef*>(out.data()), &length,
                    reinterpret_cast<const Bytef*>(packed.data()), packed.size()) == Z_OK &&
         length == out.size();
}

bool unblosc(std::span<const std::byte> packed, std::span<std::byte> out) {
  size_t stated = 0;
  return blosc_cbuffer_validate(packed.data(), packed.size(), &stated) == 0 &&
         stated == out.size() &&
         blosc_decompress_ctx(packed.data(), out.data(), out.size(), 1) ==
             static_cast<int>(out.size());
}

}  // namespace

bool is_nanovdb(const Bytes& bytes) {
  const auto magic = VdbCursor(bytes).read<uint64_t>();
  return magic == kMagic || magic == kMagicOfFiles;
}

Result<std::vector<NanoEntry>> nanovdb_entries(const Bytes& bytes) {
  VdbCursor cursor(bytes);
  std::vector<NanoEntry> entries;
  while (cursor.ok() && !cursor.at_end()) {
    const auto magic = cursor.read<uint64_t>();
    const auto version = cursor.read<uint32_t>();
    const auto grids = cursor.read<uint16_t>();
    const auto codec = cursor.read<uint16_t>();
    if (!cursor.ok()) break;
    if (magic != kMagic && magic != kMagicOfFiles) {
      return Error{"has something else than grids of NanoVDB after the first ones"};
    }
    if (version >> 21U != kMajor) {
      return Error{fmt::format("has version {}.{} of the NanoVDB format, expected {}.x",
                               version >> 21U, version >> 10U & 0x7FFU, kMajor)};
    }
    std::vector<uint64_t> stored(grids);
    const size_t first = entries.size();
    for (uint64_t& size : stored) {
      if (!cursor.ok()) break;
      entries.push_back(read_entry(cursor, size));
      entries.back().codec = codec;
    }
    for (size_t i = first; i < entries.size() && cursor.ok(); ++i) {
      entries[i].stored = cursor.take(stored[i - first]);
    }
  }
  if (!cursor.ok()) return Error{cursor.error()};
  return entries;
}

Result<Bytes> unpack_nanovdb(const NanoEntry& entry, const Bytes& file) {
  const auto wrong = [] { return Error{"cannot be decompressed"}; };
  if (entry.codec == kNone) {
    if (entry.stored.size() != entry.size) return Error{"has another size than the file states"};
    return Bytes{std::make_shared<const Bytes>(file), entry.stored};
  }
  if (entry.codec != kZip && entry.codec != kBlosc) {
    return Error{fmt::format("is compressed in a way that is not known (number {})", entry.codec)};
  }
  if (entry.size > kMostVdbBytes) return Error{"is larger than can be read"};
  if (entry.size / kMostGain > entry.stored.size()) return wrong();
  const auto unpacked = std::make_shared<std::vector<std::byte>>(entry.size);
  std::span<std::byte> rest(*unpacked);
  VdbCursor cursor(entry.stored);
  while (!rest.empty()) {
    const auto packed = cursor.take(cursor.read<uint64_t>());
    const auto piece =
        rest.first(entry.codec == kZip ? rest.size() : std::min<size_t>(rest.size(), kBloscPiece));
    if (!cursor.ok() || !(entry.codec == kZip ? unzip(packed, piece) : unblosc(packed, piece))) {
      return wrong();
    }
    rest = rest.subspan(piece.size());
  }
  return Bytes{unpacked, std::span<const std::byte>(*unpacked)};
}

std::string name_of(NanoType type) {
  static constexpr std::array<std::string_view, 20> kNames = {
      "?",      "Float",   "Double", "Int16", "Int32", "Int64", "Vec3f", "Vec3d", "Mask",  "Half",
      "UInt32", "Boolean", "RGBA8",  "Fp4",   "Fp8",   "Fp16",  "FpN",   "Vec4f", "Vec4d", "Index"};
  const auto number = static_cast<uint32_t>(type);
  return number < kNames.size() ? std::string(kNames[number]) : fmt::format("number {}", number);
}

}  // namespace hyades::core
