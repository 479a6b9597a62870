#pragma once

#include <string>
#include <vector>

#include "cli/media_facts.h"

namespace hyades::cli {

/// A unit of length that numbers are shown in.
struct LengthUnit {
  std::string name = "m";
  float metres = 1.0F;
};

/// One line each: colour of a thick body, mean free path, albedo, source.
std::string media_table(const std::vector<KnownMedium>& media);

/// All that is known of one, for people.
std::string medium_sheet(const KnownMedium& medium, const LengthUnit& unit);

/// All that is known of each, as a JSON list for programs.
std::string media_json(const std::vector<KnownMedium>& media, const LengthUnit& unit);

/// A file of media that jobs of that unit read: JSON of the simple kind, or YAML.
std::string media_file_json(const KnownMedium& medium, const LengthUnit& unit);
std::string media_file_yaml(const KnownMedium& medium, const LengthUnit& unit);

}  // namespace hyades::cli
