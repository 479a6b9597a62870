#include "import/pbrt/place.h"

namespace hyades::core::pbrt {

std::string Place::text() const {
  if (file == nullptr) return {};
  return *file + ":" + std::to_string(line) + ":" + std::to_string(column);
}

Error Place::error(const std::string& what) const {
  return {file == nullptr ? what : text() + ": " + what};
}

void Report::note(const Place& place, const std::string& what) {
  if (notes.size() < kMostNotes) {
    notes.push_back(place.error(what).message);
  } else if (notes.size() == kMostNotes) {
    notes.emplace_back("more notes are left out");
  }
}

void Report::error(const Place& place, const std::string& what) {
  if (errors.size() < kMostErrors) errors.push_back(place.error(what).message);
}

}  // namespace hyades::core::pbrt
