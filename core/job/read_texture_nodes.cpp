#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>

#include "core/job/kinds.h"
#include "core/job/read_texture_kinds.h"
#include "core/job/read_values.h"

namespace hyades::core {

namespace {

const std::array<std::string, 3> kEnds = {"clamp", "smooth", "open"};
const std::array<std::string, 3> kBetween = {"linear", "smooth", "steps"};
const std::array<std::string, 6> kChannels = {"color", "red",   "green",
                                              "blue",  "alpha", "luminance"};

void read_input(MapReader& reader, TextureDesc& texture) {
  reader.require("input", "a colour or texture");
  reader.color_input("input", texture.a, kNotNegative);
}

/// A map from numbers to colours.
void read_stops(MapReader& reader, const YamlNode& node, std::vector<TextureStop>& stops) {
  if (node.kind != YamlNode::Kind::map || node.map.size() < 2) {
    reader.mismatch("stops", node,
                    "two or more of 'number: colour', such as {0: 0.1, 1: \"#fd8\"}");
    return;
  }
  MapReader map(reader.context(), node, fmt::format("stops of {}", reader.what()),
                reader.path() + ".stops", "textures.ramp");
  for (const auto& entry : node.map) {
    TextureStop stop;
    double at = 0.0;
    if (!parse_number(entry.key, at)) {
      map.complain(entry.value->where,
                   fmt::format("a stop stands at '{}', expected a number", entry.key));
      continue;
    }
    stop.at = static_cast<float>(at);
    map.color_input(entry.key, stop.color, kNotNegative);
    const bool twice = std::any_of(stops.begin(), stops.end(),
                                   [&](const TextureStop& other) { return other.at == stop.at; });
    if (twice) {
      map.complain(entry.value->where, fmt::format("two stops stand at {}", entry.key));
    }
    stops.push_back(std::move(stop));
  }
}

}  // namespace

std::span<const std::string> remap_end_names() { return kEnds; }
std::span<const std::string> ramp_shape_names() { return kBetween; }
std::span<const std::string> channel_names() { return kChannels; }

void read_product(MapReader& reader, TextureDesc& texture) {
  read_input(reader, texture);
  reader.color_input("factor", texture.b, kNotNegative);
}

void read_pair(MapReader& reader, TextureDesc& texture) {
  reader.require("a", "a colour or texture");
  reader.require("b", "a colour or texture");
  reader.color_input("a", texture.a, kNotNegative);
  reader.color_input("b", texture.b, kNotNegative);
}

void read_texture_mix(MapReader& reader, TextureDesc& texture) {
  read_pair(reader, texture);
  reader.scalar_input("amount", texture.amount, kUnitInterval);
}

void read_invert(MapReader& reader, TextureDesc& texture) { read_input(reader, texture); }

void read_remap(MapReader& reader, TextureDesc& texture) {
  read_input(reader, texture);
  reader.animated("low", texture.remap.low, kAnyNumber);
  reader.animated("high", texture.remap.high, kAnyNumber);
  reader.animated("to_low", texture.remap.to_low, kAnyNumber);
  reader.animated("to_high", texture.remap.to_high, kAnyNumber);
  reader.choice("ends", texture.remap.ends, kEnds);
}

void read_power(MapReader& reader, TextureDesc& texture) {
  read_input(reader, texture);
  reader.require("exponent", "a number");
  reader.animated("exponent", texture.exponent, kNotNegative);
}

void read_threshold(MapReader& reader, TextureDesc& texture) {
  read_input(reader, texture);
  reader.animated("level", texture.level, kAnyNumber);
  reader.animated("softness", texture.softness, kNotNegative);
}

void read_ramp(MapReader& reader, TextureDesc& texture) {
  reader.require("input", "a number or texture");
  reader.scalar_input("input", texture.amount, kAnyNumber);
  reader.require("stops", "a map of numbers to colours");
  if (const YamlNode* node = reader.find("stops")) read_stops(reader, *node, texture.stops);
  reader.choice("between", texture.between, kBetween);
}

void read_hue_saturation(MapReader& reader, TextureDesc& texture) {
  read_input(reader, texture);
  reader.animated("hue", texture.hue, kAnyNumber);
  reader.animated("saturation", texture.saturation, kNotNegative);
  reader.animated("value", texture.value, kNotNegative);
}

void read_channel(MapReader& reader, TextureDesc& texture) {
  read_input(reader, texture);
  reader.require("channel", "one of red, green, blue, alpha, luminance");
  reader.choice("channel", texture.channel, std::span(kChannels).subspan(1));
}

}  // namespace hyades::core
