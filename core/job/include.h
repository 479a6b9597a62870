#pragma once

#include <string>
#include <vector>

#include "core/base/assets.h"
#include "core/job/origins.h"
#include "core/job/source.h"
#include "core/job/yaml_tree.h"

namespace hyades::core {

/// A job's YAML with everything that it includes joined to one map.
struct JobTree {
  YamlPtr root;                       ///< null where a file could not be read at all
  std::vector<std::string> includes;  ///< relative to the job's folder, in order of reading
  Origins origins;                    ///< of what the map says
};

/// Reads `text` and the files that its `include:` names (a name or a list of names, relative to the
/// file that says so). A file's own keys win over those of the files it includes: sections such as
/// `camera` key by key, lists and plain values as a whole. Maps of names (textures, materials,
/// groups, objects, lights) are joined; the same name twice, or the same key in two files of one
/// list, is a complaint that names both places. `media: {file: ...}` brings media the same way, and
/// scene files of other tools (is_scene_file()) are read as the documents of scene_document.h, also
/// where an object is one (with_scene_objects()). A file that is reached twice counts once; cycles,
/// depth above 16, more than 256 files or 64 MiB are refused.
JobTree load_job_tree(const std::string& text, const std::string& file_name, AssetResolver& assets,
                      Diagnostics& diagnostics);

}  // namespace hyades::core
