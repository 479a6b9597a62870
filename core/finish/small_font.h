#pragma once

#include <array>
#include <cstdint>

namespace hyades::core {

inline constexpr int kGlyphWidth = 5;
inline constexpr int kGlyphHeight = 7;

/// The dots of a character, row by row from the top, the left dot being bit 4. Letters are
/// capitals; what has no glyph is blank.
std::array<uint8_t, kGlyphHeight> glyph_of(char character);

}  // namespace hyades::core
