#pragma once

#include <algorithm>
#include <utility>

#include "coordinator/web/exchange.h"
#include "core/base/bytes.h"

namespace hyades::coordinator {

/// Bytes [first, first + count) of a mapped file.
class FileSource final : public BodySource {
 public:
  FileSource(core::Bytes bytes, uint64_t first, uint64_t count)
      : bytes_(std::move(bytes)), at_(first), end_(first + count), size_(count) {}

  std::optional<std::string> next() override {
    const uint64_t count = std::min(kPiece, end_ - at_);
    std::string piece(bytes_.chars() + at_, count);
    at_ += count;
    return piece;
  }
  std::optional<uint64_t> size() const override { return size_; }

 private:
  static constexpr uint64_t kPiece = uint64_t{1} << 20U;
  core::Bytes bytes_;
  uint64_t at_;
  uint64_t end_;
  uint64_t size_;
};

}  // namespace hyades::coordinator
