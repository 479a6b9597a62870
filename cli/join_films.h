#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/film/film_exr.h"

namespace hyades::cli {

/// Reads film EXRs and joins them into one; `paths` is not empty. The error names the film that
/// cannot be read, or the two that do not fit each other and why.
/// `fits` says first whether a film is of the picture that is wanted.
core::Result<core::FilmFile> join_films(
    const std::vector<std::string>& paths,
    const std::function<core::Status(const core::FilmInfo&)>& fits = {});

/// "62.5 % of 256 samples per pixel"; only a whole film has 100 %. Where tiles have samples enough
/// at some noise: "57.3 of at most 256 samples per pixel".
std::string share_held(const core::FilmFile& file);

/// What is missing of a film, in words; empty where it is whole. Where tiles have samples enough at
/// some noise: the tiles that have not.
std::string what_is_missing(const core::FilmFile& file);

}  // namespace hyades::cli
