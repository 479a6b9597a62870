#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>

#include "core/base/bytes.h"

namespace hyades::core {

/// Reads the bytes of a .vdb or .nvdb (little-endian) one after the other. What lies beyond the end
/// reads as zeros; the first failure stays.
class VdbCursor {
 public:
  explicit VdbCursor(const Bytes& bytes) : bytes_(bytes.span()) {}
  explicit VdbCursor(std::span<const std::byte> bytes) : bytes_(bytes) {}

  bool ok() const { return error_.empty(); }
  bool at_end() const { return at_ == bytes_.size(); }
  const std::string& error() const { return error_; }
  void fail(const std::string& error) {
    if (ok()) error_ = error;
  }

  template <class T>
  T read() {
    T value{};
    const std::span<const std::byte> raw = take(sizeof(T));
    if (!raw.empty()) std::memcpy(&value, raw.data(), sizeof(T));
    return value;
  }

  /// The next `count` bytes; empty where there are not as many.
  std::span<const std::byte> take(uint64_t count) {
    if (!ok()) return {};
    if (count > bytes_.size() - at_) {
      fail("ends too early");
      return {};
    }
    const auto taken = bytes_.subspan(at_, static_cast<size_t>(count));
    at_ += taken.size();
    return taken;
  }

  std::string read_text() {
    const auto raw = take(read<uint32_t>());
    return {reinterpret_cast<const char*>(raw.data()), raw.size()};
  }

  /// Goes on at a place given from the beginning.
  void seek(int64_t place) {
    if (place < 0 || static_cast<uint64_t>(place) > bytes_.size()) return fail("ends too early");
    at_ = static_cast<size_t>(place);
  }

 private:
  std::span<const std::byte> bytes_;
  size_t at_ = 0;
  std::string error_;
};

}  // namespace hyades::core
