#pragma once

#include <memory>
#include <string>

#include "core/job/yaml_writer.h"
#include "import/scene_source.h"
#include "tests/support/made_files.h"

namespace hyades::fuzz {

/// Opens every file that objects name: their meshes and places.
inline void make_files_of(const core::SceneSource& source, const core::YamlNode& objects) {
  for (const std::string& name : test::made_files_of(objects)) (void)source.made_file(name);
}

/// Reads the scene `reference` of `files`, says it as a job and makes its files; whether it is one.
inline bool try_scene(core::AssetResolver& files, const std::string& reference) {
  const auto source = core::read_scene(files, reference);
  if (!source) return false;
  core::SceneRequest request;
  request.loop = true;
  const auto said = (*source)->sections(request);
  if (!said) return false;
  (void)core::write_yaml(*said->sections);
  if (const core::YamlEntry* groups = said->sections->find("groups")) {
    for (const core::YamlEntry& group : groups->value->map) {
      if (const core::YamlEntry* objects = group.value->find("objects")) {
        make_files_of(**source, *objects->value);
      }
    }
  }
  if (const core::YamlEntry* objects = said->sections->find("objects")) {
    make_files_of(**source, *objects->value);
  }
  return true;
}

}  // namespace hyades::fuzz
