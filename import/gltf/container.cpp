#include "import/gltf/container.h"

#include <fmt/format.h>

#include <cstdint>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "import/gltf/uri.h"

namespace hyades::core {

namespace {

constexpr uint32_t kMagic = 0x46546C67;   // "glTF"
constexpr uint32_t kJson = 0x4E4F534A;    // "JSON"
constexpr uint32_t kBinary = 0x004E4942;  // "BIN\0"

uint32_t word_at(const Bytes& bytes, size_t offset) {
  uint32_t word = 0;
  std::memcpy(&word, bytes.chars() + offset, sizeof word);
  return word;
}

Bytes part_of(const Bytes& whole, size_t offset, size_t size) {
  return {std::make_shared<Bytes>(whole), whole.span().subspan(offset, size)};
}

/// Whether brackets lie deeper than kMaxGltfDepth, outside of texts.
bool too_deep(std::string_view json) {
  int depth = 0;
  bool in_text = false;
  for (size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (in_text) {
      if (c == '\\') ++i;
      if (c == '"') in_text = false;
    } else if (c == '"') {
      in_text = true;
    } else if (c == '{' || c == '[') {
      if (++depth > kMaxGltfDepth) return true;
    } else if (c == '}' || c == ']') {
      --depth;
    }
  }
  return false;
}

Result<std::shared_ptr<const nlohmann::json>> parse(std::string_view text) {
  if (text.size() > kMaxGltfJson) {
    return Error{
        fmt::format("its JSON has {} bytes; at most {} are possible", text.size(), kMaxGltfJson)};
  }
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  const size_t first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos || (text[first] != '{' && text[first] != '[')) {
    return Error{"it is no glTF file: expected 'glTF' (binary) or '{' (JSON) where it begins"};
  }
  if (too_deep(text)) {
    return Error{fmt::format("its JSON is more than {} levels deep", kMaxGltfDepth)};
  }
  try {
    return std::make_shared<const nlohmann::json>(nlohmann::json::parse(text));
  } catch (const nlohmann::json::exception& e) {
    const std::string_view what = e.what();
    const size_t after = what.find("] ");
    return Error{"it is not valid JSON: " +
                 std::string(after == std::string_view::npos ? what : what.substr(after + 2))};
  }
}

}  // namespace

Result<GltfContainer> open_container(const Bytes& file) {
  GltfContainer out;
  if (file.size() < 4 || word_at(file, 0) != kMagic) {
    auto json = parse({file.chars(), file.size()});
    if (!json) return json.error();
    out.json = *json;
    return out;
  }
  if (file.size() < 20) return Error{"the file ends within its header"};
  if (word_at(file, 4) != 2) {
    return Error{fmt::format("it is glTF of version {}, expected 2", word_at(file, 4))};
  }
  const size_t length = word_at(file, 8);
  if (length > file.size()) {
    return Error{
        fmt::format("the file ends too early: it has {} of {} bytes", file.size(), length)};
  }
  size_t at = 12;
  for (int chunk = 0; at + 8 <= length; ++chunk) {
    const size_t size = word_at(file, at);
    const uint32_t kind = word_at(file, at + 4);
    at += 8;
    if (size > length - at) {
      return Error{
          fmt::format("chunk {} has {} bytes, but only {} are left", chunk, size, length - at)};
    }
    if (chunk == 0) {
      if (kind != kJson) return Error{"its first chunk is not JSON"};
      auto json = parse({file.chars() + at, size});
      if (!json) return json.error();
      out.json = *json;
    } else if (kind == kBinary && !out.has_binary) {
      out.binary = part_of(file, at, size);
      out.has_binary = true;
    }
    at += size + (4 - size % 4) % 4;
  }
  if (!out.json) return Error{"it has no JSON"};
  return out;
}

Result<std::vector<Bytes>> read_buffers(const GltfContainer& container, const JsonValue& root,
                                        AssetResolver& files, const std::string& reference) {
  std::vector<Bytes> buffers;
  std::map<std::string, Bytes> known;  // of several that name one file
  for (const JsonValue& buffer : root.list("buffers")) {
    const auto length =
        static_cast<size_t>(buffer.required_integer("byteLength", 0, int64_t{1} << 46));
    const std::string uri = buffer.text("uri");
    const JsonValue extensions = buffer.member("extensions");
    const bool stand_in = extensions.member("EXT_meshopt_compression").flag("fallback", false) ||
                          extensions.member("KHR_meshopt_compression").flag("fallback", false);
    Bytes bytes;
    if (is_data_uri(uri)) {
      auto decoded = decode_data_uri(uri);
      if (!decoded) return decoded.error().in(buffer.place());
      bytes = *decoded;
    } else if (!uri.empty() && !stand_in) {
      const auto path = decode_file_uri(uri);
      if (!path) return path.error().in(buffer.place());
      const auto found = known.find(*path);
      if (found != known.end()) {
        bytes = found->second;
      } else {
        auto opened = files.open(*path, reference);
        if (!opened) return opened.error().in(buffer.place());
        bytes = known.emplace(*path, *opened).first->second;
      }
    } else if (!stand_in) {
      if (!buffers.empty() || !container.has_binary) {
        return Error{buffer.place() + " has no uri, and the file no binary part for it"};
      }
      bytes = container.binary;
    }
    if (bytes.size() < length && !stand_in) {
      return Error{
          fmt::format("{} has {} bytes, but says {}", buffer.place(), bytes.size(), length)};
    }
    buffers.push_back(bytes);
  }
  return buffers;
}

}  // namespace hyades::core
