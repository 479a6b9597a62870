#include <string>

#include "core/image/write_image.h"

namespace hyades::core {

std::string metadata_lines(const ImageMetadata& metadata) {
  std::string lines;
  for (const auto& [name, value] : metadata) lines += name + ": " + value + "\n";
  if (!lines.empty()) lines.pop_back();
  return lines;
}

}  // namespace hyades::core
