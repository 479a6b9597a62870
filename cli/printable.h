#pragma once

#include <string>

namespace hyades::cli {

/// Text with control characters (which could steer the terminal) replaced by '?'.
inline std::string printable(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 32 || c == 127) c = '?';
  }
  return text;
}

}  // namespace hyades::cli
