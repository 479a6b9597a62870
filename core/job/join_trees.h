#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "core/job/source.h"
#include "core/job/yaml_tree.h"

/// Joining the YAML of several files to one job.
namespace hyades::core {

/// Whether a job's section `key` is a map of names, of which several files may each bring some.
bool is_named_section(std::string_view key);

/// One section of several files. What adds a file costs no more than that file, however much there
/// is already.
class JoinedSection {
 public:
  explicit JoinedSection(const YamlNode& upper);

  /// Adds the keys of `lower`. A key in both is what it was where `overrides`, else a complaint
  /// that names both places.
  void add(const YamlNode& lower, bool overrides, Diagnostics& diagnostics);
  void add(const YamlEntry& entry);

  /// The entry called so; null where there is none. Until the next add().
  YamlEntry* find(const std::string& key);

  /// A map of all of it, which stays one with what is added later.
  const std::shared_ptr<YamlNode>& map() const { return map_; }

 private:
  std::shared_ptr<YamlNode> map_;
  std::map<std::string, size_t> places_;  ///< in the map, by key; see KeyIndex
};

/// Several files: sections that two of them have are joined.
class JoinedFiles {
 public:
  explicit JoinedFiles(const YamlNode& upper) : files_(upper) {}

  /// Adds the sections of `lower`. `overrides`: what is in both is what it was; otherwise they
  /// stand side by side and it is a complaint.
  void add(const YamlNode& lower, bool overrides, Diagnostics& diagnostics);

  YamlPtr map() const { return files_.map(); }

 private:
  JoinedSection files_;
  std::map<std::string, JoinedSection> sections_;  ///< that two files have
};

/// The job that two files make together, as JoinedFiles says.
YamlPtr join_files(const YamlNode& upper, const YamlNode& lower, bool overrides,
                   Diagnostics& diagnostics);

}  // namespace hyades::core
