#pragma once

#include <string>

#include "import/pbrt/textures.h"

namespace hyades::core::pbrt {

/// Makes one texture of the scene in the job language.
class TextureKinds {
 public:
  TextureKinds(Textures& textures, Context& context, const NamedEntity& entity, bool floats);

  /// Null, and an error of the report, where it cannot be made.
  YamlPtr make();

 private:
  YamlPtr bilerp();
  YamlPtr checkerboard();
  YamlPtr constant();
  YamlPtr direction_mix();
  YamlPtr dots();
  YamlPtr fbm();
  YamlPtr image();
  YamlPtr marble();
  YamlPtr mix();
  YamlPtr ptex();
  YamlPtr scale();
  YamlPtr windy();
  YamlPtr wrinkled();

  /// A parameter of this texture's own type, colours or numbers.
  YamlPtr value(const char* name, float otherwise);

  /// Adds `mapping`, and where they matter `scale` and `offset`, for flat textures.
  void put_plane_mapping(YamlMap& out);
  /// For textures in space.
  void put_space_mapping(YamlMap& out);
  Mat4d to_texture() const;  ///< from the job's world
  void note(const std::string& what);

  Textures& textures_;
  Context& context_;
  const NamedEntity& entity_;
  /// What pbrt takes for the number of a picture: alpha where some pixel is not opaque, else the
  /// mean of red, green and blue.
  enum class FloatOf { grey, mean, alpha };
  FloatOf float_of(const std::string& file) const;

  bool floats_;
  ParameterReader reader_;
};

}  // namespace hyades::core::pbrt
