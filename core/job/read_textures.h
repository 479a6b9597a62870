#pragma once

#include <string>
#include <string_view>

#include "core/job/map_reader.h"

namespace hyades::core {

/// Reads one texture, of any type, named `name`, into the job's list. Textures written in place
/// come before the texture that uses them.
void read_texture(ReadContext& context, const YamlNode& node, const std::string& name,
                  const std::string& what, const std::string& path);

/// Where the value of `key` is the name of a texture or a texture written in place: sets `texture`
/// to its name and returns true. False where it is a plain value.
bool read_texture_input(MapReader& reader, std::string_view key, const YamlNode& node,
                        std::string& texture);

/// Reads the map under `key`, which is about a texture that it must name, and the rest of it with
/// read_rest(reader of the map).
template <class Read>
void read_texture_map(MapReader& reader, const char* key, const char* section, std::string& texture,
                      const Read& read_rest) {
  reader.map(key, section, [&](MapReader& map) {
    const char* const expected = "a texture's name or a texture";
    map.require("texture", expected);
    const YamlNode* node = map.find("texture");
    if (node != nullptr && !read_texture_input(map, "texture", *node, texture)) {
      map.mismatch("texture", *node, expected);
    }
    read_rest(map);
  });
}

}  // namespace hyades::core
