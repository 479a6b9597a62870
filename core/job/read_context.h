#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/base/assets.h"
#include "core/job/fields.h"
#include "core/job/job.h"
#include "core/job/key_listing.h"
#include "core/job/origins.h"
#include "core/job/source.h"
#include "core/job/yaml_tree.h"

namespace hyades::core {

/// A name that was used somewhere and must exist.
struct NameUse {
  NameKind kind = NameKind::texture;
  std::string name;
  SourceLocation where;
  std::string label;  ///< "color of material 'floor'"
};

/// A file that was named somewhere and must open.
struct FileUse {
  std::string reference;  ///< relative to the job's folder
  SourceLocation where;
  std::string label;
  std::optional<FrameFiles> per_frame{};  ///< where there may be one for each (is_file_sequence)
  std::string script{};  ///< that names it, and may not name every file; empty: the job does
};

/// A file that the job writes.
struct OutputPlace {
  std::string file;
  SourceLocation where;
};

/// What all readers of one job share.
struct ReadContext {
  ReadContext(Job& target, Diagnostics& complaints) : job(target), diagnostics(complaints) {}

  Job& job;
  Diagnostics& diagnostics;
  /// Every name that the job gives, by NameKind; those of entries with mistakes too, so that one
  /// mistake is one complaint. Objects: those of the top level.
  std::array<std::vector<std::string>, 5> given;
  std::vector<NameUse> names;
  std::vector<FileUse> files;
  float exposure = 0.0F;    ///< stops that the camera's exposure adds to every output's
  bool in_shutter = false;  ///< what is read now counts all the while the shutter is open
  Origins origins;          ///< of what the job says
  std::map<std::string, YamlPtr> materials;  ///< as written, `like` followed; for overrides
  /// Those of light_groups_of(job), once somebody has asked for them (check_layer).
  std::optional<std::vector<std::string>> light_groups;
  /// What the job writes so far, by place_of_output(); no place is another's folder.
  std::map<std::string, OutputPlace> output_places;
  bool files_missing = false;     ///< files that names may stand in could not be read
  KeyListing* listing = nullptr;  ///< set: only collect which keys the readers know

  /// Adds a complaint, once (a node that `like:` or an alias shares is read several times).
  void complain(const SourceLocation& where, const std::string& message);

  /// Counts `nodes` against the budget of one job (`like:` and aliases multiply what a short text
  /// makes us read). False, after one complaint, once it is spent.
  bool spend(uint64_t nodes, const SourceLocation& where);

  /// `reference` as written at `where`, made relative to the job's folder.
  std::string job_relative(const std::string& reference, const SourceLocation& where) const;

 private:
  std::set<std::string> complaints_;
  uint64_t spent_ = 0;
  bool exhausted_ = false;
};

}  // namespace hyades::core
