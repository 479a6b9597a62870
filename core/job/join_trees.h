#pragma once

#include <string_view>

#include "core/job/source.h"
#include "core/job/yaml_tree.h"

/// Joining the YAML of several files to one job.
namespace hyades::core {

/// Whether a job's section `key` is a map of names, of which several files may each bring some.
bool is_named_section(std::string_view key);

/// One section of two files: `upper` with the keys of `lower` added. A key in both is upper's where
/// `overrides`, else a complaint that names both places.
YamlPtr join_section(const YamlNode& upper, const YamlNode& lower, bool overrides,
                     Diagnostics& diagnostics);

/// Two files: `upper` with the sections of `lower` added, those in both joined. `overrides`: what
/// is in both is upper's; otherwise they stand side by side and it is a complaint.
YamlPtr join_files(const YamlNode& upper, const YamlNode& lower, bool overrides,
                   Diagnostics& diagnostics);

}  // namespace hyades::core
