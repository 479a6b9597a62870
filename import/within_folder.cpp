#include "import/within_folder.h"

#include <cstddef>

#include "core/base/assets.h"
#include "core/base/printable.h"

namespace hyades::core {

Result<std::string> within_folder(const std::string& reference) {
  constexpr size_t kShown = 80;
  const auto refused = [&](const std::string& why) {
    const std::string cut = reference.size() > kShown ? "..." : "";
    return Error{"'" + reference.substr(0, kShown) + cut + "' " + why +
                 "; expected a file in the scene's folder or below it"};
  };
  if (reference.empty()) return Error{"the name of the file is empty"};
  if (!is_printable(reference)) {
    return Error{"the name of the file has characters that cannot be seen"};
  }
  const std::string folded = resolve_reference(reference);
  const size_t colon = folded.find(':');
  if (colon != std::string::npos && colon < folded.find('/')) return refused("is not a file");
  if (folded.front() == '/') return refused("is an absolute path");
  if (folded == ".." || folded.starts_with("../")) return refused("leads out of the folder");
  return folded;
}

}  // namespace hyades::core
