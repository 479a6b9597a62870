// `hyades new`: a job to start from.
#include <cstdio>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/command_line.h"
#include "cli/written_file.h"
#include "core/base/atomic_file.h"
#include "core/base/printable.h"
#include "core/base/text.h"
#include "core/job/output_path.h"
#include "core/job/read_values.h"

namespace hyades::cli {
namespace {

/// <COMMAND>, <NAME>, <MARKS> (for the frame's number, or nothing), <FRAMES> and <TURN> are filled
/// in.
constexpr std::string_view kJob =
    R"yaml(# <COMMAND> renders it; 'hyades check' tells what is wrong in it, and what it costs.
# docs/job.md describes every key. Lengths are metres, y is up, colours are linear [r, g, b], "#d8c8a8" or 3200K.
hyades: 1
name: "<NAME>"
<FRAMES>
film: {size: [960, 540]}
sampling: {samples: 128}  # or {noise: 0.05, samples: 1024}: as many as each part of the picture needs

camera:
  look_from: [3.2, 1.9, 4.4]
  look_at: [0, 0.7, 0]
  fov: 34                 # degrees, from top to bottom
  # aperture: {f_stop: 4}  # blurs what is not in focus
  # focus: glass

textures:
  tiles: {type: checker, scale: 24, a: [0.55, 0.5, 0.45], b: [0.2, 0.19, 0.2]}
  # photo: {type: image, file: photo.jpg}

materials:
  floor: {type: glossy, color: tiles, reflectiveness: 0.2, glossiness: 0.8}
  glass: {type: dielectric, ior: 1.5}
  brass: {type: conductor, metal: brass, roughness: 0.15}
  clay: {type: lambert, color: [0.7, 0.25, 0.15]}

objects:
  ground: {shape: rectangle, size: [40, 40], material: floor}
  glass: {shape: sphere, radius: 0.7, at: [-0.9, 0.7, 0.3], material: glass}
  block: {shape: box, size: [0.9, 0.9, 0.9], material: clay, transform: [{rotate_y: <TURN>}], at: [0.5, 0.45, -0.6]}
  ball: {shape: sphere, radius: 0.35, at: [0.75, 0.35, 0.75], material: brass}
  # statue: {mesh: statue.ply, material: clay}   # also .obj; whole scenes: {gltf: statue.glb}
  lamp: {shape: sphere, radius: 1.8, at: [-4, 6.5, 4.5], emit: {color: 3800K, power: 2600}}  # watts

environment: {color: [0.5, 0.65, 0.9], strength: 0.9}  # or {image: sky.hdr}

outputs:
  - {file: <NAME><MARKS>.exr, layers: [beauty, alpha, albedo, normal]}
  - {file: <NAME><MARKS>.png, tone_map: filmic, denoise: true}
)yaml";

constexpr std::string_view kVideo = "  - {file: <NAME>.mp4, tone_map: filmic, denoise: true}\n";

std::string replaced(std::string text, std::string_view what, std::string_view with) {
  for (size_t at = text.find(what); at != std::string::npos;
       at = text.find(what, at + with.size())) {
    text.replace(at, what.size(), with);
  }
  return text;
}

/// The command that renders a file, as it is typed.
std::string render_of(const std::string& file) {
  return "hyades render " + core::shell_word(file.front() == '-' ? "./" + file : file);
}

std::string job_of(const std::filesystem::path& file, bool animated) {
  std::string text(kJob);
  if (animated) text += kVideo;
  text = replaced(text, "<FRAMES>",
                  animated ? "frames: {range: 1-48, fps: 24, shutter: 0.5}"
                           : "# frames: {range: 1-48, fps: 24}  # of an animation");
  text = replaced(text, "<TURN>", animated ? "\"= 45 * t\"" : "30");
  text = replaced(text, "<MARKS>", animated ? ".####" : "");
  text = replaced(text, "<NAME>", core::valid_name(file.stem().string()));
  return replaced(text, "<COMMAND>", render_of(file.filename().string()));
}

}  // namespace

int new_command(int argc, char** argv) {
  CLI::App app("Writes a job with comments, to start from.", "hyades new");
  std::string file = "job.yaml";
  bool animated = false;
  WrittenFile written;
  app.add_option("job", file, "the job to write")->capture_default_str();
  app.add_flag("--animated", animated, "of 48 frames, and a video of them");
  declare_written_file(app, written);
  app.footer(
      "examples:\n"
      "  hyades new shot.yaml\n"
      "  hyades new turn.yaml --animated\n"
      "exit status: 0 written, 1 it could not be, 2 the arguments are wrong, or the file is there");
  if (const auto status = parse_command_line(app, argc, argv)) return *status;
  const std::string extension = core::file_extension(file);
  if (extension != ".yaml" && extension != ".yml") {
    std::fprintf(stderr, "hyades new: %s: expected NAME.yaml\n", core::printable(file).c_str());
    return kExitRefused;
  }
  if (core::printable(file) != file) {
    std::fprintf(stderr, "hyades new: %s: expected a name of UTF-8 without control characters\n",
                 core::printable(file).c_str());
    return kExitRefused;
  }
  if (const auto may = written.check(file); !may) {
    print_error(may.error().in("hyades new"));
    return kExitRefused;
  }
  const std::string text = job_of(file, animated);
  if (const auto done = core::write_file(file, std::as_bytes(std::span(text))); !done) {
    print_error(done.error().in("hyades new"));
    return 1;
  }
  written.tell(file + ": " + render_of(file) + " --preview shows it");
  return 0;
}

}  // namespace hyades::cli
