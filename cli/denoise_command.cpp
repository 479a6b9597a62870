#include "cli/film_commands.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "cli/command_line.h"
#include "cli/shown_output.h"
#include "cli/written_file.h"
#include "core/base/fp_mode.h"
#include "core/finish/denoise.h"
#include "core/finish/picture.h"
#include "core/image/read_image.h"

namespace hyades::cli {
namespace {

struct DenoiseOptions {
  std::string input;
  std::string denoiser = "auto";
  int threads = 0;
  ShownOutput shown;
  WrittenFile written;
};

void declare_denoise(CLI::App& app, DenoiseOptions& options) {
  app.add_option("picture", options.input,
                 "EXR with the layers beauty and, best, variance, albedo, normal and alpha; or a "
                 "film EXR")
      ->required();
  declare_shown_output(app, options.shown);
  declare_written_file(app, options.written);
  app.add_option(
         "--with", options.denoiser,
         "features (our own filter), oidn (Open Image Denoise, where its library is found), "
         "or auto: the latter where it is there")
      ->check(CLI::IsMember({"auto", "features", "oidn"}))
      ->capture_default_str();
  app.add_option("--threads", options.threads, "how many; 0: as many as the machine has")
      ->capture_default_str();
  app.footer(
      "examples:\n  hyades denoise shot.0007.exr -o shot.0007.png --tone-map filmic\n"
      "A job does it by itself with 'denoise: true'.\n"
      "exit status: 0 fine, 2 wrong arguments, or a picture that cannot be read or written.");
}

int denoise_error(const std::string& message) {
  std::fprintf(stderr, "hyades denoise: %s\n", message.c_str());
  return kExitRefused;
}

core::Denoiser denoiser_of(const std::string& name) {
  return core::find_denoiser(name).value_or(core::Denoiser::automatic);
}

/// Beauty becomes `clean`; alpha stays.
core::Image with_alpha_of(const core::Image& picture, const core::Image& clean) {
  const int alpha = picture.find_channel("A");
  if (alpha < 0) return clean;
  core::Image out = core::make_image(clean.width, clean.height, {"R", "G", "B", "A"});
  out.placement = clean.placement;
  const size_t pixels = clean.data.size() / 3;
  for (size_t i = 0; i < pixels; ++i) {
    std::copy_n(&clean.data[3 * i], 3, &out.data[4 * i]);
    out.data[4 * i + 3] = picture.data[i * picture.channels.size() + static_cast<size_t>(alpha)];
  }
  return out;
}

int denoise_file(const DenoiseOptions& options) {
  const core::FpMode mode;
  if (const auto may = options.written.check(options.shown.output.file); !may) {
    return denoise_error(may.error().message);
  }
  const auto picture = core::read_image_file(options.input);
  if (!picture) return denoise_error(picture.error().message);
  const auto clean = core::denoise(*picture, denoiser_of(options.denoiser), options.threads);
  if (!clean) return denoise_error(clean.error().in(options.input).message);
  const core::Image out = with_alpha_of(*picture, *clean);
  const core::OutputDesc output = options.shown.desc(options.input);
  if (const auto written = core::write_output(output, out, output.file); !written)
    return denoise_error(written.error().message);
  options.written.tell(output.file);
  return 0;
}

}  // namespace

int denoise_command(int argc, char** argv) {
  CLI::App app("takes the noise out of a picture", "hyades denoise");
  DenoiseOptions options;
  declare_denoise(app, options);
  if (const auto status = parse_command_line(app, argc, argv)) return *status;
  return denoise_file(options);
}

}  // namespace hyades::cli
