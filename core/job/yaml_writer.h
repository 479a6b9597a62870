#pragma once

#include <string>

#include "core/job/yaml_tree.h"

namespace hyades::core {

/// The text of a tree, as a person would write it: sections and long maps by lines, what fits into
/// one line in braces. parse_yaml() reads the same tree from it (aliases written in full, places
/// and comments gone). `root` is a map.
std::string write_yaml(const YamlNode& root);

/// The root as write_yaml() does, with a mark (core/job/made_lines.h) before every entry of several
/// lines' maps and lists that comes from another line of a script than the one before it. `script`:
/// the file that stands in no mark.
std::string write_yaml_of_script(const YamlNode& root, const std::string& script);

}  // namespace hyades::core
