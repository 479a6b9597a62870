#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace hyades::core {

/// Mixes 64 bits so that every output bit depends on every input bit (Stafford 2011, "Better Bit
/// Mixing", variant 13).
constexpr uint64_t mix64(uint64_t x) {
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBULL;
  return x ^ (x >> 31);
}

/// Hash of two words; order matters.
constexpr uint64_t hash_combine(uint64_t a, uint64_t b) {
  return mix64(a + 0x9E3779B97F4A7C15ULL + mix64(b + 0xD1B54A32D192ED03ULL));
}

using Sha256 = std::array<uint8_t, 32>;

/// SHA-256 of `bytes` (FIPS 180-4; OpenSSL does the work).
Sha256 sha256(std::span<const std::byte> bytes);
Sha256 sha256(std::string_view text);

/// HMAC-SHA-256 of `message` (RFC 2104; OpenSSL does the work): nobody without `key` can make it.
Sha256 hmac_sha256(std::string_view key, std::string_view message);

/// SHA-256 of bytes that come in pieces.
class Sha256Stream {
 public:
  Sha256Stream();
  ~Sha256Stream();
  Sha256Stream(Sha256Stream&&) noexcept;
  Sha256Stream& operator=(Sha256Stream&&) noexcept;

  void add(std::span<const std::byte> bytes);

  /// The digest of everything added so far; more may be added afterwards.
  Sha256 digest() const;

 private:
  struct Context;
  std::unique_ptr<Context> context_;
};

/// Lower-case hexadecimal.
std::string to_hex(std::span<const uint8_t> bytes);

/// MurmurHash3_x86_32 (Appleby 2011), which Cryptomatte names things by.
uint32_t murmur3(std::string_view text, uint32_t seed = 0);

/// 32 bits that detect torn or flipped bytes (CRC-32C, Castagnoli polynomial).
uint32_t crc32c(std::span<const std::byte> bytes, uint32_t previous = 0);

}  // namespace hyades::core
