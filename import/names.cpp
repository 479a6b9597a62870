#include "import/names.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "core/job/read_values.h"

namespace hyades::core {

namespace {

/// Of the 100 characters that a name may have, some are left for what makes it different.
constexpr size_t kLongestName = 90;
constexpr size_t kLongestPrefix = 60;
constexpr size_t kLongestFile = 60;

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
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
  return out;
}

}  // namespace

std::string safe_name(const std::string& text, const std::string& otherwise) {
  std::string name = plain(text, false);
  name.erase(0, name.find_first_not_of(".-"));
  if (name.size() > kLongestFile) name.resize(kLongestFile);
  while (!name.empty() && name.back() == '.') name.pop_back();
  return name.empty() ? otherwise : name;
}

Names::Names(std::string kind, std::string prefix)
    : kind_(std::move(kind)), prefix_(std::move(prefix)) {
  if (!prefix_.empty()) prefix_ += '.';
}

std::string Names::add(const std::string& wanted) {
  std::string name = plain(wanted, true);
  name.erase(0, name.find_first_not_of(' '));
  if (name.empty()) name = kind_;
  if (!is_letter(name.front()) && name.front() != '_') name = "_" + name;
  // Whatever stands alone must not be taken for a colour or number.
  if (looks_like_color(prefix_ + name) || looks_like_color(name)) name = kind_ + "-" + name;
  const size_t room = kLongestName - std::min(prefix_.size(), kLongestPrefix);
  if (name.size() > room) name.resize(room);
  while (name.back() == ' ') name.pop_back();
  std::string out = name;
  int& next = next_.try_emplace(name, 2).first->second;
  while (!taken_.insert(out).second) out = name + "-" + std::to_string(next++);
  return prefix_ + out;
}

}  // namespace hyades::core
