#pragma once

#include <cstdint>
#include <string>

#include "core/base/bytes.h"
#include "core/base/result.h"
#include "core/film/film.h"
#include "core/film/film_info.h"
#include "core/image/write_image.h"

namespace hyades::core {

/// A film and what it belongs to.
struct FilmFile {
  FilmInfo info;
  Film film;
};

/// Writes a two-part EXR: part "picture", the normalised float picture that any viewer opens, and
/// part "sums", the exact sums as unsigned-integer channels, with coverage and FilmInfo as
/// attributes. docs/film.md describes the format (version 1). Complete or absent. `extra` goes into
/// the header.
Status write_film_exr(const std::string& path, const FilmFile& file,
                      const ImageMetadata& extra = {});

/// Reads it back, bit for bit. Truncated, foreign, newer-version and inconsistent files are refused
/// with a reason; memory stays bounded by what the file really holds.
Result<FilmFile> read_film_exr(const std::string& path);

/// Reads a film file from its bytes, as read_film_exr(path) does; `name` is used in errors only.
Result<FilmFile> read_film_exr(const Bytes& bytes, const std::string& name);

/// The memory [bytes] that read_film_exr(bytes, name) takes for the film, but for ids of objects
/// and materials; errors as there, as far as the header tells.
Result<uint64_t> film_exr_memory(const Bytes& bytes, const std::string& name);

/// What a film file belongs to, without its pixels, which are not looked at.
Result<FilmInfo> read_film_info(const std::string& path);

/// Joins `from` into `into`. Refused with a reason where render key, frame, size, crop, samples or
/// class differ or batches overlap; nothing is changed then.
Status merge_film_files(FilmFile& into, const FilmFile& from);

}  // namespace hyades::core
