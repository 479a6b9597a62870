#include "core/base/gunzip.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <string>
#include <vector>

namespace hyades::core {
namespace {

std::string packed(const std::string& text) {
  z_stream stream{};
  EXPECT_EQ(deflateInit2(&stream, 9, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY), Z_OK);
  std::string out(deflateBound(&stream, text.size()) + 64, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

Result<Bytes> unpack(const std::string& file, size_t limit = size_t{1} << 20) {
  return gunzip(std::as_bytes(std::span(file)), limit);
}

std::string text_of(const Result<Bytes>& bytes) {
  return bytes ? std::string(bytes->chars(), bytes->size()) : "error: " + bytes.error().message;
}

/// Text that packs badly, of some length.
std::string noise(size_t size) {
  std::string text;
  uint32_t state = 1;
  while (text.size() < size)
    text += static_cast<char>((state = state * 1664525U + 1013904223U) >> 24U);
  return text;
}

TEST(Gunzip, GivesBackWhatWasPacked) {
  for (const size_t size :
       {size_t{0}, size_t{1}, size_t{65535}, size_t{65536}, size_t{65537}, size_t{300'000}}) {
    for (const std::string& text : {noise(size), std::string(size, 'a')}) {
      const std::string file = packed(text);
      EXPECT_TRUE(is_gzip(std::as_bytes(std::span(file))));
      EXPECT_TRUE(text_of(unpack(file)) == text) << size;
    }
  }
}

TEST(Gunzip, JoinsMembersAndPassesOverPadding) {
  const std::string two = packed("first ") + packed("second");
  EXPECT_EQ(text_of(unpack(two)), "first second");
  EXPECT_EQ(text_of(unpack(two + std::string(100, '\0'))), "first second");
  EXPECT_NE(text_of(unpack(two + "more")).find("something else"), std::string::npos);
}

TEST(Gunzip, EveryTruncationIsAnError) {
  const std::string file = packed(noise(2000));
  for (size_t size = 0; size < file.size(); ++size) {
    EXPECT_FALSE(unpack(file.substr(0, size))) << size;
  }
}

TEST(Gunzip, DamageIsAnError) {
  std::string file = packed(noise(2000));
  file[file.size() / 2] = static_cast<char>(file[file.size() / 2] ^ 4);
  EXPECT_FALSE(unpack(file));
}

TEST(Gunzip, BombsAreRefusedBeforeTheyTakeMemory) {
  const std::string bomb = packed(std::string(50'000'000, '\0'));
  ASSERT_LT(bomb.size(), 100'000U);
  const auto small = unpack(bomb, 1'000'000);
  ASSERT_FALSE(small);
  EXPECT_NE(small.error().message.find("more than 1000000 bytes"), std::string::npos);
  EXPECT_TRUE(unpack(packed(std::string(1000, 'x')), 1000));
  EXPECT_FALSE(unpack(packed(std::string(1001, 'x')), 1000));
}

}  // namespace
}  // namespace hyades::core
