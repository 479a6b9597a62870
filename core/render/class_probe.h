#pragma once

#include <string>

#include "core/base/render_class.h"
#include "core/base/result.h"
#include "core/film/film.h"

namespace hyades::core {

/// What decides whether two machines give a unit the same bits. Measured where it can be, named
/// where it cannot.
struct ClassProbe {
  RenderClass of = RenderClass::native;
  std::string film;        ///< hex digest of the probe scene's film
  std::string elementary;  ///< hex digest of elementary functions over a sweep of arguments
  std::string build;       ///< build_id() of this program; where portable, sources_id()
  /// Hex digest of the processor's approximate 1/x and 1/sqrt(x), which vendors tabulate
  /// differently and from which Embree starts its divisions. Empty where portable.
  std::string reciprocals;
  /// Version of the library that is loaded, and the ISA it is pinned to. Empty where portable.
  std::string embree;
};

/// Hex SHA-256 over what the renderer was made of: the sources of core/, the compiler, its flags.
/// Equal in all programs of one build, and in builds of the same sources by the same compiler.
std::string build_id();

/// Hex SHA-256 over the sources of core/ alone: equal in builds by any compiler.
std::string sources_id();

/// A film of the built-in probe scene: a mesh that stands, one that moves (an instance), coplanar
/// duplicates, quadrics, copies by a file, strands, glass with a medium in it, skin, smoke, metal,
/// noise in space and time, bump, an image, a sky, a lamp, a lens, motion blur. About 90,000 rays,
/// some 0.2 s of one core. The same for any `threads` >= 1.
/// Errors: native, and Embree does not run here.
Result<Film> render_class_probe(RenderClass which, int threads = 1);

/// Renders the probe and names the rest.
Result<ClassProbe> probe_class(RenderClass which, int threads = 1);

/// The class: hex SHA-256 over the probe's fields. Workers whose classes are equal may render units
/// of one frame.
std::string class_of(const ClassProbe& probe);

/// The class of this machine and program, measured at the first call (about 0.2 s). Thread-safe.
Result<std::string> this_class(RenderClass which);

}  // namespace hyades::core
