#pragma once

#include <map>
#include <set>
#include <string>

namespace hyades::core {

/// Gives names that the job language accepts and that are all different: "Körper 1" becomes
/// "K_rper 1"; the second "Box" becomes "Box-2".
class GltfNames {
 public:
  /// `prefix` and a '.' will stand before them ("": nothing), of the 100 characters that a name
  /// may have.
  explicit GltfNames(const std::string& prefix = {}) : prefix_(prefix) {}

  /// A new name like `wanted`, or like `otherwise` where that is empty.
  std::string make(const std::string& wanted, const std::string& otherwise);

  /// `name` with the prefix before it.
  std::string full(const std::string& name) const {
    return prefix_.empty() ? name : prefix_ + "." + name;
  }

 private:
  std::string prefix_;
  std::set<std::string> taken_;
  std::map<std::string, int> next_;  ///< by name: the number to try next
};

/// `name` as a part of a file's name: letters, digits, '_', '-' and '.', at most 60 of them.
std::string file_name_of(const std::string& name, const std::string& otherwise);

}  // namespace hyades::core
