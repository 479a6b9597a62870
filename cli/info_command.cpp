#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "cli/command_line.h"
#include "cli/film_commands.h"
#include "cli/join_films.h"
#include "core/base/printable.h"
#include "core/base/text.h"
#include "core/image/read_image.h"
#include "core/job/output_path.h"

namespace hyades::cli {
namespace {

using Json = nlohmann::ordered_json;
using Texts = std::vector<std::pair<std::string, std::string>>;

struct ChannelFacts {
  std::string name;
  double least = std::numeric_limits<double>::infinity();
  double most = -std::numeric_limits<double>::infinity();
  double mean = 0.0;        ///< of what is finite
  uint64_t not_finite = 0;  ///< pixels
};

std::vector<ChannelFacts> facts_of(const core::Image& image) {
  std::vector<ChannelFacts> all;
  const size_t stride = image.channels.size();
  for (size_t c = 0; c < stride; ++c) {
    ChannelFacts facts;
    facts.name = image.channels[c];
    uint64_t finite = 0;
    for (size_t i = c; i < image.data.size(); i += stride) {
      const double value = image.data[i];
      if (!std::isfinite(value)) {
        ++facts.not_finite;
        continue;
      }
      facts.least = std::min(facts.least, value);
      facts.most = std::max(facts.most, value);
      facts.mean += value;
      ++finite;
    }
    if (finite > 0) facts.mean /= static_cast<double>(finite);
    all.push_back(facts);
  }
  return all;
}

Texts texts_of(const std::string& path) {
  const bool png = core::file_extension(path) == ".png";
  auto texts = png ? core::read_png_texts(path) : core::read_exr_texts(path);
  return texts ? std::move(*texts) : Texts{};
}

/// A film's text of all its numbers, and what OpenEXR keeps for itself.
bool is_told(const std::string& name) { return name != "hyades.film" && name != "name"; }

void print(const std::string& path, const core::Image& image,
           const std::optional<core::FilmFile>& film) {
  std::printf("%s: %d x %d pixels", core::printable(path).c_str(), image.width, image.height);
  if (image.placement.in_frame()) {
    std::printf(", from %d,%d of %d x %d", image.placement.x, image.placement.y,
                image.placement.frame_width, image.placement.frame_height);
  }
  std::printf("\n");
  if (film) {
    std::printf("  film       frame %d of %s: %s\n", film->info.frame,
                core::printable(film->info.job_name).c_str(), share_held(*film).c_str());
    if (const std::string missing = what_is_missing(*film); !missing.empty()) {
      std::printf("  missing    %s\n", missing.c_str());
    }
  }
  for (const auto& [name, value] : texts_of(path)) {
    if (is_told(name)) {
      std::printf("  %-18s %s\n", core::printable(name).c_str(), core::printable(value).c_str());
    }
  }
  std::printf("  %-24s %12s %12s %12s\n", "channel", "least", "mean", "most");
  for (const ChannelFacts& facts : facts_of(image)) {
    std::printf("  %-24s %12.5g %12.5g %12.5g", core::printable(facts.name).c_str(), facts.least,
                facts.mean, facts.most);
    if (facts.not_finite > 0) {
      std::printf("  and %s not finite", core::counted(facts.not_finite, "pixel").c_str());
    }
    std::printf("\n");
  }
}

Json as_json(const std::string& path, const core::Image& image,
             const std::optional<core::FilmFile>& film) {
  Json json = {{"file", path}, {"width", image.width}, {"height", image.height}};
  if (image.placement.in_frame()) {
    json["window"] = {image.placement.x, image.placement.y, image.placement.x + image.width,
                      image.placement.y + image.height};
    json["frame_size"] = {image.placement.frame_width, image.placement.frame_height};
  }
  if (film) {
    json["film"] = {{"job", film->info.job_name},
                    {"frame", film->info.frame},
                    {"held", share_held(*film)},
                    {"missing", what_is_missing(*film)}};
  }
  json["texts"] = Json::object();
  for (const auto& [name, value] : texts_of(path)) {
    if (is_told(name)) json["texts"][name] = value;
  }
  json["channels"] = Json::array();
  for (const ChannelFacts& facts : facts_of(image)) {
    json["channels"].push_back({{"name", facts.name},
                                {"least", facts.least},
                                {"mean", facts.mean},
                                {"most", facts.most},
                                {"not_finite", facts.not_finite}});
  }
  return json;
}

int tell(const std::vector<std::string>& paths, bool json) {
  Json all = Json::array();
  for (const std::string& path : paths) {
    const auto image = core::read_image_file(path);
    if (!image) {
      print_error(image.error().in("hyades info"));
      return kExitRefused;
    }
    std::optional<core::FilmFile> film;
    if (core::read_film_info(path)) {
      auto read = core::read_film_exr(path);
      if (!read) {
        print_error(read.error().in("hyades info"));
        return kExitRefused;
      }
      film = std::move(*read);
    }
    if (json) {
      all.push_back(as_json(path, *image, film));
    } else {
      print(path, *image, film);
    }
  }
  if (json) {
    std::printf("%s\n", all.dump(2, ' ', true, Json::error_handler_t::replace).c_str());
  }
  return 0;
}

}  // namespace

int info_command(int argc, char** argv) {
  CLI::App app("tells what is in a picture or a film", "hyades info");
  std::vector<std::string> paths;
  bool json = false;
  app.add_option("pictures", paths, "EXR, film EXR, PNG, JPEG, TIFF, HDR, ...")->required();
  app.add_flag("--json", json, "print a list of objects as JSON");
  app.footer(
      "examples:\n"
      "  hyades info shot.0007.exr\n"
      "  hyades info shot.0007.film.exr --json\n"
      "exit status: 0 fine, 2 wrong arguments, or a picture that cannot be read.");
  if (const auto status = parse_command_line(app, argc, argv)) return *status;
  return tell(paths, json);
}

}  // namespace hyades::cli
