#pragma once

#include <string>

#include "core/job/job.h"

namespace CLI {
class App;
}

namespace hyades::cli {

/// What a command line says of a film's size.
struct FilmSizeOption {
  std::string size;    ///< "640x360", pixels; empty: the job's
  double scale = 0.0;  ///< of the job's size, 0.001 to 100; 0: none was asked for
};

/// Options --size and --scale, of which one may be given.
void declare_film_size(CLI::App& app, FilmSizeOption& option);

/// Makes `film` of that size; what of it is rendered (its crop) stays the same part.
void resize_film(const FilmSizeOption& option, core::FilmDesc& film);

}  // namespace hyades::cli
