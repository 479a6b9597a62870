#include "farm/tags.h"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

namespace hyades::farm {
namespace {

constexpr size_t kMostTags = 32;
constexpr size_t kLongestTag = 40;

bool is_tag(const std::string& text) {
  return !text.empty() && text.size() <= kLongestTag &&
         std::all_of(text.begin(), text.end(), [](char c) {
           return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                  c == '-' || c == '_' || c == '.';
         });
}

}  // namespace

core::Result<std::vector<std::string>> check_tags(std::vector<std::string> tags) {
  if (tags.size() > kMostTags) {
    return core::Error{fmt::format("{} tags: at most {}", tags.size(), kMostTags)};
  }
  for (const std::string& tag : tags) {
    if (is_tag(tag)) continue;
    return core::Error{fmt::format("tag '{}': expected 1 to {} letters, digits, '-', '_' or '.'",
                                   tag.substr(0, 80), kLongestTag)};
  }
  std::sort(tags.begin(), tags.end());
  tags.erase(std::unique(tags.begin(), tags.end()), tags.end());
  return tags;
}

}  // namespace hyades::farm
