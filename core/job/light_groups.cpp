#include "core/job/light_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <set>
#include <string_view>

#include "core/film/layout.h"
#include "core/job/map_reader.h"

namespace hyades::core {
namespace {

constexpr size_t kLongestName = 64;

bool is_plain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         c == '-';
}

}  // namespace

std::vector<std::string> light_groups_of(const Job& job) {
  std::set<std::string> groups;
  for (const LightDesc& light : job.lights) groups.insert(light.light_group);
  for (const MediumDesc& medium : job.media) groups.insert(medium.light_group);
  if (job.environment) groups.insert(job.environment->light_group);
  for_each_object(job, [&](const ObjectDesc& object) {
    if (object.emit) groups.insert(object.emit->light_group);
  });
  groups.erase("");
  return {groups.begin(), groups.end()};
}

void MapReader::light_group(std::string_view key, std::string& target) {
  const std::string expected =
      fmt::format("a name of at most {} letters, digits, _ and -", kLongestName);
  std::string name;
  text(key, name, expected);
  if (name.empty()) return;
  const YamlNode& node = *find(key);
  if (name.size() > kLongestName || !std::all_of(name.begin(), name.end(), is_plain)) {
    return mismatch(key, node, expected);
  }
  if (name == kRestGroup) {
    return complain(node.where,
                    fmt::format("{} is '{}', which is what lights of no group are called, "
                                "expected another name",
                                key, kRestGroup));
  }
  target = name;
}

}  // namespace hyades::core
