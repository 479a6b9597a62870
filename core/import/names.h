#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

namespace hyades::core {

/// A name for objects, materials, files and folders out of any text: what is not a letter, a digit
/// or one of _-. becomes '-', and it begins with a letter or digit, so that it can neither hide nor
/// lead out of a folder. `otherwise` where nothing is left. At most 60 characters.
std::string safe_name(const std::string& text, const std::string& otherwise);

/// Names of one kind, each different from the others.
class Names {
 public:
  /// Of all names, `prefix` and a '.' stand before them where it is not empty.
  explicit Names(std::string prefix = {}) : prefix_(std::move(prefix)) {}

  /// safe_name() of `text`, behind the prefix, and a number where another has it already. Never a
  /// name that reads as a number or colour.
  std::string add(const std::string& text, const std::string& otherwise);

 private:
  std::string prefix_;
  std::set<std::string> taken_;
  std::map<std::string, int> last_;  ///< number that a name was last told apart by
};

}  // namespace hyades::core
