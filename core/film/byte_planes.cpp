#include "core/film/byte_planes.h"

#include <zstd.h>

#include <algorithm>
#include <memory>
#include <new>

namespace hyades::core {
namespace {

/// How a byte plane is stored.
enum class PlaneForm : uint8_t {
  constant = 0,    ///< one byte follows
  raw = 1,         ///< the bytes follow
  compressed = 2,  ///< a length (32 bits) and a zstd frame follow
};

struct FreeContext {
  void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
  void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
};

/// Contexts are kept per thread: making one costs more than compressing a tile's plane.
ZSTD_CCtx* compressor() {
  thread_local const std::unique_ptr<ZSTD_CCtx, FreeContext> context(ZSTD_createCCtx());
  if (!context) throw std::bad_alloc();
  return context.get();
}

ZSTD_DCtx* decompressor() {
  thread_local const std::unique_ptr<ZSTD_DCtx, FreeContext> context(ZSTD_createDCtx());
  if (!context) throw std::bad_alloc();
  return context.get();
}

void append_plane(std::vector<std::byte>& out, const std::vector<std::byte>& plane) {
  if (std::all_of(plane.begin(), plane.end(), [&](std::byte b) { return b == plane[0]; })) {
    append_number(out, PlaneForm::constant);
    out.push_back(plane[0]);
    return;
  }
  const size_t begin = out.size();
  append_number(out, PlaneForm::compressed);
  append_number(out, uint32_t{0});
  const size_t data = out.size();
  out.resize(data + ZSTD_compressBound(plane.size()));
  const size_t size = ZSTD_compressCCtx(compressor(), out.data() + data, out.size() - data,
                                        plane.data(), plane.size(), 1);
  if (ZSTD_isError(size) != 0 || size + sizeof(uint32_t) >= plane.size()) {
    out.resize(begin);
    append_number(out, PlaneForm::raw);
    out.insert(out.end(), plane.begin(), plane.end());
    return;
  }
  out.resize(data + size);
  const auto length = static_cast<uint32_t>(size);
  std::copy_n(std::as_bytes(std::span(&length, 1)).begin(), sizeof length,
              out.begin() + static_cast<ptrdiff_t>(data - sizeof length));
}

bool read_plane(ByteReader& in, std::vector<std::byte>& plane) {
  switch (in.number<PlaneForm>()) {
    case PlaneForm::constant:
      std::fill(plane.begin(), plane.end(), in.number<std::byte>());
      return !in.failed();
    case PlaneForm::raw: {
      const std::span<const std::byte> bytes = in.take(plane.size());
      std::copy(bytes.begin(), bytes.end(), plane.begin());
      return !in.failed();
    }
    case PlaneForm::compressed: {
      const std::span<const std::byte> bytes = in.take(in.number<uint32_t>());
      return !in.failed() && ZSTD_decompressDCtx(decompressor(), plane.data(), plane.size(),
                                                 bytes.data(), bytes.size()) == plane.size();
    }
  }
  return false;
}

}  // namespace

std::span<const std::byte> ByteReader::take(size_t count) {
  if (failed_ || count > left_.size()) {
    failed_ = true;
    return {};
  }
  const std::span<const std::byte> bytes = left_.first(count);
  left_ = left_.subspan(count);
  return bytes;
}

void append_planes(std::vector<std::byte>& out, std::span<const std::byte> numbers, size_t width) {
  if (numbers.empty()) return;
  std::vector<std::byte> plane(numbers.size() / width);
  for (size_t k = 0; k < width; ++k) {
    for (size_t i = 0; i < plane.size(); ++i) plane[i] = numbers[i * width + k];
    append_plane(out, plane);
  }
}

bool read_planes(ByteReader& in, std::span<std::byte> numbers, size_t width) {
  if (numbers.empty()) return true;
  std::vector<std::byte> plane(numbers.size() / width);
  for (size_t k = 0; k < width; ++k) {
    if (!read_plane(in, plane)) return false;
    for (size_t i = 0; i < plane.size(); ++i) numbers[i * width + k] = plane[i];
  }
  return true;
}

}  // namespace hyades::core
