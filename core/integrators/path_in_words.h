#pragma once

#include <string>

#include "core/integrators/integrator.h"
#include "core/integrators/path_vertex.h"

namespace hyades::core {

/// "(1, 2.5, -3)".
std::string in_words(const Vec3& v);

/// Tells the vertices of `path`, which is called `name`: one line each.
void tell_subpath(const Scene& scene, const Subpath& path, const std::string& name, PathLog& log);

}  // namespace hyades::core
