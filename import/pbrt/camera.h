#pragma once

#include "import/pbrt/context.h"

namespace hyades::core::pbrt {

struct FilmSize {
  int width = 1280;
  int height = 720;
};

/// The film's resolution as the scene says it, whatever it is.
FilmSize film_size(Context& context);

/// Puts `camera` into `out`.
void add_camera(Context& context, YamlMap& out);

}  // namespace hyades::core::pbrt
