#pragma once

#include <OpenEXR/ImfFrameBuffer.h>

#include <string>
#include <vector>

#include "core/film/film.h"

namespace hyades::core {

inline constexpr const char* kPicturePart = "picture";
inline constexpr const char* kSumsPart = "sums";
inline constexpr const char* kFilmAttribute = "hyades.film";
inline constexpr const char* kDigestAttribute = "hyades.digest";

/// One channel of part "sums": 32 bits of every pixel of a film's plane.
struct WordChannel {
  std::string name;  ///< "R.sum0" (the lowest bits) .. "R.sum3"; minima: "depth.Z.min"
  /// Of the film; behind those the splats' values and squares, R G B each, and the values of what
  /// splats brought to each part of light.
  int channel = 0;
  int word = 0;           ///< 0 lowest
  bool required = false;  ///< others are left out where they are zero everywhere
};

std::vector<WordChannel> word_channels(const FilmLayout& layout);

/// The word as OpenEXR sees it, lying where the film keeps it: nothing is copied. Splats are held
/// for all pixels of the window (SplatLayer::all).
Imf::Slice word_slice(const Film& film, const WordChannel& word);

/// Whether the word is 0 in all pixels.
bool is_zero(const Film& film, const WordChannel& word);

/// What identifies the film's sums and all facts about it; detects damage that compression did not.
std::string film_file_digest(const std::string& header, const Film& film);

}  // namespace hyades::core
