#include "import/gltf/uri.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/base/text.h"
#include "import/within_folder.h"

namespace hyades::core {

namespace {

constexpr std::string_view kAlphabet =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

std::array<int, 256> make_values() {
  std::array<int, 256> values{};
  values.fill(-1);
  for (size_t i = 0; i < kAlphabet.size(); ++i) {
    values[static_cast<unsigned char>(kAlphabet[i])] = static_cast<int>(i);
  }
  return values;
}

std::string shown(std::string_view uri) {
  return std::string(uri.substr(0, 80)) + (uri.size() > 80 ? "..." : "");
}

}  // namespace

bool is_data_uri(std::string_view uri) { return uri.starts_with("data:"); }

std::string data_uri_type(std::string_view uri) {
  uri.remove_prefix(5);
  return std::string(uri.substr(0, std::min(uri.find_first_of(";,"), uri.size())));
}

Result<Bytes> decode_data_uri(std::string_view uri) {
  static const std::array<int, 256> kValues = make_values();
  const size_t comma = uri.find(',');
  if (comma == std::string_view::npos || !uri.substr(0, comma).ends_with(";base64")) {
    return Error{"a data: URI is not in base64: '" + shown(uri) + "'"};
  }
  std::string_view text = uri.substr(comma + 1);
  while (text.ends_with('=')) text.remove_suffix(1);
  auto bytes = std::make_shared<std::vector<std::byte>>();
  bytes->reserve(text.size() / 4 * 3 + 3);
  uint32_t held = 0;
  int bits = 0;
  for (const char c : text) {
    const int value = kValues[static_cast<unsigned char>(c)];
    if (value < 0) return Error{"a data: URI has characters that are not base64"};
    held = (held << 6U) | static_cast<uint32_t>(value);
    bits += 6;
    if (bits >= 8) {
      bits -= 8;
      bytes->push_back(static_cast<std::byte>((held >> static_cast<unsigned>(bits)) & 0xFFU));
    }
  }
  return Bytes(bytes, *bytes);
}

Result<std::string> decode_file_uri(std::string_view uri) {
  std::string path = percent_decoded(uri).value_or(std::string(uri));
  std::replace(path.begin(), path.end(), '\\', '/');
  return within_folder(path);
}

}  // namespace hyades::core
