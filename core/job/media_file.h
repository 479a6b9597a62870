#pragma once

#include <string>
#include <string_view>

#include "core/job/yaml_tree.h"

/// Files of media: what `media: {file: media.json}` names.
namespace hyades::core {

/// Reads such a file as the value of a job's `media`: a map of names. It holds one medium, a list
/// of them ({"name": ..., "absorption": [r, g, b], "scattering": [r, g, b], "g": ..., "index":
/// ...}, as media renderers have it), or a job's `media` section, alone or as a whole job's. JSON
/// or YAML; `sigma_a`, `sigma_s` and `ior` mean absorption, scattering and index. Null, after a
/// complaint, where it is none of these; what the media hold is for the job's reader to judge.
YamlPtr read_media_file(std::string_view text, const std::string& file, Diagnostics& diagnostics);

}  // namespace hyades::core
