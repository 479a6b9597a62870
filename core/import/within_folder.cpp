#include "core/import/within_folder.h"

#include "core/base/assets.h"

namespace hyades::core {

Status within_folder(const std::string& reference) {
  const std::string folded = resolve_reference(reference);
  const bool drive = folded.size() > 1 && folded[1] == ':';
  const bool out = folded == ".." || folded.starts_with("../") || folded.starts_with('/') || drive;
  if (!out) return {};
  return Error{"'" + reference.substr(0, 200) +
               "' lies outside of the scene's folder; expected a file in it or below it"};
}

}  // namespace hyades::core
