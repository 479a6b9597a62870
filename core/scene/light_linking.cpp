#include "core/scene/light_linking.h"

#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "core/job/source.h"

namespace hyades::core {
namespace {

constexpr size_t kMostLists = 63;

/// Names of objects, and whether an object has been found for them.
using Wanted = std::unordered_map<std::string_view, bool>;

Wanted names_in(const std::optional<std::vector<std::string>>& list) {
  Wanted names;
  if (!list) return names;
  for (const std::string& name : *list) names.emplace(name, false);
  return names;
}

/// Whether the object called `path`, or a group around it, is among `names`.
bool is_among(Wanted& names, std::string_view path) {
  if (names.empty()) return false;
  bool found = false;
  for (size_t end = 0; end != std::string_view::npos;) {
    end = path.find('/', end + 1);
    const auto name = names.find(path.substr(0, end));
    if (name == names.end()) continue;
    name->second = found = true;
  }
  return found;
}

Status check_found(const Wanted& names, const SourceLocation& where) {
  for (const auto& [name, found] : names) {
    // A group may be empty; that things of the top level are there has been checked.
    if (found || name.find('/') == std::string_view::npos) continue;
    return Error{Diagnostic{where, fmt::format("nothing is called '{}', expected the name of an "
                                               "object or, behind slashes, of what is in it",
                                               name)}
                     .to_string()};
  }
  return {};
}

}  // namespace

Result<LinkingLists::Members> LinkingLists::members_of(const LinkingDesc& linking) const {
  Wanted include = names_in(linking.include);
  Wanted exclude = names_in(linking.exclude);
  Members members(bits_.size(), !linking.include);
  for (size_t i = 0; i < objects(); ++i) {
    const std::string& name = (*objects_)[i].name;
    if (is_among(include, name)) members[i] = true;
    if (is_among(exclude, name)) members[i] = false;
  }
  for (const Wanted* names : {&include, &exclude}) {
    if (auto found = check_found(*names, linking.where); !found) return found.error();
  }
  return members;
}

Result<uint8_t> LinkingLists::number_of(const std::optional<LinkingDesc>& linking) {
  if (!linking) return uint8_t{0};
  const auto known = known_.find({linking->include, linking->exclude});
  if (known != known_.end()) return known->second;
  auto number = number_of_new(*linking);
  if (number) known_[{linking->include, linking->exclude}] = *number;
  return number;
}

Result<uint8_t> LinkingLists::number_of_new(const LinkingDesc& linking) {
  auto members = members_of(linking);
  if (!members) return members.error();
  const auto next = static_cast<uint8_t>(numbers_.size());
  const auto [entry, is_new] = numbers_.emplace(std::move(*members), next);
  if (!is_new) return entry->second;
  if (next > kMostLists) {
    return Error{Diagnostic{linking.where, fmt::format("lights are linked to more than {} "
                                                       "different lists of objects, expected "
                                                       "fewer",
                                                       kMostLists)}
                     .to_string()};
  }
  for (size_t i = 0; i < bits_.size(); ++i) {
    if (entry->first[i]) bits_[i] |= ListBits{1} << next;
  }
  return next;
}

}  // namespace hyades::core
