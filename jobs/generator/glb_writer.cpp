#include "jobs/generator/glb_writer.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace hyades::gallery {
namespace {

using nlohmann::json;

constexpr int kByte = 5121, kUnsigned = 5125, kFloat = 5126;  // component types of glTF

const char* type_of(int width) {
  switch (width) {
    case 1:
      return "SCALAR";
    case 2:
      return "VEC2";
    case 3:
      return "VEC3";
    case 4:
      return "VEC4";
    default:
      return "MAT4";
  }
}

void pad(std::string& text, char with) { text.resize((text.size() + 3) / 4 * 4, with); }

void put_word(std::string& out, size_t number) {
  const auto word = static_cast<uint32_t>(number);
  out.append(reinterpret_cast<const char*>(&word), sizeof(word));
}

}  // namespace

int GlbWriter::view(const void* data, size_t size) {
  pad(buffer_, '\0');
  nlohmann::json out = {{"buffer", 0}, {"byteOffset", buffer_.size()}, {"byteLength", size}};
  buffer_.append(static_cast<const char*>(data), size);
  return add("bufferViews", std::move(out));
}

int GlbWriter::add(const char* list, nlohmann::json item) {
  json[list].push_back(std::move(item));
  return static_cast<int>(json[list].size()) - 1;
}

int GlbWriter::floats(std::span<const float> numbers, int width) {
  const auto step = static_cast<size_t>(width);
  nlohmann::json out = {{"bufferView", view(numbers.data(), numbers.size_bytes())},
                        {"componentType", kFloat},
                        {"count", numbers.size() / step},
                        {"type", type_of(width)}};
  if (width != 1 && width != 3) return add("accessors", std::move(out));
  std::vector<float> low(step, 1e30F);
  std::vector<float> high(step, -1e30F);
  for (size_t i = 0; i < numbers.size(); ++i) {
    low[i % step] = std::min(low[i % step], numbers[i]);
    high[i % step] = std::max(high[i % step], numbers[i]);
  }
  out["min"] = low;
  out["max"] = high;
  return add("accessors", std::move(out));
}

int GlbWriter::bytes(std::span<const uint8_t> numbers, bool normalized) {
  nlohmann::json out = {{"bufferView", view(numbers.data(), numbers.size())},
                        {"componentType", kByte},
                        {"count", numbers.size() / 4},
                        {"type", "VEC4"}};
  if (normalized) out["normalized"] = true;
  return add("accessors", std::move(out));
}

int GlbWriter::indices(const std::vector<std::array<uint32_t, 3>>& triangles) {
  nlohmann::json out = {
      {"bufferView", view(triangles.data(), triangles.size() * sizeof(triangles[0]))},
      {"componentType", kUnsigned},
      {"count", 3 * triangles.size()},
      {"type", "SCALAR"}};
  return add("accessors", std::move(out));
}

std::string GlbWriter::file() const {
  nlohmann::json whole = json;
  std::string binary = buffer_;
  pad(binary, '\0');
  whole["buffers"] = {{{"byteLength", binary.size()}}};
  std::string text = whole.dump();
  pad(text, ' ');
  std::string out = "glTF";
  put_word(out, 2);
  put_word(out, 12 + 8 + text.size() + 8 + binary.size());
  put_word(out, text.size());
  out += "JSON" + text;
  put_word(out, binary.size());
  out += std::string("BIN\0", 4) + binary;
  return out;
}

}  // namespace hyades::gallery
