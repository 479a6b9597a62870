#include "core/film/fixed128.h"

namespace hyades::core {

double to_double(const Fixed128& value) {
  const bool negative = value.high < 0;
  const Fixed128::Raw magnitude = negative ? -value.raw() : value.raw();
  const auto high = static_cast<uint64_t>(magnitude >> 64);
  double scaled = 0.0;
  if (high == 0) {
    scaled = static_cast<double>(static_cast<uint64_t>(magnitude)) * 0x1p-64;
  } else {
    // Keep the leading 64 bits; what falls off below them matters only as "not exactly half", so
    // one sticky bit stands for it and the conversion rounds once.
    const int drop = 64 - std::countl_zero(high);
    auto leading = static_cast<uint64_t>(magnitude >> drop);
    if ((magnitude & ((Fixed128::Raw{1} << drop) - 1)) != 0) leading |= 1U;
    const auto power = static_cast<uint64_t>(1023 - 64 + drop) << 52U;  // 2^(drop - 64)
    scaled = static_cast<double>(leading) * std::bit_cast<double>(power);
  }
  return negative ? -scaled : scaled;
}

}  // namespace hyades::core
