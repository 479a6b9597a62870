#include "core/scene/texture_kind_makers.h"
#include "core/scene/texture_names.h"

namespace hyades::core {
namespace {

struct Pair {
  TexturePtr a, b;
};

Result<Pair> pair_of(const TextureDesc& desc, Appearance& looks) {
  auto a = looks.color_texture(desc.a);
  if (!a) return a.error();
  auto b = looks.color_texture(desc.b);
  if (!b) return b.error();
  return Pair{*a, *b};
}

/// The number of `desc` as a texture.
Result<TexturePtr> amount_of(const TextureDesc& desc, Appearance& looks) {
  if (!desc.amount.texture.empty()) return looks.texture(desc.amount.texture);
  return make_constant_texture(Rgb(desc.amount.value.at(looks.time())));
}

/// make(input), where that can be had.
template <class Make>
Result<TexturePtr> of_input(const TextureDesc& desc, Appearance& looks, const Make& make) {
  auto input = looks.color_texture(desc.a);
  if (!input) return input;
  return make(*input);
}

template <class Make>
Result<TexturePtr> of_pair(const TextureDesc& desc, Appearance& looks, const Make& make) {
  auto pair = pair_of(desc, looks);
  if (!pair) return pair.error();
  return make(pair->a, pair->b);
}

}  // namespace

Result<TexturePtr> make_scale(const TextureDesc& desc, Appearance& looks) {
  return of_pair(desc, looks, make_scale_texture);
}

Result<TexturePtr> make_add(const TextureDesc& desc, Appearance& looks) {
  return of_pair(desc, looks, make_sum_texture);
}

Result<TexturePtr> make_divided(const TextureDesc& desc, Appearance& looks) {
  return of_pair(desc, looks, make_quotient_texture);
}

Result<TexturePtr> make_least(const TextureDesc& desc, Appearance& looks) {
  return of_pair(desc, looks, [](auto& a, auto& b) { return make_extreme_texture(a, b, false); });
}

Result<TexturePtr> make_greatest(const TextureDesc& desc, Appearance& looks) {
  return of_pair(desc, looks, [](auto& a, auto& b) { return make_extreme_texture(a, b, true); });
}

Result<TexturePtr> make_mixed(const TextureDesc& desc, Appearance& looks) {
  const auto amount = amount_of(desc, looks);
  if (!amount) return amount;
  return of_pair(desc, looks, [&](auto& a, auto& b) { return make_mix_texture(a, b, *amount); });
}

Result<TexturePtr> make_inverted(const TextureDesc& desc, Appearance& looks) {
  return of_input(desc, looks, make_invert_texture);
}

Result<TexturePtr> make_remapped(const TextureDesc& desc, Appearance& looks) {
  const auto ends = look_up(kRemapEnds, desc.remap.ends, "ends of remap");
  if (!ends) return ends.error();
  const JobTime& time = looks.time();
  const RemapDesc remap{desc.remap.low.at(time), desc.remap.high.at(time),
                        desc.remap.to_low.at(time), desc.remap.to_high.at(time), (*ends)->value};
  return of_input(desc, looks, [&](auto& input) { return make_remap_texture(input, remap); });
}

Result<TexturePtr> make_power(const TextureDesc& desc, Appearance& looks) {
  const float exponent = desc.exponent.at(looks.time());
  return of_input(desc, looks, [&](auto& input) { return make_power_texture(input, exponent); });
}

Result<TexturePtr> make_threshold(const TextureDesc& desc, Appearance& looks) {
  const float level = desc.level.at(looks.time());
  const float softness = desc.softness.at(looks.time());
  return of_input(desc, looks,
                  [&](auto& input) { return make_threshold_texture(input, level, softness); });
}

Result<TexturePtr> make_ramp(const TextureDesc& desc, Appearance& looks) {
  const auto shape = look_up(kRampShapes, desc.between, "value of between");
  if (!shape) return shape.error();
  const auto input = amount_of(desc, looks);
  if (!input) return input;
  std::vector<RampStop> stops;
  for (const TextureStop& stop : desc.stops) {
    auto color = looks.color_texture(stop.color);
    if (!color) return color;
    stops.push_back({stop.at, *color});
  }
  return make_ramp_texture(*input, std::move(stops), (*shape)->value);
}

Result<TexturePtr> make_hue_saturation(const TextureDesc& desc, Appearance& looks) {
  const JobTime& time = looks.time();
  const HueDesc hue{desc.hue.at(time), desc.saturation.at(time), desc.value.at(time)};
  return of_input(desc, looks, [&](auto& input) { return make_hue_texture(input, hue); });
}

Result<TexturePtr> make_channel(const TextureDesc& desc, Appearance& looks) {
  const auto channel = look_up(kChannels, desc.channel, "channel");
  if (!channel) return channel.error();
  return of_input(desc, looks, [&](auto& input) {
    const auto& which = (*channel)->value;
    return which ? make_channel_texture(input, *which) : input;
  });
}

}  // namespace hyades::core
