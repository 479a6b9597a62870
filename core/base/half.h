#pragma once

#include <bit>
#include <cstdint>

/// 16-bit floating-point numbers (IEEE 754 binary16) by integer arithmetic alone: the same bits on
/// every machine, whatever its flags say about denormals.
namespace hyades::core {

inline float from_half(uint16_t half) {
  const uint32_t sign = uint32_t{half & 0x8000U} << 16U;
  const uint32_t magnitude = half & 0x7FFFU;
  const uint32_t exponent = magnitude >> 10U;
  if (exponent - 1 < 30) {  // normal
    return std::bit_cast<float>(sign | ((magnitude << 13U) + (112U << 23U)));
  }
  const uint32_t mantissa = magnitude & 0x3FFU;
  if (exponent == 31) return std::bit_cast<float>(sign | 0x7F800000U | (mantissa << 13U));
  if (mantissa == 0) return std::bit_cast<float>(sign);
  const auto zeros = static_cast<uint32_t>(std::countl_zero(mantissa)) - 21U;  // 1 to 10
  return std::bit_cast<float>(sign | ((113U - zeros) << 23U) |
                              ((mantissa << (13U + zeros)) & 0x7FFFFFU));
}

/// The nearest half, the even one of two that are; infinity beyond 65504 and a bit.
inline uint16_t to_half(float value) {
  const auto bits = std::bit_cast<uint32_t>(value);
  const auto sign = static_cast<uint16_t>((bits >> 16U) & 0x8000U);
  const uint32_t magnitude = bits & 0x7FFFFFFFU;
  if (magnitude > 0x7F800000U) return sign | 0x7E00U;
  if (magnitude >= 0x477FF000U) return sign | 0x7C00U;  // rounds to 65536 or more
  if (magnitude < 0x33000000U) return sign;             // less than half of the least denormal
  const auto round = [](uint32_t digits, uint32_t drop) {
    const uint32_t rest = digits & ((1U << drop) - 1U);
    const uint32_t tie = 1U << (drop - 1U);
    const uint32_t kept = digits >> drop;
    return kept + (rest > tie || (rest == tie && (kept & 1U) != 0) ? 1U : 0U);
  };
  if (magnitude >= 0x38800000U) {  // normal: a carry out of the mantissa raises the exponent
    return static_cast<uint16_t>(sign | round(magnitude - (112U << 23U), 13U));
  }
  const uint32_t digits = (magnitude & 0x7FFFFFU) | 0x800000U;
  return static_cast<uint16_t>(sign | round(digits, 126U - (magnitude >> 23U)));
}

}  // namespace hyades::core
