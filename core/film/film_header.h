#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "core/base/rect.h"
#include "core/base/result.h"
#include "core/film/coverage.h"
#include "core/film/film_exr.h"
#include "core/film/film_info.h"
#include "core/film/layout.h"

namespace hyades::core {

inline constexpr int kFilmFileVersion = 3;

/// Everything about a film but its sums.
struct FilmHeader {
  FilmInfo info;
  LayerSet layers;
  PixelRect window;
  Coverage coverage;
  std::array<std::map<uint32_t, std::string>, kIdKinds> names;  ///< of ids
};

/// A text of one fact per line, for the header of a file: readable with any EXR tool, and exact.
std::string write_film_header(const FilmFile& file);

/// Reads a text of write_film_header(). Strict: every line in its place, nothing else; window,
/// crop, size and coverage must fit each other. A newer version is named as such.
Result<FilmHeader> parse_film_header(std::string_view text);

/// Whether window, crop and frame fit into each other and none is empty.
Status check_film_frame(const FilmInfo& info, const PixelRect& window);

}  // namespace hyades::core
