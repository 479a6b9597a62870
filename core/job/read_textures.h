#pragma once

#include <string>
#include <string_view>

#include "core/job/map_reader.h"

namespace hyades::core {

/// Reads one texture, of any type, named `name`, into the job's list. Textures written in place
/// come before the texture that uses them.
void read_texture(MapReader& reader, const std::string& name);

/// Where the value of `key` is the name of a texture or a texture written in place: sets `texture`
/// to its name and returns true. False where it is a plain value.
bool read_texture_input(MapReader& reader, std::string_view key, const YamlNode& node,
                        std::string& texture);

}  // namespace hyades::core
