#include "core/job/read_textures.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "core/base/udim.h"
#include "core/job/read_sections.h"
#include "core/job/read_values.h"

namespace hyades::core {

void MapReader::choices(std::string_view key, std::string& first, const char* /*second_line*/,
                        std::string& second, std::span<const std::string> names) {
  const YamlNode* node = find(key);
  if (node == nullptr || node->kind != YamlNode::Kind::list) {
    choice(key, first, names);
    if (listing())
      tell(key, {.takes = "one or two choices",
                 .start = json_of(first),
                 .names = {names.begin(), names.end()}});
    second = first;
    return;
  }
  const auto is_one = [&](const YamlPtr& item) {
    return item->kind == YamlNode::Kind::scalar &&
           std::find(names.begin(), names.end(), item->scalar) != names.end();
  };
  if (node->list.size() != 2 || !std::all_of(node->list.begin(), node->list.end(), is_one)) {
    return complain(node->where, fmt::format("{} is a list, expected one or two of {}: [along u, "
                                             "along v]",
                                             key, join_names(names)));
  }
  first = node->list[0]->scalar;
  second = node->list[1]->scalar;
}

void MapReader::stops(std::string_view key, std::vector<textures::Stop>& stops) {
  if (listing()) tell(key, {.takes = "stops", .range = kNotNegative});
  const YamlNode* node = find(key);
  if (node == nullptr) return;
  if (node->kind != YamlNode::Kind::map || node->map.size() < 2) {
    return mismatch(key, *node, "two or more of 'number: colour', such as {0: 0.1, 1: \"#fd8\"}");
  }
  MapReader map(context_, *node, fmt::format("{} of {}", key, what_),
                fmt::format("{}.{}", path_, key), section_);
  std::set<float> places;
  for (const auto& entry : node->map) {
    textures::Stop stop;
    double at = 0.0;
    if (!parse_number(entry.key, at)) {
      complain(entry.value->where,
               fmt::format("a stop stands at '{}', expected a number", entry.key));
      continue;
    }
    stop.at = static_cast<float>(at);
    map.color_input(entry.key, stop.color, kNotNegative);
    if (!places.insert(stop.at).second) {
      complain(entry.value->where, fmt::format("two stops stand at {}", entry.key));
    }
    stops.push_back(std::move(stop));
  }
}

void check_keys(MapReader& reader, textures::Mapping& mapping) {
  const bool triplanar = mapping.type == "triplanar";
  const bool projects = triplanar || mapping.type == "planar" || mapping.type == "spherical" ||
                        mapping.type == "cylindrical";
  if (reader.has("space") && !projects) {
    reader.complain(reader.where_of("space"),
                    "space belongs to the mappings planar, spherical, cylindrical and triplanar");
  }
  if (reader.has("blend") && !triplanar) {
    reader.complain(reader.where_of("blend"), "blend belongs to the mapping triplanar");
  }
}

void check_keys(MapReader& reader, textures::Image& image) {
  if (!is_udim(image.file) || !reader.has("wrap")) return;
  reader.complain(reader.where_of("wrap"),
                  "wrap is given, but the tiles of <UDIM> lie side by side and do not wrap");
}

void read_textures(MapReader& top) {
  read_named(top, "textures", "texture", NameKind::texture, read_texture);
}

void read_texture(MapReader& reader, const std::string& name) {
  TextureDesc texture;
  texture.name = name;
  texture.where = reader.where();
  if (!read_kind(reader, "textures", texture)) return;
  reader.finish();
  reader.context().job.textures.push_back(std::move(texture));
}

bool read_texture_input(MapReader& reader, std::string_view key, const YamlNode& node,
                        std::string& texture) {
  if (node.kind == YamlNode::Kind::map && node.find("keys") == nullptr) {
    // Parentheses keep it apart from every name that a person can give.
    const std::string path = fmt::format("{}.{}", reader.path(), key);
    texture = "(" + path + ")";
    MapReader in_place(reader.context(), node, fmt::format("{} of {}", key, reader.what()), path,
                       "textures");
    in_place.leave_to_others("like");
    read_texture(in_place, texture);
    return true;
  }
  if (node.kind == YamlNode::Kind::scalar && !looks_like_color(node.scalar) &&
      is_valid_name(node.scalar)) {
    texture = node.scalar;
    reader.context().names.push_back(
        {NameKind::texture, node.scalar, node.where, fmt::format("{} of {}", key, reader.what())});
    return true;
  }
  return false;
}

}  // namespace hyades::core
