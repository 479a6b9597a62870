#include "core/image/exr_support.h"

#include <OpenEXR/Iex.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfThreading.h>

#include <cstring>
#include <mutex>

namespace hyades::core {

void prepare_openexr() {
  static std::once_flag once;
  std::call_once(once, [] {
    Imf::setGlobalThreadCount(0);
    Imf::Header::setMaxImageSize(1 << 20, 1 << 20);
    Imf::Header::setMaxTileSize(1 << 14, 1 << 14);
  });
}

MemoryIStream::MemoryIStream(std::span<const std::byte> bytes)
    : Imf::IStream("memory"), bytes_(bytes) {}

bool MemoryIStream::read(char out[], int count) {
  if (count < 0 || at_ > bytes_.size() || static_cast<uint64_t>(count) > bytes_.size() - at_) {
    throw Iex::InputExc("the file is truncated");
  }
  std::memcpy(out, bytes_.data() + at_, static_cast<size_t>(count));
  at_ += static_cast<uint64_t>(count);
  return at_ < bytes_.size();
}

void MemoryIStream::seekg(uint64_t position) { at_ = position; }

}  // namespace hyades::core
