#include "core/job/key_listing.h"

#include <algorithm>
#include <string>

#include <fmt/format.h>

namespace hyades::core {

KeyFacts& KeyListing::at(const std::string& type, const JobKey& id) {
  const auto same = [&](const ListedKey& key) { return key.type == type && key.id == id; };
  const auto found = std::find_if(keys_.begin(), keys_.end(), same);
  if (found != keys_.end()) return found->facts;
  keys_.push_back({type, id, {}});
  return keys_.back().facts;
}

std::string json_of(float value) { return fmt::format("{}", value); }

std::string json_of(const std::string& text) { return text.empty() ? "" : "\"" + text + "\""; }

std::string json_of(bool value) { return value ? "true" : "false"; }

std::string json_of(const Animated<float>& value) { return json_of(value.constant); }

std::string json_of(const Animated<Vec2>& value) {
  return fmt::format("[{}, {}]", value.constant.x, value.constant.y);
}

std::string json_of(const Animated<Vec3>& value) {
  return fmt::format("[{}, {}, {}]", value.constant.x, value.constant.y, value.constant.z);
}

std::string json_of_color(const Rgb& color) {
  const bool grey = color.x == color.y && color.y == color.z;
  return grey ? json_of(color.x) : json_of(Animated<Vec3>(color));
}

}  // namespace hyades::core
