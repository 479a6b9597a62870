#include "cli/film_commands.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cli/command_line.h"
#include "cli/number_range.h"
#include "cli/written_file.h"
#include "core/finish/contact_sheet.h"
#include "core/image/read_image.h"
#include "core/image/write_image.h"
#include "core/job/output_path.h"

namespace hyades::cli {
namespace {

struct ContactSheetOptions {
  std::vector<std::string> pictures;
  std::string output;
  int columns = 4;
  int width = 320;
  WrittenFile written;
};

int contact_sheet_error(const std::string& message) {
  std::fprintf(stderr, "hyades contact-sheet: %s\n", message.c_str());
  return kExitRefused;
}

/// What a picture is called: its file's name with the frame's number, without ".png" and, of
/// `render --preview`, ".preview".
std::string name_of(const std::string& path) {
  constexpr std::string_view kPreview = ".preview";
  std::string name = std::filesystem::path(path).stem().string();
  if (name.ends_with(kPreview)) name.resize(name.size() - kPreview.size());
  return name;
}

int make_contact_sheet(const ContactSheetOptions& options) {
  if (core::file_extension(options.output) != ".png") {
    return contact_sheet_error("--output: expected a file that ends with .png, got '" +
                               options.output + "'");
  }
  if (const auto may = options.written.check(options.output); !may) {
    return contact_sheet_error(may.error().message);
  }
  std::vector<core::ContactPrint> prints;
  for (const std::string& path : options.pictures) {
    auto picture = core::read_image_file(path);
    if (!picture) return contact_sheet_error(picture.error().message);
    prints.push_back({name_of(path), std::move(*picture)});
  }
  const auto sheet = core::contact_sheet(prints, options.columns, options.width);
  if (!sheet) return contact_sheet_error(sheet.error().message);
  if (const auto written = core::write_png(options.output, *sheet); !written)
    return contact_sheet_error(written.error().message);
  options.written.tell(options.output);
  return 0;
}

}  // namespace

int contact_sheet_command(int argc, char** argv) {
  CLI::App app("puts many pictures on one sheet, with their names", "hyades contact-sheet");
  ContactSheetOptions options;
  app.add_option("pictures", options.pictures, "PNG, EXR, JPEG, ..., in their order")->required();
  app.add_option("-o,--output", options.output, "PNG to write")->required()->type_name("FILE");
  app.add_option("--columns", options.columns, "pictures in a row, about")
      ->check(in_range(1, 1000))
      ->capture_default_str();
  app.add_option("--width", options.width, "of a picture, in pixels, about")
      ->check(in_range(16, 8192))
      ->capture_default_str();
  declare_written_file(app, options.written);
  app.footer(
      "examples:\n"
      "  hyades contact-sheet out/one.png out/two.png -o sheet.png --columns 4\n"
      "exit status: 0 fine, 2 wrong arguments, or pictures that cannot be read or written.");
  if (const auto status = parse_command_line(app, argc, argv)) return *status;
  return make_contact_sheet(options);
}

}  // namespace hyades::cli
