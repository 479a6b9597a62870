#include "import/within_folder.h"

#include <algorithm>
#include <cstddef>

#include "core/base/assets.h"

namespace hyades::core {

Result<std::string> within_folder(const std::string& reference) {
  constexpr size_t kShown = 80;
  const auto refused = [&](const std::string& why) {
    const std::string cut = reference.size() > kShown ? "..." : "";
    return Error{"'" + reference.substr(0, kShown) + cut + "' " + why +
                 "; expected a file in the scene's folder or below it"};
  };
  if (reference.empty()) return Error{"the name of the file is empty"};
  if (std::any_of(reference.begin(), reference.end(),
                  [](unsigned char c) { return c < 32 || c == 127; })) {
    return Error{"the name of the file has control characters"};
  }
  const std::string folded = resolve_reference(reference);
  const size_t colon = folded.find(':');
  if (colon != std::string::npos && colon < folded.find('/')) return refused("is not a file");
  if (folded.front() == '/') return refused("is an absolute path");
  if (folded == ".." || folded.starts_with("../")) return refused("leads out of the folder");
  return folded;
}

}  // namespace hyades::core
