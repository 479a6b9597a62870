#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/bytes.h"
#include "core/base/result.h"

/// What a file of NanoVDB (.nvdb) holds: segments of grids, each grid as it lies in memory, perhaps
/// compressed. Layouts by NanoVDB.h and util/IO.h of OpenVDB, major version 32 (their own
/// rule: minor versions do not change it).
namespace hyades::core {

/// Kinds of values in grids of NanoVDB.
enum class NanoType : uint32_t {
  real = 1,          ///< float
  real64 = 2,        ///< double
  vector = 6,        ///< three floats
  quantized4 = 13,   ///< steps of 1/15 between the least and the greatest value of a leaf
  quantized8 = 14,   ///< of 1/255
  quantized16 = 15,  ///< of 1/65535
  quantized = 16,    ///< 1, 2, 4, 8 or 16 bits, leaf by leaf
};

/// A grid, as the file announces it.
struct NanoEntry {
  std::string name;
  NanoType type{};  ///< maybe one that is not named above
  uint16_t codec = 0;
  uint64_t size = 0;                    ///< bytes when unpacked
  std::span<const std::byte> stored{};  ///< of the file
};

/// Whether `bytes` begin as files of NanoVDB do.
bool is_nanovdb(const Bytes& bytes);

/// The grids of a file. Errors: another version, a file that ends too early.
Result<std::vector<NanoEntry>> nanovdb_entries(const Bytes& bytes);

/// The grid's bytes, which belong to the file where they are not compressed. Errors: an unknown
/// compression, bytes that cannot be decompressed or do not come to the size that is stated, more
/// than kMostVdbBytes.
Result<Bytes> unpack_nanovdb(const NanoEntry& entry, const Bytes& file);

/// "Float", "Vec3f", ...: NanoVDB's names of its types.
std::string name_of(NanoType type);

}  // namespace hyades::core
