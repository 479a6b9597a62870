#include "core/base/hash.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace hyades::core {
namespace {

TEST(Hash, Sha256KnownAnswers) {  // FIPS 180-4 examples
  EXPECT_EQ(to_hex(sha256(std::string_view("abc"))),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(to_hex(sha256(std::string_view())),
            "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

TEST(Hash, Sha256InPiecesIsThatOfTheWhole) {
  std::vector<std::byte> bytes(300);
  for (size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::byte>(i * 31 + 7);
  const std::span<const std::byte> all(bytes);
  for (const size_t piece : {1, 63, 64, 65, 299, 300}) {
    Sha256Stream stream;
    for (size_t at = 0; at < all.size(); at += piece) {
      EXPECT_EQ(stream.digest(), sha256(all.first(at)));  // asking changes nothing
      stream.add(all.subspan(at, std::min(piece, all.size() - at)));
    }
    EXPECT_EQ(stream.digest(), sha256(all));
  }
  EXPECT_EQ(Sha256Stream().digest(), sha256(std::string_view()));
}

TEST(Hash, Crc32cKnownAnswers) {  // RFC 3720, B.4
  std::vector<std::byte> bytes(32, std::byte{0});
  EXPECT_EQ(crc32c(bytes), 0x8A9136AAU);
  for (auto& b : bytes) b = std::byte{0xFF};
  EXPECT_EQ(crc32c(bytes), 0x62A8AB43U);
  for (size_t i = 0; i < 32; ++i) bytes[i] = static_cast<std::byte>(i);
  EXPECT_EQ(crc32c(bytes), 0x46DD794EU);
  EXPECT_EQ(crc32c(std::as_bytes(std::span(std::string_view("123456789")))), 0xE3069283U);
  EXPECT_EQ(crc32c({}), 0U);
}

TEST(Hash, Murmur3KnownAnswers) {  // as published with Appleby's SMHasher and by its users
  EXPECT_EQ(murmur3(""), 0U);
  EXPECT_EQ(murmur3("", 1), 0x514E28B7U);
  EXPECT_EQ(murmur3("hello"), 0x248BFA47U);
  EXPECT_EQ(murmur3("The quick brown fox jumps over the lazy dog"), 0x2E4FF723U);
}

TEST(Hash, Crc32cContinues) {
  std::vector<std::byte> bytes(101);
  for (size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::byte>(i * 37 + 5);
  const std::span<const std::byte> all(bytes);
  const uint32_t whole = crc32c(all);
  for (size_t cut = 0; cut <= bytes.size(); ++cut) {
    EXPECT_EQ(crc32c(all.subspan(cut), crc32c(all.first(cut))), whole);
  }
}

}  // namespace
}  // namespace hyades::core
