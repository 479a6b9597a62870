#pragma once

#include <cstdint>
#include <string>

namespace hyades::coordinator {

/// "1 unit", "2 units"; of words whose plural ends with s.
inline std::string counted(uint64_t count, const std::string& word) {
  return std::to_string(count) + " " + word + (count == 1 ? "" : "s");
}

}  // namespace hyades::coordinator
