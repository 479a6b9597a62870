#include "cli/media_facts.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <sstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/base/assets.h"
#include "core/base/text.h"
#include "core/job/measured_media.h"
#include "core/job/parse.h"
#include "core/media/albedo_inversion.h"
#include "core/scene/medium_makers.h"

namespace hyades::cli {

using core::Rgb;

namespace {

KnownMedium known(const core::MeasuredMedium& measured) {
  return {measured.name,       measured.source, measured.absorption,
          measured.scattering, measured.g,      measured.index};
}

bool is_file(const std::string& name) {
  const std::string extension = std::filesystem::path(name).extension().string();
  return extension == ".json" || extension == ".yaml" || extension == ".yml";
}

core::Result<std::vector<KnownMedium>> media_of_file(const std::string& path, float units) {
  const std::filesystem::path file(path);
  const auto assets =
      core::make_file_resolver(file.has_parent_path() ? file.parent_path().string() : ".");
  const std::string name = file.filename().string();
  if (const auto bytes = assets->open(name); !bytes) return bytes.error();
  core::Diagnostics diagnostics;
  const std::string text = fmt::format("hyades: 1\nunits: {}\nmedia: {{file: {}}}\n", units,
                                       nlohmann::json(name).dump());
  // Called otherwise than the file, which it names.
  const std::string called = (file.parent_path() / "the command line").string();
  const core::Job job = core::parse_job(text, called, *assets, diagnostics);
  if (!diagnostics.empty()) return diagnostics.to_error();
  std::vector<KnownMedium> media;
  for (const core::MediumDesc& desc : job.media) {
    const core::JobTime start = job.time_of(job.frames.first);
    const core::Coefficients found = core::coefficients_of(desc, start, units);
    media.push_back({desc.name, path, found.absorption, found.scattering, desc.g.at(start),
                     desc.index ? desc.index->at(start) : 1.0F});
  }
  return media;
}

/// ", did you mean 'whole-milk'?" of names that are like `name`, or that have a part which is:
/// "mlik".
std::string presets_like(const std::string& name) {
  const std::vector<std::string>& all = core::measured_medium_names();
  if (const std::string near = core::did_you_mean(name, all); !near.empty()) return near;
  std::vector<std::string> parts;
  for (const std::string& preset : all) {
    std::istringstream words(preset);
    for (std::string word; std::getline(words, word, '-');) parts.push_back(word);
  }
  const auto part = core::closest_name(name, parts);
  if (!part) return "";
  std::vector<std::string> like;
  for (const std::string& preset : all) {
    if (("-" + preset + "-").find("-" + *part + "-") == std::string::npos) continue;
    like.push_back("'" + preset + "'");
    if (like.size() == 4) break;
  }
  return ", did you mean " + core::join_names(like) + "?";
}

constexpr float kLayer = 0.01F;  // m

/// What comes back from, and through, a layer in diffuse light: Kubelka 1948, "New contributions to
/// the optics of intensely light-scattering materials, part I", with K = 2 a and S = 3/4 s (1 - g)
/// (Mudgett and Richards 1971).
float seen_of_layer(float absorption, float reduced_scattering, float thickness) {
  const double k = 2.0 * absorption;
  const double s = 0.75 * reduced_scattering;
  if (s * thickness < 1e-6) return static_cast<float>(std::exp(-k * thickness));
  const double a = 1.0 + k / s;
  const double b = std::sqrt(std::max(a * a - 1.0, 1e-12));
  const double x = std::min(b * s * thickness, 300.0);
  const double below = a * std::sinh(x) + b * std::cosh(x);
  return static_cast<float>((std::sinh(x) + b) / below);
}

}  // namespace

MediumFacts facts_of(const KnownMedium& medium) {
  MediumFacts facts;
  const float inner = core::diffuse_fresnel(medium.index).inner;
  const auto path = [](float coefficient) {
    return coefficient > 0.0F ? 1.0F / coefficient : std::numeric_limits<float>::infinity();
  };
  for (int c = 0; c < 3; ++c) {
    const float extinction = medium.absorption[c] + medium.scattering[c];
    facts.extinction[c] = extinction;
    facts.mean_free_path[c] = path(extinction);
    facts.transport_path[c] = path(extinction - medium.g[c] * medium.scattering[c]);
    facts.albedo[c] = extinction > 0.0F ? medium.scattering[c] / extinction : 0.0F;
    facts.block_reflectance[c] = core::diffuse_reflectance(facts.albedo[c], medium.g[c]);
    facts.seen_reflectance[c] = core::reflectance_through(facts.block_reflectance[c], inner);
    facts.in_a_layer[c] =
        seen_of_layer(medium.absorption[c], (1.0F - medium.g[c]) * medium.scattering[c], kLayer);
  }
  return facts;
}

std::vector<KnownMedium> known_presets() {
  std::vector<KnownMedium> media;
  for (const core::MeasuredMedium& measured : core::measured_media()) {
    media.push_back(known(measured));
  }
  return media;
}

core::Result<std::vector<KnownMedium>> find_media(const std::string& name, float units) {
  if (is_file(name)) return media_of_file(name, units);
  if (const core::MeasuredMedium* preset = core::find_measured_medium(name)) {
    return std::vector<KnownMedium>{known(*preset)};
  }
  return core::Error{"there is no preset '" + name + "', nor is it a file of media (.json, .yaml)" +
                     presets_like(name)};
}

}  // namespace hyades::cli
