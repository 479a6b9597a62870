#include <algorithm>
#include <charconv>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/command_line.h"
#include "cli/film_commands.h"
#include "cli/rewrite_picture.h"
#include "core/base/text.h"
#include "core/base/vec.h"
#include "core/film/layout.h"

namespace hyades::cli {
namespace {

constexpr std::string_view kRed = ".R";
constexpr const char* kExpected = "expected NAME=FACTOR or NAME=R,G,B, from 0 to 1e6";
constexpr float kMostFactor = 1e6F;

struct RelightOptions {
  std::string input;
  std::vector<std::string> groups;
  ShownOutput shown;
  WrittenFile written;
};

/// A light group, and what its light is multiplied by.
struct Factor {
  std::string group;
  core::Rgb factor{1.0F};
};

std::optional<float> number_in(std::string_view text) {
  float value = 0.0F;
  const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = failed == std::errc() && end == text.data() + text.size();
  return whole && value >= 0.0F && value <= kMostFactor ? std::optional(value) : std::nullopt;
}

core::Result<Factor> read_factor(const std::string& text) {
  const core::Error wrong{fmt::format("--group {}: {}", text, kExpected)};
  const size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) return wrong;
  std::vector<float> parts;
  for (size_t at = equals + 1; at <= text.size();) {
    const size_t comma = std::min(text.find(',', at), text.size());
    const auto part = number_in(std::string_view(text).substr(at, comma - at));
    if (!part) return wrong;
    parts.push_back(*part);
    at = comma + 1;
  }
  if (parts.size() != 1 && parts.size() != 3) return wrong;
  return Factor{text.substr(0, equals),
                parts.size() == 1 ? core::Rgb(parts[0]) : core::Rgb(parts[0], parts[1], parts[2])};
}

std::vector<std::string> groups_of(const core::Image& picture) {
  const std::string prefix = core::group_channel("");
  std::vector<std::string> names;
  for (const std::string& channel : picture.channels) {
    if (!channel.starts_with(prefix) || !channel.ends_with(kRed)) continue;
    names.push_back(channel.substr(prefix.size(), channel.size() - prefix.size() - kRed.size()));
  }
  return names;
}

/// Adds what a factor changes of beauty. What has no group in the picture stays as it is.
core::Status apply(const Factor& factor, core::Image& picture) {
  for (int c = 0; c < 3; ++c) {
    const std::string color(1, "RGB"[c]);
    const int to = picture.find_channel(color);
    const int from = picture.find_channel(core::group_channel(factor.group) + "." + color);
    if (to < 0 || from < 0) return core::Error{"it has no beauty in colours"};
    for (int y = 0; y < picture.height; ++y) {
      for (int x = 0; x < picture.width; ++x) {
        picture.at(x, y, to) += (factor.factor[c] - 1.0F) * picture.at(x, y, from);
      }
    }
  }
  return {};
}

core::Status relight(const std::vector<std::string>& asked, core::Image& picture) {
  const std::vector<std::string> names = groups_of(picture);
  if (names.empty()) {
    return core::Error{
        "it tells no light groups apart, expected an EXR with the layers light_groups, or a film "
        "of a job that writes one"};
  }
  std::vector<std::string> seen;
  for (const std::string& text : asked) {
    const auto factor = read_factor(text);
    if (!factor) return factor.error();
    if (std::find(names.begin(), names.end(), factor->group) == names.end()) {
      const std::string hint = core::did_you_mean(factor->group, names);
      return core::Error{
          fmt::format("it has no light group '{}'{}", factor->group,
                      hint.empty() ? ", expected " + core::join_names(names) : hint)};
    }
    if (std::find(seen.begin(), seen.end(), factor->group) != seen.end()) {
      return core::Error{"--group " + factor->group + " is there twice"};
    }
    seen.push_back(factor->group);
    if (auto done = apply(*factor, picture); !done) return done;
  }
  return {};
}

}  // namespace

int relight_command(int argc, char** argv) {
  CLI::App app("Makes light groups of a rendered picture brighter, darker or of another colour",
               "hyades relight");
  RelightOptions options;
  app.add_option("picture", options.input, "EXR with light groups, or a film EXR")->required();
  app.add_option("--group", options.groups,
                 "NAME=FACTOR or NAME=R,G,B: what the light of a group is multiplied by; again for "
                 "each, 'rest' being all that is in none")
      ->required()
      ->allow_extra_args(false);
  declare_shown_output(app, options.shown);
  declare_written_file(app, options.written);
  app.footer(
      "examples:\n"
      "  hyades relight shot.0007.exr --group key=0.5 --group window=1,0.8,0.6 -o dusk.exr\n"
      "  hyades relight shot.0007.film.exr --group rest=0 -o lamps.png --tone-map filmic\n"
      "Lights are put into groups by their key 'light_group'; an output with layers: [beauty, "
      "light_groups] keeps them apart.\n"
      "exit status: 0 fine, 2 wrong arguments, or a picture that cannot be read or written.");
  if (const auto status = parse_command_line(app, argc, argv)) return *status;
  const auto change = [&](core::Image& picture, const core::OutputDesc&) {
    return relight(options.groups, picture);
  };
  return rewrite_picture("hyades relight", options.input, options.shown, options.written, change);
}

}  // namespace hyades::cli
