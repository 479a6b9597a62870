#include "cli/shown_output.h"

#include <charconv>
#include <cmath>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>

#include "core/finish/picture.h"
#include "core/image/read_image.h"
#include "core/image/tone_map.h"

namespace hyades::cli {
namespace {

/// What an EXR of ours says of itself; 0 where it says nothing.
float own_exposure(const std::string& path) {
  const auto texts = core::read_exr_texts(path);
  if (!texts) return 0.0F;  // another kind of picture
  for (const auto& [name, value] : *texts) {
    float stops = 0.0F;
    if (name != core::kExposureText) continue;
    const auto read = std::from_chars(value.data(), value.data() + value.size(), stops);
    if (read.ec == std::errc() && std::abs(stops) <= 64.0F) return stops;
  }
  return 0.0F;
}

}  // namespace

core::OutputDesc ShownOutput::desc(const std::string& of) const {
  core::OutputDesc desc = output;
  desc.exposure = exposure ? *exposure : own_exposure(of);
  return desc;
}

void declare_shown_output(CLI::App& app, ShownOutput& shown) {
  app.add_option("-o,--output", shown.output.file, "EXR, PNG, JPEG or TIFF to write")
      ->required()
      ->type_name("FILE");
  const auto curves = core::tone_curve_names();
  app.add_option("--tone-map", shown.output.tone_map, "for PNG, JPEG and TIFF")
      ->check(CLI::IsMember(std::vector<std::string>(curves.begin(), curves.end())))
      ->capture_default_str();
  app.add_option("--exposure", shown.exposure,
                 "stops, for PNG, JPEG and TIFF (default: what an EXR says that its job shows it "
                 "with)");
}

}  // namespace hyades::cli
