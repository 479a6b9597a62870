#include "core/base/cgroup.h"

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <sstream>
#include <string_view>
#include <vector>

namespace hyades::core {
namespace {

/// A hierarchy of groups that may limit memory.
struct Hierarchy {
  bool second_version = false;
  std::string mount_root;   ///< the group that stands at its mount point
  std::string mount_point;  ///< the folder of that group
};

/// Paths in mountinfo have "\040" for a space, and the like.
std::string without_octal(std::string_view escaped) {
  std::string path;
  for (size_t i = 0; i < escaped.size(); ++i) {
    if (escaped[i] == '\\' && i + 3 < escaped.size()) {
      path += static_cast<char>(64 * (escaped[i + 1] - '0') + 8 * (escaped[i + 2] - '0') +
                                (escaped[i + 3] - '0'));
      i += 3;
    } else {
      path += escaped[i];
    }
  }
  return path;
}

/// Whether `list`, parted by commas, has `word`.
bool lists(std::string_view list, std::string_view word) {
  return (',' + std::string(list) + ',').find(',' + std::string(word) + ',') != std::string::npos;
}

std::vector<Hierarchy> memory_hierarchies(const std::string& root) {
  std::vector<Hierarchy> found;
  std::ifstream mounts(root + "/proc/self/mountinfo");
  for (std::string line; std::getline(mounts, line);) {
    const size_t dash = line.find(" - ");
    if (dash == std::string::npos) continue;
    std::istringstream place(line.substr(0, dash));
    std::istringstream kind(line.substr(dash + 3));
    std::string id, parent, device, mount_root, mount_point, type, source, options;
    place >> id >> parent >> device >> mount_root >> mount_point;
    kind >> type >> source >> options;
    if (type == "cgroup2" || (type == "cgroup" && lists(options, "memory"))) {
      found.push_back(
          {type == "cgroup2", without_octal(mount_root), root + without_octal(mount_point)});
    }
  }
  return found;
}

/// The group of this process in `hierarchy`, as the kernel names it: "/system.slice/x.service".
std::string own_group(const Hierarchy& hierarchy, const std::string& root) {
  std::ifstream groups(root + "/proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {
    const size_t first = line.find(':');
    const size_t second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string_view controllers =
        std::string_view(line).substr(first + 1, second - first - 1);
    if (hierarchy.second_version ? controllers.empty() : lists(controllers, "memory")) {
      return line.substr(second + 1);
    }
  }
  return "/";
}

/// The same below the hierarchy's mount point, "" for the group that stands there. A group that
/// lies outside it ("/../x", in a namespace of another's) is seen nowhere.
std::string below_mount_point(const Hierarchy& hierarchy, std::string group) {
  const std::string& top = hierarchy.mount_root;
  if (top != "/" && (group == top || group.starts_with(top + '/'))) group.erase(0, top.size());
  return group == "/" || group.starts_with("/..") ? "" : group;
}

}  // namespace

uint64_t cgroup_memory_limit(const std::string& root) {
  uint64_t least = UINT64_MAX;
  for (const Hierarchy& hierarchy : memory_hierarchies(root)) {
    // Version 1 says "no limit" by a huge number, version 2 by a word.
    const char* file = hierarchy.second_version ? "/memory.max" : "/memory.limit_in_bytes";
    std::string group = below_mount_point(hierarchy, own_group(hierarchy, root));
    for (;;) {
      uint64_t limit = 0;
      if (std::ifstream(hierarchy.mount_point + group + file) >> limit) {
        least = std::min(least, limit);
      }
      if (group.empty()) break;
      group.erase(group.rfind('/'));
    }
  }
  return least;
}

}  // namespace hyades::core
