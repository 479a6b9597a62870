#include "cli/media_maker.h"

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "core/base/color.h"
#include "core/base/elementary.h"
#include "core/job/value_checks.h"
#include "core/media/albedo_inversion.h"

namespace hyades::cli {

using core::Range;
using core::Rgb;

namespace {

constexpr Range kAboveZero{0.0, 1.0, true, false};

/// One or three numbers within `range`, or a hex colour.
core::Result<Rgb> read_channels(const char* option, const std::string& text, const Range& range) {
  const auto wrong = [&] {
    return core::Error{std::string(option) + " " + text + ": expected " + range.describe() +
                       ", or three such as 0.9,0.6,0.4"};
  };
  if (text.starts_with('#')) {
    const auto color = core::parse_hex_color(text);
    if (!color) return color.error().in(option);
    for (int c = 0; c < 3; ++c) {
      if (!range.contains((*color)[c])) return wrong();
    }
    return *color;
  }
  std::vector<float> parts;
  size_t at = 0;
  while (at <= text.size()) {
    const size_t end = std::min(text.find(',', at), text.size());
    const std::string part = text.substr(at, end - at);
    char* after = nullptr;
    const double value = std::strtod(part.c_str(), &after);
    if (part.empty() || *after != '\0' || !range.contains(value)) return wrong();
    parts.push_back(static_cast<float>(value));
    at = end + 1;
  }
  if (parts.size() == 1) return Rgb(parts[0]);
  if (parts.size() != 3) return wrong();
  return Rgb(parts[0], parts[1], parts[2]);
}

/// An albedo and how far light goes.
core::Status from_albedo(const MediumDescription& wanted, float units, KnownMedium& medium) {
  const auto albedo = read_channels("--albedo", wanted.albedo, core::kUnitInterval);
  if (!albedo) return albedo.error();
  const auto length = read_channels("--mean-free-path", wanted.mean_free_path, core::kPositive);
  if (!length) return length.error();
  const Rgb extinction = Rgb(1.0F) / (*length * units);
  medium.scattering = *albedo * extinction;
  medium.absorption = extinction - medium.scattering;
  medium.source = "albedo and mean free path";
  return {};
}

/// Beer's law: white light is of the colour after the depth.
core::Status from_depth(const MediumDescription& wanted, float units, KnownMedium& medium) {
  const auto color = read_channels("--color", wanted.color, kAboveZero);
  if (!color) return color.error();
  const auto depth = read_channels("--depth", wanted.depth, core::kPositive);
  if (!depth) return depth.error();
  for (int c = 0; c < 3; ++c) {
    const float lost = -core::log((*color)[c]);
    medium.absorption[c] = lost > 0.0F ? lost / ((*depth)[c] * units) : 0.0F;
  }
  medium.source = "colour at a depth";
  return {};
}

/// What a thick body looks like.
core::Status from_radius(const MediumDescription& wanted, float units, KnownMedium& medium) {
  core::BodyColor body;
  const auto color = read_channels("--color", wanted.color, core::kUnitInterval);
  if (!color) return color.error();
  const auto radius = read_channels("--radius", wanted.radius, core::kPositive);
  if (!radius) return radius.error();
  body.color = *color;
  body.radius = *radius * units;
  body.g = medium.g.x;
  body.index = medium.index;
  const core::ScatteringNumbers made = core::scattering_of(body);
  medium.absorption = made.absorption;
  medium.scattering = made.scattering;
  medium.source = "colour and radius";
  return {};
}

}  // namespace

core::Result<KnownMedium> make_described(const MediumDescription& wanted, float units) {
  KnownMedium medium;
  medium.name = wanted.name;
  const bool preset = !wanted.preset.empty();
  const bool albedo = !wanted.albedo.empty() && !wanted.mean_free_path.empty();
  const bool depth = !wanted.color.empty() && !wanted.depth.empty();
  const bool radius = !wanted.color.empty() && !wanted.radius.empty();
  const int given = !wanted.albedo.empty() + !wanted.mean_free_path.empty() +
                    !wanted.color.empty() + !wanted.depth.empty() + !wanted.radius.empty();
  if (preset + albedo + depth + radius != 1 || given != (preset ? 0 : 2)) {
    return core::Error{
        "expected one of --preset, --albedo with --mean-free-path, --color with --depth, --color "
        "with --radius"};
  }
  core::Status done;
  if (preset) {
    auto found = find_media(wanted.preset, units);
    if (!found) return found.error();
    if (found->size() != 1) return core::Error{wanted.preset + ": expected one medium in it"};
    const std::string source = found->front().name + " (" + found->front().source + ")";
    medium = found->front();
    medium.name = wanted.name;
    medium.source = source;
  } else {
    medium.index = 1.33F;
  }
  if (wanted.g) medium.g = Rgb(*wanted.g);
  if (wanted.index) medium.index = *wanted.index;
  if (albedo) done = from_albedo(wanted, units, medium);
  if (depth) done = from_depth(wanted, units, medium);
  if (radius) done = from_radius(wanted, units, medium);
  if (!done) return done.error();
  medium.absorption *= wanted.scale;
  medium.scattering *= wanted.scale;
  return medium;
}

}  // namespace hyades::cli
