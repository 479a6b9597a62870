#pragma once

#include <string>

#include "core/base/result.h"
#include "core/film/film.h"

namespace hyades::core {

/// What decides whether two machines give a unit the same bits. Measured where it can be, named
/// where it cannot.
struct ClassProbe {
  std::string film;        ///< hex digest of the probe scene's film
  std::string elementary;  ///< hex digest of elementary functions over a sweep of arguments
  /// Hex digest of the processor's approximate 1/x and 1/sqrt(x), which vendors tabulate
  /// differently and from which Embree starts its divisions.
  std::string reciprocals;
  std::string build;   ///< build_id() of this program
  std::string embree;  ///< version of the library that is loaded, and the ISA it is pinned to
};

/// Hex SHA-256 over what the renderer was made of: the sources of core/, the compiler, its flags.
/// Equal in all programs of one build, and in builds of the same sources by the same compiler.
std::string build_id();

/// A film of the built-in probe scene: a mesh that stands, one that moves (an instance), coplanar
/// duplicates, quadrics, glass, metal, noise in space and time, bump, an image, a sky, a lamp, a
/// lens, motion blur. About 100,000 rays, some 0.1 s of one core. The same for any `threads` >= 1.
/// Errors: Embree does not run here.
Result<Film> render_class_probe(int threads = 1);

/// Renders the probe and names the rest.
Result<ClassProbe> probe_class(int threads = 1);

/// The class: hex SHA-256 over the probe's fields. Workers whose classes are equal may render units
/// of one frame.
std::string class_of(const ClassProbe& probe);

/// The class of this machine and program, measured at the first call (about 0.1 s). Thread-safe.
Result<std::string> this_class();

}  // namespace hyades::core
