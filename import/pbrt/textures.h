#pragma once

#include <map>
#include <optional>
#include <string>
#include <unordered_map>

#include "import/pbrt/context.h"

namespace hyades::core::pbrt {

/// Puts the textures that something uses into Context::textures, each once.
class Textures {
 public:
  explicit Textures(Context& context);

  /// The value of parameter `name`, a colour or the name of a texture.
  YamlPtr color(ParameterReader& reader, const char* name, const Rgb& otherwise);
  /// The value of parameter `name`, a colour or the name of a texture; null where it is not there.
  YamlPtr color_if(ParameterReader& reader, const char* name);

  /// A number or the name of a texture.
  YamlPtr number(ParameterReader& reader, const char* name, float otherwise);
  YamlPtr number_if(ParameterReader& reader, const char* name);

  /// A texture of numbers as a height: a texture and the factor before it, which may be below 0.
  struct Height {
    YamlPtr texture;
    float factor = 1.0F;
  };
  Height height(const std::string& texture, const Place& place);

  /// The job's name of a texture of the scene; empty, and an error, where there is none.
  std::string named(bool floats, const std::string& name, const Place& place);

 private:
  friend class TextureKinds;
  struct Made {
    enum class State { making, failed, done };
    State state = State::making;
    std::string name;  ///< the job's, where it is done
  };
  const NamedEntity* find(bool floats, const std::string& name) const;
  YamlPtr make(bool floats, const NamedEntity& entity);

  Context& context_;
  std::map<std::string, const NamedEntity*> float_textures_, spectrum_textures_;
  std::unordered_map<const NamedEntity*, Made> made_;
  int depth_ = 0;  ///< how many that are made of each other are being made
};

/// Whether a node is a plain number, and which.
std::optional<float> plain_number(const YamlPtr& node);

}  // namespace hyades::core::pbrt
