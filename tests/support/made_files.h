#pragma once

#include <string>
#include <vector>

#include "core/job/yaml_tree.h"

namespace hyades::test {

/// The files that the objects of an imported scene name, meshes and places; of those with a number
/// of the frame in their names that of frame 2.
inline std::vector<std::string> made_files_of(const core::YamlNode& objects) {
  std::vector<std::string> names;
  for (const core::YamlEntry& object : objects.map) {
    for (const char* key : {"mesh", "places"}) {
      const core::YamlEntry* file = object.value->find(key);
      if (file == nullptr) continue;
      std::string name = file->value->scalar;
      const size_t at = name.find("####");
      if (at != std::string::npos) name.replace(at, 4, "0002");
      names.push_back(std::move(name));
    }
  }
  return names;
}

}  // namespace hyades::test
