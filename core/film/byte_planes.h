#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

/// Arrays of numbers, compressed byte plane by byte plane: the first bytes of all numbers together,
/// then the second, ... Planes of one value (mostly zeros) take two bytes.
namespace hyades::core {

/// Bytes that are read from front to back; what is not there is an error, once and for all.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) : left_(bytes) {}

  /// The next `count` bytes; empty (and failed()) where there are fewer.
  std::span<const std::byte> take(size_t count);

  /// The next bytes as a number or plain struct, little-endian; zero where they are missing.
  template <class T>
  T number() {
    T value{};
    const std::span<const std::byte> bytes = take(sizeof(T));
    if (!failed_) std::memcpy(&value, bytes.data(), sizeof value);
    return value;
  }

  size_t left() const { return left_.size(); }
  bool failed() const { return failed_; }

 private:
  std::span<const std::byte> left_;
  bool failed_ = false;
};

/// Appends a number or plain struct as it lies in memory (little-endian).
template <class T>
void append_number(std::vector<std::byte>& out, const T& value) {
  const size_t at = out.size();
  out.resize(at + sizeof value);
  std::memcpy(out.data() + at, &value, sizeof value);
}

/// Appends the planes of `count` numbers of `width` bytes each, lying one after the other in
/// `numbers`.
void append_planes(std::vector<std::byte>& out, std::span<const std::byte> numbers, size_t width);

/// Fills `numbers` with what append_planes() wrote. Returns false where the bytes are damaged.
bool read_planes(ByteReader& in, std::span<std::byte> numbers, size_t width);

}  // namespace hyades::core
