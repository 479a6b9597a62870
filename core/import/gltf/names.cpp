#include "core/import/gltf/names.h"

#include <algorithm>
#include <cctype>

#include "core/job/read_values.h"

namespace hyades::core {

namespace {

bool is_letter(char c) {
  const auto u = static_cast<unsigned char>(c);
  return u < 128 && std::isalnum(u) != 0;
}

/// Everything but letters, digits, '_', '-', '.' and, where they may be, spaces becomes '_'.
std::string plain(const std::string& name, bool spaces) {
  std::string out;
  for (const char c : name) {
    // The bytes of one character beyond ASCII become one '_'.
    if ((static_cast<unsigned char>(c) & 0xC0U) == 0x80U) continue;
    const bool kept = is_letter(c) || c == '_' || c == '-' || c == '.' || (spaces && c == ' ');
    out += kept ? c : '_';
  }
  const size_t first = out.find_first_not_of(' ');
  if (first == std::string::npos) return {};
  return out.substr(first, out.find_last_not_of(' ') - first + 1);
}

}  // namespace

std::string GltfNames::make(const std::string& wanted, const std::string& otherwise) {
  std::string name = plain(wanted, true);
  if (name.empty()) name = otherwise;
  if (!is_letter(name.front()) && name.front() != '_') name = "_" + name;
  // Whatever stands alone must not be taken for a colour or number.
  if (looks_like_color(full(name)) || looks_like_color(name)) name = otherwise + "-" + name;
  // Some characters are left for what makes it different.
  const size_t room = 90 - std::min<size_t>(prefix_.size(), 60);
  if (name.size() > room) name.resize(room);
  while (name.back() == ' ') name.pop_back();
  std::string out = name;
  // A thousand boxes must not try a thousand numbers each.
  int& next = next_.try_emplace(name, 2).first->second;
  while (!taken_.insert(out).second) out = name + "-" + std::to_string(next++);
  return out;
}

std::string file_name_of(const std::string& name, const std::string& otherwise) {
  std::string out = plain(name, false);
  if (out.size() > 60) out.resize(60);
  if (out.empty() || out.front() == '.') out = otherwise + out;
  return out;
}

}  // namespace hyades::core
