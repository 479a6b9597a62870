#pragma once

#include <OpenEXR/ImfIO.h>

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/result.h"
#include "core/image/decoders.h"

namespace hyades::core {

/// Sets OpenEXR up for this process: no threads of its own (renders have theirs), bounded picture
/// sizes. Called by everything that reads or writes EXR; thread-safe, cheap.
void prepare_openexr();

/// Walks the headers of all parts before OpenEXR does, because OpenEXR takes the memory that a
/// header asks for: every attribute must lie within the file, every part within the limits, and the
/// file must have room for as many chunks as it claims.
Status check_exr_header(std::span<const std::byte> file, const ImageLimits& limits);

/// OpenEXR's input from bytes in memory. They must outlive the stream.
class MemoryIStream : public Imf::IStream {
 public:
  explicit MemoryIStream(std::span<const std::byte> bytes);

  bool read(char out[], int count) override;  ///< throws where the bytes end
  uint64_t tellg() override { return at_; }
  void seekg(uint64_t position) override;
  void clear() override {}

 private:
  std::span<const std::byte> bytes_;
  uint64_t at_ = 0;
};

}  // namespace hyades::core
