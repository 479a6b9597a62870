#include "core/base/hash.h"

#include <nmmintrin.h>
#include <openssl/evp.h>
#include <openssl/hmac.h>

#include <cstring>
#include <new>

namespace hyades::core {

Sha256 sha256(std::span<const std::byte> bytes) {
  Sha256 digest{};
  unsigned length = 0;
  // EVP_Digest fails only where OpenSSL cannot allocate its context.
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &length, EVP_sha256(), nullptr) != 1 ||
      length != digest.size()) {
    throw std::bad_alloc();
  }
  return digest;
}

Sha256 sha256(std::string_view text) { return sha256(std::as_bytes(std::span(text))); }

Sha256 hmac_sha256(std::string_view key, std::string_view message) {
  Sha256 code{};
  unsigned size = 0;
  HMAC(EVP_sha256(), key.data(), static_cast<int>(key.size()),
       reinterpret_cast<const unsigned char*>(message.data()), message.size(), code.data(), &size);
  return code;
}

struct Sha256Stream::Context {
  EVP_MD_CTX* openssl = EVP_MD_CTX_new();
  Context() {
    if (openssl == nullptr) throw std::bad_alloc();
  }
  ~Context() { EVP_MD_CTX_free(openssl); }
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
};

// As above: these calls fail only where memory is out.
Sha256Stream::Sha256Stream() : context_(std::make_unique<Context>()) {
  if (EVP_DigestInit_ex(context_->openssl, EVP_sha256(), nullptr) != 1) throw std::bad_alloc();
}

Sha256Stream::~Sha256Stream() = default;
Sha256Stream::Sha256Stream(Sha256Stream&&) noexcept = default;
Sha256Stream& Sha256Stream::operator=(Sha256Stream&&) noexcept = default;

void Sha256Stream::add(std::span<const std::byte> bytes) {
  if (EVP_DigestUpdate(context_->openssl, bytes.data(), bytes.size()) != 1) throw std::bad_alloc();
}

Sha256 Sha256Stream::digest() const {
  const Context copy;
  Sha256 digest{};
  unsigned length = 0;
  if (EVP_MD_CTX_copy_ex(copy.openssl, context_->openssl) != 1 ||
      EVP_DigestFinal_ex(copy.openssl, digest.data(), &length) != 1) {
    throw std::bad_alloc();
  }
  return digest;
}

std::string to_hex(std::span<const uint8_t> bytes) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  text.reserve(2 * bytes.size());
  for (const uint8_t byte : bytes) {
    text.push_back(kDigits[byte >> 4]);
    text.push_back(kDigits[byte & 15]);
  }
  return text;
}

uint32_t crc32c(std::span<const std::byte> bytes, uint32_t previous) {
  uint64_t crc = ~previous;
  const std::byte* at = bytes.data();
  size_t left = bytes.size();
  for (; left >= 8; left -= 8, at += 8) {
    uint64_t word;
    std::memcpy(&word, at, 8);
    crc = _mm_crc32_u64(crc, word);
  }
  auto narrow = static_cast<uint32_t>(crc);
  for (; left > 0; --left, ++at) narrow = _mm_crc32_u8(narrow, std::to_integer<uint8_t>(*at));
  return ~narrow;
}

uint32_t murmur3(std::string_view text, uint32_t seed) {
  const auto turned = [](uint32_t x, unsigned by) { return (x << by) | (x >> (32U - by)); };
  const auto mixed = [&](uint32_t k) { return turned(k * 0xCC9E2D51U, 15) * 0x1B873593U; };
  const auto byte = [&](size_t i) { return uint32_t{static_cast<unsigned char>(text[i])}; };
  uint32_t h = seed;
  size_t i = 0;
  for (; i + 4 <= text.size(); i += 4) {
    h ^= mixed(byte(i) | byte(i + 1) << 8U | byte(i + 2) << 16U | byte(i + 3) << 24U);
    h = turned(h, 13) * 5U + 0xE6546B64U;
  }
  uint32_t tail = 0;
  for (size_t j = text.size(); j > i; --j) tail = tail << 8U | byte(j - 1);
  if (i < text.size()) h ^= mixed(tail);
  h ^= static_cast<uint32_t>(text.size());
  h = (h ^ h >> 16U) * 0x85EBCA6BU;
  h = (h ^ h >> 13U) * 0xC2B2AE35U;
  return h ^ h >> 16U;
}

}  // namespace hyades::core
