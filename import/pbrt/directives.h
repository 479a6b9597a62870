#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "import/pbrt/graphics_state.h"
#include "import/pbrt/read_parameters.h"
#include "import/pbrt/tokenizer.h"

namespace hyades::core::pbrt {

/// Who reads the files of Include and Import.
class Includer {
 public:
  virtual ~Includer() = default;
  virtual Status include(const std::string& reference, const Place& place) = 0;
};

/// Obeys the directives of scene files and collects the scene that they describe.
class Directives {
 public:
  Directives(ParsedScene& scene, Includer& includer);

  /// Reads to the end of a file.
  Status read(Tokenizer& tokens);

  /// After the last file: whether all that was begun has ended.
  Status finish() const;

 private:
  using Handler = Status (Directives::*)();
  static const std::unordered_map<std::string_view, Handler>& handlers();

  // Words of the file.
  Status unexpected(const Token& token, const std::string& expected) const;
  Status take_text(std::string& out, const std::string& what);
  Status take_numbers(double* out, size_t count);
  Status take_entity(Entity& out, const std::string& what);
  Error error(const std::string& what) const { return place_.error(what); }

  // What is allowed where.
  Status only_before_world() const;
  Status only_in_world() const;

  // Handlers, by what they are about: directives.cpp and transform_directives.cpp.
  Status accelerator();
  Status active_transform();
  Status area_light_source();
  Status attribute();
  Status attribute_begin();
  Status attribute_end();
  Status camera();
  Status color_space();
  Status concat_transform();
  Status coord_sys_transform();
  Status coordinate_system();
  Status film();
  Status identity();
  Status import();
  Status include();
  Status integrator();
  Status light_source();
  Status look_at_directive();
  Status make_named_material();
  Status make_named_medium();
  Status material();
  Status medium_interface();
  Status named_material();
  Status object_begin();
  Status object_end();
  Status object_instance();
  Status option();
  Status pixel_filter();
  Status reverse_orientation();
  Status rotate();
  Status sampler();
  Status scale();
  Status shape();
  Status texture();
  Status transform();
  Status transform_times();
  Status translate();
  Status world_begin();

  /// Another instance of an object that has many which do not move.
  Status one_of_many(ObjectDefinition& object);
  Status render_entity(Entity& out, const std::string& what);
  Status multiply(const Mat4d& m);
  Status set(const Mat4d& m);
  Status push(char kind);
  Status pop(char kind, const std::string& what);

  struct Pushed {
    GraphicsState state;
    char kind = 'a';  ///< 'a': AttributeBegin, 'o': ObjectBegin
    Place place;
  };

  ParsedScene& scene_;
  Includer& includer_;
  Tokenizer* tokens_ = nullptr;
  Place place_;  ///< of the directive that is being obeyed
  GraphicsState state_;
  std::vector<Pushed> pushed_;
  bool in_world_ = false;
  int object_ = -1;    ///< index of the object that is being defined
  size_t copies_ = 0;  ///< of all objects
  std::map<std::string, Motion> coordinate_systems_;
  std::map<std::string, size_t> objects_;
  std::map<std::string, Place> float_textures_, spectrum_textures_, materials_, media_;
};

}  // namespace hyades::core::pbrt
