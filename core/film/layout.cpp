#include "core/film/layout.h"

#include <algorithm>

#include "core/film/fixed128.h"
#include "core/film/id_counts.h"
#include "core/film/splats.h"

namespace hyades::core {
namespace {

/// A layer of its own channels, which a sample's first surface decides.
struct Row {
  const char* layer;
  bool LayerSet::*wanted;
  int FilmLayout::*index;
  MergeRule rule;
  std::array<const char*, 3> channels;  ///< null: fewer
};

constexpr Row kRows[] = {
    {"depth", &LayerSet::depth, &FilmLayout::depth, MergeRule::min, {"depth.Z"}},
    {"albedo",
     &LayerSet::albedo,
     &FilmLayout::albedo,
     MergeRule::sum,
     {"albedo.R", "albedo.G", "albedo.B"}},
    {"normal",
     &LayerSet::normal,
     &FilmLayout::normal,
     MergeRule::sum,
     {"normal.X", "normal.Y", "normal.Z"}},
    {"position",
     &LayerSet::position,
     &FilmLayout::position,
     MergeRule::sum,
     {"position.X", "position.Y", "position.Z"}},
    {"motion", &LayerSet::motion, &FilmLayout::motion, MergeRule::sum, {"forward.u", "forward.v"}},
};

constexpr const char* kComponentNames[kLightComponents] = {
    "diffuse_direct",  "diffuse_indirect",    "glossy_direct",
    "glossy_indirect", "transmission_direct", "transmission_indirect",
    "volume_direct",   "volume_indirect",     "emission",
    "environment"};

constexpr const char* kIdNames[kIdKinds] = {"objects", "materials"};
constexpr const char* kSplatsName = "splats";
constexpr std::string_view kSeparator = ", ";

/// Calls visit(name, there) for all that is there or not, but for light groups; `there` is a
/// reference to the set's flag.
template <class Set, class Visit>
void for_each_flag(Set& set, const Visit& visit) {
  for (const Row& row : kRows) visit(std::string_view(row.layer), set.*row.wanted);
  for (size_t i = 0; i < kLightComponents; ++i)
    visit(std::string_view(kComponentNames[i]), set.components[i]);
  for (size_t i = 0; i < kIdKinds; ++i) visit(std::string_view(kIdNames[i]), set.ids[i]);
  visit(std::string_view(kSplatsName), set.splats);
}

}  // namespace

const char* name_of(LightComponent component) {
  return kComponentNames[static_cast<size_t>(component)];
}

std::string layers_text(const LayerSet& set) {
  std::string text;
  const auto add = [&](std::string_view name) {
    if (!text.empty()) text += kSeparator;
    text += name;
  };
  for_each_flag(set, [&](std::string_view name, bool there) {
    if (there) add(name);
  });
  for (const std::string& group : set.light_groups) add(std::string(kGroupPrefix) + group);
  return text;
}

Result<LayerSet> parse_layers(std::string_view text) {
  LayerSet set;
  for (std::string_view left = text; !left.empty();) {
    const size_t end = std::min(left.find(kSeparator), left.size());
    const std::string_view name = left.substr(0, end);
    if (name.starts_with(kGroupPrefix)) {
      set.light_groups.emplace_back(name.substr(kGroupPrefix.size()));
    } else {
      for_each_flag(set, [&](std::string_view known, bool& there) {
        if (known == name) there = true;
      });
    }
    left.remove_prefix(std::min(end + kSeparator.size(), left.size()));
  }
  std::vector<std::string>& groups = set.light_groups;
  if (layers_text(set) != text || !std::is_sorted(groups.begin(), groups.end()) ||
      std::adjacent_find(groups.begin(), groups.end()) != groups.end()) {
    return Error{"it has unknown layers"};
  }
  return set;
}

int film_version(const LayerSet& layers) {
  const LayerSet old{layers.depth, layers.albedo, layers.normal, layers.splats};
  if (old != layers) return 3;
  return layers.splats ? 2 : 1;
}

std::string group_channel(std::string_view name) { return "light_group_" + std::string(name); }

FilmLayout make_film_layout(const LayerSet& layers) {
  FilmLayout layout;
  layout.layers = layers;
  const auto append = [&layout](auto& names, MergeRule rule) {
    const int first = static_cast<int>(layout.channels.size());
    for (const char* name : names) {
      if (name != nullptr) layout.channels.push_back({name, rule});
    }
    return first;
  };
  const auto append_colour = [&](const std::string& layer) {
    const int first = static_cast<int>(layout.channels.size());
    for (const char* channel : {".R", ".G", ".B"})
      layout.channels.push_back({layer + channel, MergeRule::sum});
    return first;
  };
  const auto append_part = [&](const std::string& name) {
    const int first = append_colour(name);
    if (layout.parts < 0) layout.parts = first;
    layout.part_names.push_back(name);
    return static_cast<int>(layout.part_names.size()) - 1;
  };

  const char* const beauty[] = {"R", "G", "B", "A"};
  append(beauty, MergeRule::sum);
  for (const Row& row : kRows) {
    if (layers.*row.wanted) layout.*row.index = append(row.channels, row.rule);
  }
  layout.component_parts.fill(-1);
  for (size_t i = 0; i < kLightComponents; ++i) {
    if (layers.components[i]) layout.component_parts[i] = append_part(kComponentNames[i]);
  }
  for (const std::string& group : layers.light_groups) append_part(group_channel(group));
  layout.deposited = static_cast<int>(layout.channels.size());
  layout.moment2 = append_colour("moment2");
  const char* const samples[] = {"samples.N"};
  layout.samples = append(samples, MergeRule::sum);
  return layout;
}

int FilmLayout::group_part(std::string_view name) const {
  const auto& groups = layers.light_groups;
  const auto found = std::find(groups.begin(), groups.end(), name);
  if (found == groups.end()) return -1;
  return static_cast<int>(part_count() - groups.size()) + static_cast<int>(found - groups.begin());
}

uint64_t film_memory(const FilmLayout& layout, const PixelRect& window) {
  return film_memory(layout, window, window);
}

uint64_t id_room(const PixelRect& window) {
  constexpr uint64_t kPerPixel = 8;
  constexpr uint64_t kNames = uint64_t{4} << 20U;
  return static_cast<uint64_t>(window.area()) * kPerPixel * sizeof(IdCount) + kNames;
}

uint64_t film_memory(const FilmLayout& layout, const PixelRect& window, const PixelRect& region) {
  uint64_t bytes = static_cast<uint64_t>(window.area()) * layout.channels.size() * sizeof(Fixed128);
  for (const bool ids : layout.layers.ids) bytes += ids ? id_room(window) : 0;
  if (!layout.layers.splats) return bytes;
  return bytes + static_cast<uint64_t>(region.area()) *
                     (sizeof(SplatSums) + layout.part_count() * sizeof(PartSums));
}

}  // namespace hyades::core
