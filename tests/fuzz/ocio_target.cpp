// A configuration of OpenColorIO and the tables beside it, which a coordinator's finisher opens:
// our own look through its text, and the library's readers behind it. The first byte says which of
// them the rest is.

#include <array>
#include <cstdlib>
#include <fstream>

#include "core/finish/display_transform.h"
#include "core/job/ocio_files.h"
#include "tests/fuzz/fuzz.h"
#include "tests/support/temp_folder.h"

namespace hyades::fuzz {
namespace {

constexpr std::array kTables = {"spi1d", "spi3d", "spimtx", "cube", "csp", "3dl", "lut",
                                "ctf",   "clf",   "cc",     "ccc",  "cdl", "vf",  "mga"};

std::string config_with(const std::string& source) {
  return "ocio_profile_version: 2\nsearch_path: .\nroles: {scene_linear: light, default: light}\n"
         "displays:\n  Screen:\n    - !<View> {name: Bent, colorspace: bent}\n"
         "colorspaces:\n  - !<ColorSpace> {name: light}\n  - !<ColorSpace>\n    name: bent\n"
         "    from_scene_reference: !<FileTransform> {src: " +
         source + ", interpolation: linear}\n";
}

constexpr const char* kTable =
    "Version 1\nFrom 0.0 1.0\nLength 3\nComponents 1\n{\n0.0\n0.25\n1.0\n}\n";
constexpr const char* kCube =
    "LUT_3D_SIZE 2\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n1 0 1\n0 1 1\n1 1 1\n";

void put(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

/// The first byte of an input that is a table of kind `i`; 0 is a configuration.
char kind(size_t i) { return static_cast<char>(i + 1); }

}  // namespace

std::vector<std::string> seeds() {
  return {std::string(1, '\0') + config_with("table.spi1d"), kind(0) + std::string(kTable),
          kind(3) + std::string(kCube)};
}

bool try_input(std::string_view input) {
  if (input.empty()) return false;
  const size_t which = static_cast<unsigned char>(input[0]);
  const std::string rest(input.substr(1));
  for (const std::string& file : core::ocio_file_candidates(rest)) {
    if (file.empty()) std::abort();
  }
  const test::TempFolder folder;
  const std::string config = folder.file("config.ocio");
  if (which == 0) {
    put(folder.file("table.spi1d"), kTable);
    put(config, rest);
  } else {
    const std::string table = std::string("table.") + kTables[(which - 1) % kTables.size()];
    put(folder.file(table), rest);
    put(config, config_with(table));
  }
  core::ColorDesc color;
  color.config = "config.ocio";
  return core::open_display_transform(config, color).ok();
}

}  // namespace hyades::fuzz
