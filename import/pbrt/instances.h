#pragma once

#include <string>

#include "import/pbrt/shapes.h"

namespace hyades::core::pbrt {

/// Puts the objects of a scene that are placed somewhere into `groups`, and their instances into
/// `objects`: one each, or, where many of one thing stand still, one with a file of places.
void add_instances(Context& context, Shapes& shapes, YamlMap& groups, YamlMap& objects);

/// The bytes of "places/NAME.ply": object-N, N being the number of the object.
Result<Bytes> make_places_file(const LoadedScene& scene, const std::string& name);

}  // namespace hyades::core::pbrt
