#include <cstdio>
#include <filesystem>
#include <string>
#include <system_error>

#include <CLI/CLI.hpp>

#include "cli/command_line.h"
#include "cli/film_commands.h"
#include "cli/shown_output.h"
#include "cli/written_file.h"
#include "core/base/fp_mode.h"
#include "core/finish/picture.h"
#include "core/image/read_image.h"

namespace hyades::cli {
namespace {

struct ConvertOptions {
  std::string input;
  std::string layer = "beauty";
  ShownOutput shown;
  WrittenFile written;
};

int convert(const ConvertOptions& options) {
  const core::FpMode mode;
  const auto refuse = [](const std::string& message) {
    std::fprintf(stderr, "hyades convert: %s\n", message.c_str());
    return kExitRefused;
  };
  std::error_code none;
  if (std::filesystem::equivalent(options.input, options.shown.output.file, none)) {
    return refuse(options.input + ": would be replaced by itself, expected another file as -o");
  }
  if (const auto may = options.written.check(options.shown.output.file); !may) {
    return refuse(may.error().message);
  }
  const auto picture = core::read_image_file(options.input);
  if (!picture) return refuse(picture.error().message);
  core::OutputDesc output = options.shown.desc(options.input);
  if (options.layer != "beauty") output.layers = {options.layer};
  const auto written = core::write_output(output, *picture, output.file);
  if (!written) return refuse(written.error().in(options.input).message);
  options.written.tell(output.file);
  return 0;
}

}  // namespace

int convert_command(int argc, char** argv) {
  CLI::App app("Writes a picture as another one, as a display shows it", "hyades convert");
  ConvertOptions options;
  app.add_option("picture", options.input, "EXR, a film EXR, or any other picture")->required();
  declare_shown_output(app, options.shown);
  declare_written_file(app, options.written);
  app.add_option("--layer", options.layer, "which of an EXR's layers")->capture_default_str();
  app.footer(
      "examples:\n"
      "  hyades convert shot.0007.exr -o shot.0007.png --tone-map filmic --exposure 1\n"
      "  hyades convert shot.0007.exr -o depth.png --layer depth\n"
      "'hyades info' tells which layers there are.\n"
      "exit status: 0 fine, 2 wrong arguments, or a picture that cannot be read or written.");
  if (const auto status = parse_command_line(app, argc, argv)) return *status;
  return convert(options);
}

}  // namespace hyades::cli
