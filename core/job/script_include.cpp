#include "core/job/script_include.h"

#include <array>
#include <cstddef>

#include "core/base/text.h"

namespace hyades::core {

namespace {

constexpr size_t kLongestValue = 100;
const std::array<std::string, 2> kKeys = {"lua", "set"};

/// Reads `{seed: 3}`; false after a complaint.
bool read_settings(const YamlNode& node, ScriptSettings& set, Diagnostics& diagnostics) {
  if (node.kind != YamlNode::Kind::map) {
    diagnostics.add(node.where,
                    "set is " + describe(node) + ", expected a map of the script's parameters");
    return false;
  }
  bool good = true;
  for (const YamlEntry& entry : node.map) {
    const bool plain = entry.value->kind == YamlNode::Kind::scalar;
    const std::string wrong = plain ? wrong_setting(entry.key, entry.value->scalar)
                                    : "parameter " + entry.key.substr(0, 60) + " is " +
                                          describe(*entry.value) +
                                          ", expected a number, a text, true or false";
    if (!wrong.empty()) diagnostics.add(entry.value->where, wrong);
    good = good && wrong.empty();
    set.emplace_back(entry.key, entry.value->scalar);
  }
  return good;
}

}  // namespace

std::string wrong_setting(const std::string& name, const std::string& value) {
  if (!is_setting_name(name)) {
    return "a parameter called '" + name.substr(0, 60) +
           "', expected a name of 1 to 64 letters, digits and '_'";
  }
  if (value.size() <= kLongestValue) return {};
  return "parameter " + name + " has " + std::to_string(value.size()) +
         " characters, expected at most " + std::to_string(kLongestValue);
}

std::optional<ScriptInclude> read_script_include(const YamlNode& node, Diagnostics& diagnostics) {
  const YamlEntry* file = node.find("lua");
  if (file == nullptr) {
    diagnostics.add(node.where, "include is " + describe(node) +
                                    ", expected a file name, {lua: script.lua, set: {...}} or a "
                                    "list of them");
    return std::nullopt;
  }
  bool good = true;
  const auto complain = [&](const YamlPlace& where, const std::string& message) {
    diagnostics.add(where, message);
    good = false;
  };
  for (const YamlEntry& entry : node.map) {
    if (entry.key == kKeys[0] || entry.key == kKeys[1]) continue;
    complain(entry.key_where, "unknown key '" + entry.key.substr(0, 60) + "' of include" +
                                  did_you_mean(entry.key, kKeys) + "; expected lua and set");
  }
  ScriptInclude wanted{file->value->scalar, {}};
  if (file->value->kind != YamlNode::Kind::scalar || !is_script_file(wanted.scene)) {
    complain(file->value->where,
             "lua is " + describe(*file->value) + ", expected the name of a script (.lua)");
  }
  if (const YamlEntry* set = node.find("set")) {
    good = read_settings(*set->value, wanted.set, diagnostics) && good;
  }
  return good ? std::optional(wanted) : std::nullopt;
}

}  // namespace hyades::core
