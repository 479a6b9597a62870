#include <array>
#include <cstdio>
#include <span>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "cli/command_line.h"
#include "cli/load_job.h"
#include "cli/media_facts.h"
#include "cli/media_maker.h"
#include "cli/media_swatch.h"
#include "cli/media_text.h"
#include "cli/number_range.h"
#include "cli/written_file.h"
#include "core/base/atomic_file.h"
#include "core/base/parallel.h"

namespace hyades::cli {
namespace {

constexpr size_t kMostInARow = 16;

int wrong(const core::Error& error) {
  std::fprintf(stderr, "hyades media: %s\n", error.message.c_str());
  return kBadInput;
}

LengthUnit unit_called(const std::string& name) {
  return {name, name == "mm" ? 0.001F : name == "cm" ? 0.01F : 1.0F};
}

/// The media of all `names`, presets and files; all presets for none.
core::Result<std::vector<KnownMedium>> media_called(const std::vector<std::string>& names,
                                                    const LengthUnit& unit) {
  if (names.empty()) return known_presets();
  std::vector<KnownMedium> all;
  for (const std::string& name : names) {
    auto found = find_media(name, unit.metres);
    if (!found) return found.error();
    all.insert(all.end(), found->begin(), found->end());
  }
  return all;
}

int list(bool json, const LengthUnit& unit) {
  std::fputs((json ? media_json(known_presets(), unit) : media_table(known_presets())).c_str(),
             stdout);
  return 0;
}

int show(const std::vector<std::string>& names, bool json, const LengthUnit& unit) {
  const auto media = media_called(names, unit);
  if (!media) return wrong(media.error());
  if (json) {
    std::fputs(media_json(*media, unit).c_str(), stdout);
    return 0;
  }
  for (size_t i = 0; i < media->size(); ++i) {
    std::printf("%s%s", i > 0 ? "\n" : "", medium_sheet((*media)[i], unit).c_str());
  }
  return 0;
}

int make(const MediumDescription& wanted, const std::string& file, bool json,
         const WrittenFile& written, const LengthUnit& unit) {
  if (const auto may = written.check(file); !may) return wrong(may.error());
  const auto medium = make_described(wanted, unit.metres);
  if (!medium) return wrong(medium.error());
  const bool as_json = json || file.ends_with(".json");
  const std::string text =
      as_json ? media_file_json(*medium, unit) : media_file_yaml(*medium, unit);
  if (file.empty()) {
    std::fputs(text.c_str(), stdout);
    return 0;
  }
  if (auto done = core::write_file(file, std::as_bytes(std::span(text))); !done) {
    print_error(done.error().in("hyades media"));
    return 1;
  }
  written.tell(file + ", for jobs whose unit is " + unit.name);
  return 0;
}

int swatch(const std::vector<std::string>& names, SwatchOptions options, const WrittenFile& written,
           const LengthUnit& unit) {
  if (const auto may = written.check(options.file); !may) return wrong(may.error());
  const auto media = media_called(names, unit);
  if (!media) return wrong(media.error());
  if (media->size() > kMostInARow) {
    return wrong({std::to_string(media->size()) + " media, expected at most " +
                  std::to_string(kMostInARow) + " in a row"});
  }
  options.size *= unit.metres;
  options.quiet = written.quiet;
  if (const auto done = render_swatch(*media, options); !done) return wrong(done.error());
  written.tell(options.file);
  return 0;
}

/// What the command line says, whichever of the four it calls.
struct MediaOptions {
  std::string unit = "m";
  bool json = false;
  std::vector<std::string> names;
  std::string file;
  MediumDescription wanted;
  WrittenFile written;
  SwatchOptions swatch;
  float size = 0.0F;  ///< of a ball of the swatch, in `unit`; 0: nothing was said
};

void add_unit(CLI::App& command, MediaOptions& said) {
  command
      .add_option("--units", said.unit, "unit of length of all numbers, files' too: mm, cm or m")
      ->check(CLI::IsMember({"mm", "cm", "m"}))
      ->capture_default_str();
}

const CLI::App* declare_list(CLI::App& app, MediaOptions& said) {
  CLI::App& command = *app.add_subcommand("list", "lists the presets");
  command.add_flag("--json", said.json, "as JSON, with all numbers");
  add_unit(command, said);
  return &command;
}

const CLI::App* declare_show(CLI::App& app, MediaOptions& said) {
  CLI::App& command =
      *app.add_subcommand("show", "tells the numbers of presets and of files of media");
  command.add_option("media", said.names, "presets, or files (.json, .yaml); without: all presets");
  command.add_flag("--json", said.json, "as JSON");
  add_unit(command, said);
  return &command;
}

const CLI::App* declare_make(CLI::App& app, MediaOptions& said) {
  CLI::App& command = *app.add_subcommand("make", "makes a file of media from another description");
  command.add_option("--name", said.wanted.name, "what it is called")->capture_default_str();
  command.add_option("--preset", said.wanted.preset,
                     "a measured medium, or a file of one; with --scale");
  command.add_option("--albedo", said.wanted.albedo,
                     "single-scattering albedo, with --mean-free-path");
  command.add_option("--mean-free-path", said.wanted.mean_free_path, "how far light goes");
  command.add_option("--color", said.wanted.color, "a colour such as 0.9,0.6,0.4 or '#d8c8a8'");
  command.add_option("--depth", said.wanted.depth, "white light has the colour after this way");
  command.add_option("--radius", said.wanted.radius,
                     "a thick body has the colour, and light loses its direction over this way");
  command.add_option("--g", said.wanted.g, "mean cosine (default: 0, or the preset's)")
      ->check(in_range(-0.999F, 0.999F));
  command
      .add_option("--index", said.wanted.index,
                  "index of refraction (default: 1.33, or the preset's)")
      ->check(in_range(0.01F, 100.0F));
  command
      .add_option("--scale", said.wanted.scale,
                  "multiplies absorption and scattering: concentration")
      ->check(in_range(0.0F, 1e9F));
  command.add_option("-o,--output", said.file,
                     "file (.json or .yaml; default: YAML on standard output)");
  command.add_flag("--json", said.json, "JSON, whatever the file is called");
  declare_written_file(command, said.written);
  add_unit(command, said);
  return &command;
}

void declare_swatch(CLI::App& app, MediaOptions& said) {
  CLI::App& command = *app.add_subcommand("swatch", "renders a row of balls of media");
  command.add_option("media", said.names, "presets, or files (.json, .yaml)")->required();
  command.add_option("-o,--output", said.swatch.file, "the picture (.png, .jpg or .exr)")
      ->required()
      ->type_name("FILE");
  command.add_option("--size", said.size, "diameter of a ball (default: 20 mm)")
      ->check(in_range(1e-6F, 1e6F));
  command.add_option("--samples", said.swatch.samples, "samples per pixel")
      ->check(in_range(1U, 1U << 20U))
      ->capture_default_str();
  command.add_option("--threads", said.swatch.threads, "rendering threads")
      ->check(in_range(1, 1024))
      ->capture_default_str();
  declare_written_file(command, said.written);
  add_unit(command, said);
}

}  // namespace

/// `hyades media list|show|make|swatch`.
int media_command(int argc, char** argv) {
  CLI::App app("Measured media: their numbers and colours; media files from other descriptions.",
               "hyades media");
  app.require_subcommand(1);
  MediaOptions said;
  said.swatch.threads = core::hardware_threads();
  const CLI::App* lists = declare_list(app, said);
  const CLI::App* shows = declare_show(app, said);
  const CLI::App* makes = declare_make(app, said);
  declare_swatch(app, said);
  app.footer(
      "examples:\n"
      "  hyades media list\n"
      "  hyades media show skim-milk --units mm\n"
      "  hyades media make --name wax --color 0.9,0.7,0.4 --radius 4,2,1 --units mm --output "
      "wax.json\n"
      "  hyades media make --name squash --color '#e08030' --depth 0.05\n"
      "  hyades media swatch espresso cream wax.json --units mm --output row.png\n"
      "exit status: 0 done, 1 a file could not be written, 2 the arguments or files are wrong");
  if (const auto status = parse_command_line(app, argc, argv, kBadInput)) return *status;
  const LengthUnit in = unit_called(said.unit);
  if (lists->parsed()) return list(said.json, in);
  if (shows->parsed()) return show(said.names, said.json, in);
  if (makes->parsed()) return make(said.wanted, said.file, said.json, said.written, in);
  said.swatch.size = said.size > 0.0F ? said.size : 0.02F / in.metres;
  return swatch(said.names, said.swatch, said.written, in);
}

}  // namespace hyades::cli
