#include <utility>
#include <vector>

#include "core/scene/texture_kind_makers.h"
#include "core/scene/texture_names.h"

namespace hyades::core {
namespace {

/// The number of `input` as a texture.
Result<TexturePtr> amount_of(const ScalarInput& input, Appearance& looks) {
  if (!input.texture.empty()) return looks.texture(input.texture);
  return make_constant_texture(Rgb(input.value.at(looks.time())));
}

/// make(input), where that can be had.
template <class Make>
Result<TexturePtr> of_input(const ColorInput& from, Appearance& looks, const Make& make) {
  auto input = looks.color_texture(from);
  if (!input) return input;
  return make(*input);
}

/// make(a, b), where they can be had.
template <class Make>
Result<TexturePtr> of_two(const ColorInput& from_a, const ColorInput& from_b, Appearance& looks,
                          const Make& make) {
  auto a = looks.color_texture(from_a);
  if (!a) return a;
  auto b = looks.color_texture(from_b);
  if (!b) return b;
  return make(*a, *b);
}

}  // namespace

Result<TexturePtr> make_texture(const textures::Scale& desc, Appearance& looks) {
  return of_two(desc.input, desc.factor, looks, make_scale_texture);
}

Result<TexturePtr> make_texture(const textures::Add& desc, Appearance& looks) {
  return of_two(desc.a, desc.b, looks, make_sum_texture);
}

Result<TexturePtr> make_texture(const textures::Divide& desc, Appearance& looks) {
  return of_two(desc.a, desc.b, looks, make_quotient_texture);
}

Result<TexturePtr> make_texture(const textures::Min& desc, Appearance& looks) {
  return of_two(desc.a, desc.b, looks,
                [](auto& a, auto& b) { return make_extreme_texture(a, b, false); });
}

Result<TexturePtr> make_texture(const textures::Max& desc, Appearance& looks) {
  return of_two(desc.a, desc.b, looks,
                [](auto& a, auto& b) { return make_extreme_texture(a, b, true); });
}

Result<TexturePtr> make_texture(const textures::Mix& desc, Appearance& looks) {
  const auto amount = amount_of(desc.amount, looks);
  if (!amount) return amount;
  return of_two(desc.a, desc.b, looks,
                [&](auto& a, auto& b) { return make_mix_texture(a, b, *amount); });
}

Result<TexturePtr> make_texture(const textures::Invert& desc, Appearance& looks) {
  return of_input(desc.input, looks, make_invert_texture);
}

Result<TexturePtr> make_texture(const textures::Remap& desc, Appearance& looks) {
  const auto ends = look_up(kRemapEnds, desc.ends, "ends of remap");
  if (!ends) return ends.error();
  const JobTime& time = looks.time();
  const RemapDesc remap{desc.low.at(time), desc.high.at(time), desc.to_low.at(time),
                        desc.to_high.at(time), (*ends)->value};
  return of_input(desc.input, looks, [&](auto& input) { return make_remap_texture(input, remap); });
}

Result<TexturePtr> make_texture(const textures::Power& desc, Appearance& looks) {
  const float exponent = desc.exponent.at(looks.time());
  return of_input(desc.input, looks,
                  [&](auto& input) { return make_power_texture(input, exponent); });
}

Result<TexturePtr> make_texture(const textures::Threshold& desc, Appearance& looks) {
  const float level = desc.level.at(looks.time());
  const float softness = desc.softness.at(looks.time());
  return of_input(desc.input, looks,
                  [&](auto& input) { return make_threshold_texture(input, level, softness); });
}

Result<TexturePtr> make_texture(const textures::Ramp& desc, Appearance& looks) {
  const auto shape = look_up(kRampShapes, desc.between, "value of between");
  if (!shape) return shape.error();
  const auto input = amount_of(desc.input, looks);
  if (!input) return input;
  std::vector<RampStop> stops;
  for (const textures::Stop& stop : desc.stops) {
    auto color = looks.color_texture(stop.color);
    if (!color) return color;
    stops.push_back({stop.at, *color});
  }
  return make_ramp_texture(*input, std::move(stops), (*shape)->value);
}

Result<TexturePtr> make_texture(const textures::HueSaturation& desc, Appearance& looks) {
  const JobTime& time = looks.time();
  const HueDesc hue{desc.hue.at(time), desc.saturation.at(time), desc.value.at(time)};
  return of_input(desc.input, looks, [&](auto& input) { return make_hue_texture(input, hue); });
}

Result<TexturePtr> make_texture(const textures::ChannelOf& desc, Appearance& looks) {
  const auto channel = look_up(kChannels, desc.channel, "channel");
  if (!channel) return channel.error();
  return of_input(desc.input, looks, [&](auto& input) {
    const auto& which = (*channel)->value;
    return which ? make_channel_texture(input, *which) : input;
  });
}

}  // namespace hyades::core
