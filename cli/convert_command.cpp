#include <string>

#include <CLI/CLI.hpp>

#include "cli/command_line.h"
#include "cli/film_commands.h"
#include "cli/rewrite_picture.h"

namespace hyades::cli {
namespace {

struct ConvertOptions {
  std::string input;
  std::string layer = "beauty";
  ShownOutput shown;
  WrittenFile written;
};

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
  const auto choose = [&](const core::Image&, core::OutputDesc& output) {
    if (options.layer != "beauty") output.layers = {options.layer};
    return core::Status();
  };
  return rewrite_picture("hyades convert", options.input, options.shown, options.written, choose);
}

}  // namespace hyades::cli
