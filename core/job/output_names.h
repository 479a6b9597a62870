#pragma once

#include <span>
#include <string>
#include <vector>

namespace hyades::core {

/// The names of all layers that an EXR output may list.
std::span<const std::string> layer_names();

/// The layers of `all` that stand for several: "components" for those of all LightComponents.
std::vector<std::string> unfolded(const std::string& layer);

/// The endings of all files that outputs may be: ".exr", ".png", ..., videos' too.
std::span<const std::string> output_endings();

/// The names of all tone maps of PNG and JPEG outputs.
std::span<const std::string> tone_map_names();

/// What outputs may be denoised with, "true" being the best there is, and "false".
std::span<const std::string> denoise_names();

}  // namespace hyades::core
