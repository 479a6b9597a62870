#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/assets.h"
#include "core/image/read_image.h"

namespace hyades::core {
namespace {

constexpr std::string_view kSignature = "\x89PNG\r\n\x1a\n";
constexpr size_t kAroundData = 12;  ///< of a chunk: length, type, checksum

uint32_t big_endian(std::string_view bytes) {
  uint32_t value = 0;
  for (const char byte : bytes.substr(0, 4)) value = value << 8U | static_cast<uint8_t>(byte);
  return value;
}

/// PNG specification, third edition, 11.3.3: keyword, 0, text; or keyword, 0, compressed?, method,
/// language, 0, translated keyword, 0, text.
std::string text_of(std::string_view type, std::string_view data) {
  if (type == "tEXt") return std::string(data);
  if (data.size() < 2 || data[0] != 0) return "";
  data.remove_prefix(2);
  for (int i = 0; i < 2; ++i) {
    const size_t end = data.find('\0');
    if (end == std::string_view::npos) return "";
    data.remove_prefix(end + 1);
  }
  return std::string(data);
}

}  // namespace

Result<std::vector<std::pair<std::string, std::string>>> read_png_texts(const std::string& path) {
  const auto file = map_file(path);
  if (!file) return file.error().in(path);
  std::string_view bytes(file->chars(), file->size());
  if (!bytes.starts_with(kSignature)) return Error{path + ": not a PNG file"};
  bytes.remove_prefix(kSignature.size());
  std::vector<std::pair<std::string, std::string>> texts;
  while (bytes.size() >= kAroundData) {
    const size_t length = big_endian(bytes);
    const std::string_view type = bytes.substr(4, 4);
    if (type == "IDAT" || length > bytes.size() - kAroundData) break;
    const std::string_view data = bytes.substr(8, length);
    const size_t end = data.find('\0');
    if ((type == "tEXt" || type == "iTXt") && end != std::string_view::npos) {
      texts.emplace_back(data.substr(0, end), text_of(type, data.substr(end + 1)));
    }
    bytes.remove_prefix(length + kAroundData);
  }
  return texts;
}

}  // namespace hyades::core
