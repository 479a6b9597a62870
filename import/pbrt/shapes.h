#pragma once

#include <string>
#include <vector>

#include "import/pbrt/materials.h"
#include "import/pbrt/media.h"

namespace hyades::core::pbrt {

/// Turns shapes into objects of a job.
class Shapes {
 public:
  Shapes(Context& context, Materials& materials, Textures& textures, Media& media);

  /// Those of one list (the scene's, or an object's), as a map of names to objects. `made` stands
  /// before the numbers of the meshes that are made of them.
  YamlPtr objects(const std::vector<ShapeEntity>& shapes, const std::string& made, bool in_group);

 private:
  /// Whether mesh_of() makes it, and may; an error of the report where not.
  bool can_be_made(const ShapeEntity& shape);
  /// The object without its material, or null. `before` becomes what its own shape is moved by.
  YamlPtr geometry(const ShapeEntity& shape, const std::string& file, bool sided, Mat4d& before,
                   std::string& wish);

  Context& context_;
  Materials& materials_;
  Textures& textures_;
  Media& media_;
};

/// Puts `groups` and `objects` into `out`.
void add_objects(Context& context, Textures& textures, YamlMap& out);

}  // namespace hyades::core::pbrt
