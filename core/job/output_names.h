#pragma once

#include <span>
#include <string>

namespace hyades::core {

/// The names of all layers that an EXR output may list.
std::span<const std::string> layer_names();

/// The names of all tone maps of PNG and JPEG outputs.
std::span<const std::string> tone_map_names();

}  // namespace hyades::core
