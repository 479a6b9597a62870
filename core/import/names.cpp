#include "core/import/names.h"

#include "core/job/read_values.h"

namespace hyades::core {

namespace {

constexpr size_t kLongest = 60;

}  // namespace

std::string safe_name(const std::string& text, const std::string& otherwise) {
  std::string name;
  for (const char c : text) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (plain || (!name.empty() && (c == '_' || c == '-' || c == '.'))) {
      name += c;
    } else if (!name.empty()) {
      name += '-';
    }
  }
  name = name.substr(0, kLongest);
  while (!name.empty() && (name.back() == '-' || name.back() == '.')) name.pop_back();
  return name.empty() ? otherwise : name;
}

std::string Names::add(const std::string& text, const std::string& otherwise) {
  std::string name = safe_name(text, otherwise);
  if (looks_like_color(name) && prefix_.empty()) name = otherwise + "-" + name;
  const std::string first = name;
  int& number = last_.try_emplace(first, 1).first->second;
  while (!taken_.insert(name).second) name = first + "-" + std::to_string(++number);
  return prefix_.empty() ? name : prefix_ + "." + name;
}

}  // namespace hyades::core
