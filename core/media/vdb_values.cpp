#include "core/media/vdb_values.h"

#include <blosc.h>
#include <zlib.h>

#include <cstdint>
#include <cstring>
#include <span>

#include "core/base/half.h"

namespace hyades::core {
namespace {

constexpr uint32_t kZipFlag = 1;
constexpr uint32_t kActiveAloneFlag = 2;
constexpr uint32_t kBloscFlag = 4;

/// A byte before a node's values says which of its inactive ones follow.
enum Inactive : uint8_t {
  kOne = 2,
  kMaskAndNone = 3,
  kMaskAndOne = 4,
  kMaskAndTwo = 5,
  kAll = 6,
};

/// `size` bytes, decompressed.
std::vector<std::byte> unpack(VdbCursor& cursor, uint32_t compression, size_t size) {
  std::vector<std::byte> unpacked(size);
  const auto copy = [&](std::span<const std::byte> raw) {
    if (raw.size() == size && size > 0) std::memcpy(unpacked.data(), raw.data(), size);
    if (raw.size() != size) cursor.fail("has a node of a wrong size");
  };
  if ((compression & (kZipFlag | kBloscFlag)) == 0) {
    copy(cursor.take(size));
    return unpacked;
  }
  const auto packed_size = cursor.read<int64_t>();
  if (packed_size <= 0) {  // not worth compressing: as many bytes as they are, negated
    copy(cursor.take(0 - static_cast<uint64_t>(packed_size)));
    return unpacked;
  }
  const auto packed = cursor.take(static_cast<uint64_t>(packed_size));
  if (!cursor.ok()) return unpacked;
  if ((compression & kBloscFlag) != 0) {
    size_t stated = 0;
    const bool good =
        blosc_cbuffer_validate(packed.data(), packed.size(), &stated) == 0 && stated == size &&
        blosc_decompress_ctx(packed.data(), unpacked.data(), size, 1) == static_cast<int>(size);
    if (!good) cursor.fail("has a node that cannot be decompressed");
  } else {
    uLongf length = size;
    const int done = uncompress(reinterpret_cast<Bytef*>(unpacked.data()), &length,
                                reinterpret_cast<const Bytef*>(packed.data()), packed.size());
    if (done != Z_OK || length != size) cursor.fail("has a node that cannot be decompressed");
  }
  return unpacked;
}

template <class T>
T element(const std::vector<std::byte>& bytes, size_t i) {
  T value;
  std::memcpy(&value, bytes.data() + i * sizeof(T), sizeof(T));
  return value;
}

}  // namespace

VdbValues read_vdb_values(VdbCursor& cursor, const VdbEncoding& encoding, size_t places,
                          size_t active) {
  const auto components = static_cast<size_t>(encoding.components);
  const size_t whole = components * static_cast<size_t>(encoding.component_bytes);
  const auto inactive = cursor.read<uint8_t>();
  if (inactive > kAll) cursor.fail("has a node of an unknown kind");
  if (inactive == kOne || inactive == kMaskAndOne) cursor.take(whole);
  if (inactive == kMaskAndTwo) cursor.take(2 * whole);
  if (inactive >= kMaskAndNone && inactive <= kMaskAndTwo) cursor.take(places / 8);

  VdbValues values;
  values.active_alone = (encoding.compression & kActiveAloneFlag) != 0 && inactive != kAll;
  const size_t count = (values.active_alone ? active : places) * components;
  if (count == 0 && encoding.half) return values;
  const size_t bytes_each = encoding.half ? 2 : static_cast<size_t>(encoding.component_bytes);
  const auto bytes = unpack(cursor, encoding.compression, count * bytes_each);
  if (!cursor.ok()) return values;
  values.components.resize(count);
  for (size_t i = 0; i < count; ++i) {
    values.components[i] = encoding.half     ? from_half(element<uint16_t>(bytes, i))
                           : bytes_each == 8 ? static_cast<float>(element<double>(bytes, i))
                                             : element<float>(bytes, i);
  }
  return values;
}

}  // namespace hyades::core
