#pragma once

#include <map>
#include <set>
#include <string>

namespace hyades::core {

/// A name for files and folders out of any text: what is not a letter, a digit or one of _-.
/// becomes '_', and it begins with a letter, a digit or '_', so that it can neither hide nor lead
/// out of a folder. `otherwise` where nothing is left. At most 60 characters.
std::string safe_name(const std::string& text, const std::string& otherwise);

/// Names of one kind that the job language takes, each different from the others: "Körper 1"
/// becomes "K_rper 1", the second "Box" becomes "Box-2". A thousand boxes take linear time.
class Names {
 public:
  /// `kind`: what something without a name is called. `prefix` and a '.' stand before all names
  /// where it is not empty.
  explicit Names(std::string kind, std::string prefix = {});

  /// A new name, the prefix before it, as near to `wanted` as can be: letters, digits, '_', '-',
  /// '.' and inner spaces, the others '_'; never one that reads as a number or colour.
  std::string add(const std::string& wanted);

 private:
  std::string kind_;
  std::string prefix_;  ///< with its '.'
  std::set<std::string> taken_;
  std::map<std::string, int> next_;  ///< by name: the number to try next
};

}  // namespace hyades::core
