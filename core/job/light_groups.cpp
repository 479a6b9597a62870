#include "core/job/light_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "core/film/layout.h"

namespace hyades::core {
namespace {

constexpr size_t kLongestName = 64;

void collect(const std::vector<ObjectDesc>& objects, std::set<std::string>& groups) {
  for (const ObjectDesc& object : objects) {
    if (object.emit) groups.insert(object.emit->light_group);
    collect(object.children, groups);
  }
}

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
  collect(job.objects, groups);
  for (const GroupDesc& group : job.groups) collect(group.objects, groups);
  groups.erase("");
  return {groups.begin(), groups.end()};
}

void read_light_group(MapReader& reader, std::string& group) {
  const std::string expected =
      fmt::format("a name of at most {} letters, digits, _ and -", kLongestName);
  std::string name;
  reader.text("light_group", name, expected);
  if (name.empty()) return;
  const YamlNode& node = *reader.find("light_group");
  if (name.size() > kLongestName || !std::all_of(name.begin(), name.end(), is_plain)) {
    return reader.mismatch("light_group", node, expected);
  }
  if (name == kRestGroup) {
    return reader.complain(
        node.where, fmt::format("light_group is '{}', which is what lights of no group are called, "
                                "expected another name",
                                kRestGroup));
  }
  group = name;
}

}  // namespace hyades::core
