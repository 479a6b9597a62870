#pragma once

#include <array>
#include <cstdint>

/// The digital sequence in four dimensions behind SobolSampler. Columns are written with bit r for
/// the binary digit r after the point (bit 0 is the first digit): the mirror image of the usual
/// direction numbers.
namespace hyades::core::sobol {

/// Dimensions 0 and 1 are the first two of Sobol's sequence (the identity and Pascal's triangle
/// modulo 2): a (0, 2)-sequence in base 2, that is, any aligned run of 2^k points has one point in
/// each of the rectangles of area 2^-k of every shape. Dimensions 2 and 3 are the same two after an
/// upper triangular matrix, which keeps that property, so both pairs have it (Sobol's own third and
/// fourth dimension do not). The columns of that matrix were found by a beam search for the lowest
/// quality parameter t of the four dimensions together and of the crossed pairs: t = 1, 1, 1, 2, 1,
/// 2, 2, 2, 3, 3, 3 for 2^2 .. 2^12 points, at most 4 up to 2^19 (Sobol: 1, 2, 2, 2, 2, 2, 3, 3,
/// 2, 2, 3).
inline constexpr std::array<uint32_t, 32> kPairColumns = {
    0x00000001, 0x00000003, 0x00000004, 0x0000000D, 0x00000011, 0x00000032, 0x00000045, 0x000000DB,
    0x00000174, 0x0000030B, 0x000006A6, 0x00000853, 0x0000183D, 0x0000201F, 0x000064F9, 0x0000F5EC,
    0x00013987, 0x0002D302, 0x000443E7, 0x000E9103, 0x001FE782, 0x002F9092, 0x006760C0, 0x00DB5D5C,
    0x015E4209, 0x02E759AC, 0x05D6C2F0, 0x0F79A021, 0x187FF663, 0x2BF7B165, 0x4D6086CA, 0xB9DCB206};

/// Column i of Pascal's triangle modulo 2: digit r is binomial(i, r) mod 2 (Lucas: r within i).
constexpr uint32_t pascal_column(uint32_t i) {
  uint32_t column = 0;
  for (uint32_t r = 0; r < 32; ++r) column |= (i & r) == r ? 1U << r : 0U;
  return column;
}

/// Digits of dimension 0..3 that bit `i` of the point's index flips.
constexpr std::array<uint32_t, 4> columns(uint32_t i) {
  uint32_t fourth = 0;
  for (uint32_t k = 0; k < 32; ++k) {
    if ((kPairColumns[i] >> k & 1U) != 0) fourth ^= pascal_column(k);
  }
  return {1U << i, pascal_column(i), kPairColumns[i], fourth};
}

/// For each four bits of the mirrored index (bit 31 - i of it is bit i of the index) the digits of
/// all dimensions.
struct alignas(16) NibbleTable {
  uint32_t digits[8][16][4];
};

constexpr NibbleTable make_nibble_table() {
  NibbleTable table{};
  for (uint32_t nibble = 0; nibble < 8; ++nibble) {
    for (uint32_t value = 0; value < 16; ++value) {
      for (uint32_t bit = 0; bit < 4; ++bit) {
        if ((value >> bit & 1U) == 0) continue;
        const std::array<uint32_t, 4> flips = columns(31 - (4 * nibble + bit));
        for (uint32_t d = 0; d < 4; ++d) table.digits[nibble][value][d] ^= flips[d];
      }
    }
  }
  return table;
}

inline constexpr NibbleTable kNibbles = make_nibble_table();

}  // namespace hyades::core::sobol
