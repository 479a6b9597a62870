#include "core/job/read_layers.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "core/base/text.h"
#include "core/film/layout.h"
#include "core/job/light_groups.h"
#include "core/job/output_names.h"
#include "core/job/suggest.h"

namespace hyades::core {
namespace {

constexpr size_t kMostGroups = 32;  ///< that one film tells apart

bool is_layer(const std::string& name, const std::vector<std::string>& groups) {
  const auto plain = layer_names();
  if (std::find(plain.begin(), plain.end(), name) != plain.end()) return true;
  if (groups.empty() || !name.starts_with(kGroupPrefix)) return false;
  const std::string group = name.substr(kGroupPrefix.size());
  return group == kRestGroup || std::binary_search(groups.begin(), groups.end(), group);
}

/// What a layer may be called in this job.
std::vector<std::string> names_of_layers(const std::vector<std::string>& groups) {
  const auto plain = layer_names();
  std::vector<std::string> names(plain.begin(), plain.end());
  for (const std::string& group : groups) names.push_back(std::string(kGroupPrefix) + group);
  if (!groups.empty()) names.push_back(std::string(kGroupPrefix) + kRestGroup);
  return names;
}

}  // namespace

bool check_layer(MapReader& reader, const YamlNode& item) {
  ReadContext& context = reader.context();
  if (!context.light_groups) context.light_groups = light_groups_of(context.job);
  const std::vector<std::string>& groups = *context.light_groups;
  if (!is_layer(item.scalar, groups)) {
    // Each complaint looks through all groups.
    if (context.diagnostics.full() || !context.spend(groups.size() + 1, item.where)) return false;
    const std::vector<std::string> names = names_of_layers(groups);
    const std::string hint = suggest(item.scalar, names);
    reader.complain(item.where,
                    fmt::format("layer is {}{}", describe(item),
                                hint.empty() ? ", expected " + join_names(names) : hint));
    return false;
  }
  if (groups.size() > kMostGroups && item.scalar.starts_with("light_group")) {
    reader.complain(item.where, fmt::format("the job has {} light groups, expected at most {}",
                                            groups.size(), kMostGroups));
    return false;
  }
  return true;
}

void read_layers(MapReader& reader, OutputDesc& output) {
  output.layers = {"beauty", "alpha"};
  if (reader.listing())
    reader.tell("layers", {.takes = "texts", .start = R"(["beauty", "alpha"])"});
  const YamlNode* node = reader.find("layers");
  if (node == nullptr) return;
  if (node->kind != YamlNode::Kind::list || node->list.empty()) {
    const auto names = layer_names();
    reader.mismatch("layers", *node, "a list of " + join_names(names));
    return;
  }
  std::vector<std::string> layers;
  for (const YamlPtr& item : node->list) {
    if (!check_layer(reader, *item)) continue;
    for (const std::string& name : unfolded(item->scalar)) {
      if (std::find(layers.begin(), layers.end(), name) != layers.end()) {
        reader.complain(item->where, fmt::format("layer '{}' is listed twice", name));
      } else {
        layers.push_back(name);
      }
    }
  }
  output.layers = layers;
}

std::vector<OutputDesc> split_by_layer(const Job& job, const OutputDesc& output) {
  if (output.file.find(kLayerMark) == std::string::npos) return {output};
  std::vector<std::string> layers;
  for (const std::string& layer : output.layers) {
    if (layer != "light_groups") {
      layers.push_back(layer);
      continue;
    }
    for (const std::string& group : light_groups_of(job))
      layers.push_back(std::string(kGroupPrefix) + group);
    layers.push_back(std::string(kGroupPrefix) + kRestGroup);
  }
  std::vector<OutputDesc> all;
  for (const std::string& layer : layers) {
    OutputDesc one = output;
    one.layers = {layer};
    if (layer != "beauty") one.denoise = "false";
    std::string name = layer;
    std::replace(name.begin(), name.end(), ':', '_');
    for (size_t at = one.file.find(kLayerMark); at != std::string::npos;
         at = one.file.find(kLayerMark))
      one.file.replace(at, kLayerMark.size(), name);
    all.push_back(std::move(one));
  }
  return all;
}

}  // namespace hyades::core
