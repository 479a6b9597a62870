#include "cli/blend_job.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <ios>
#include <optional>
#include <sstream>
#include <system_error>
#include <utility>
#include <vector>

#include "cli/scene_options.h"
#include "core/base/child_process.h"
#include "core/base/machine.h"
#include "core/base/printable.h"
#include "core/job/output_path.h"

namespace hyades::cli {

using core::Error;
using core::Result;

namespace {

namespace fs = std::filesystem;

/// Blender's path; an error where it is not here.
Result<std::string> find_blender() {
  const char* named = std::getenv("HYADES_BLENDER");
  const std::string wanted = named != nullptr && *named != '\0' ? named : "blender";
  if (wanted.find('/') != std::string::npos) {
    std::error_code none;
    if (fs::is_regular_file(wanted, none)) return wanted;
  } else if (auto found = core::find_program(wanted)) {
    return *found;
  }
  return Error{wanted +
               " was not found: expected Blender (3.4 or later) on PATH, or its path in the "
               "environment variable HYADES_BLENDER; workers need none"};
}

/// The add-on's script: of an installation, or of the source tree that was built in; or below the
/// folder that HYADES_BLENDER_ADDON names.
Result<std::string> find_script() {
  const std::string here = core::program_folder();
  const char* named = std::getenv("HYADES_BLENDER_ADDON");
  // Anybody may write above a program that was unpacked in /tmp.
  std::string beside;
  if (here.ends_with("/libexec/hyades/")) beside = here + "../../share/hyades/blender";
  if (here.ends_with("/build/bin/")) beside = here + "../../blender";
  for (const std::string& folder : {std::string(named != nullptr ? named : ""), beside}) {
    const std::string script = folder + "/hyades_render/export_command.py";
    std::error_code none;
    if (!folder.empty() && fs::is_regular_file(script, none)) return script;
  }
  return Error{
      "Hyades' add-on for Blender was not found beside this program: expected the folder that "
      "holds hyades_render in the environment variable HYADES_BLENDER_ADDON"};
}

std::string text_of(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

/// What Blender complains of in what it has printed; all of that where it is nothing known.
std::string why_of(const std::string& printed) {
  const std::string mark = "\nError: ";
  const size_t at = printed.find(mark);
  if (at == std::string::npos) return printed;
  const size_t begin = at + mark.size();
  const std::string line = printed.substr(begin, printed.find('\n', begin) - begin);
  return "Blender cannot read it: " + core::printable(line);
}

std::vector<std::string> lines_of(const std::string& path) {
  std::ifstream file(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

}  // namespace

bool is_blend_file(const std::string& path) { return core::file_extension(path) == ".blend"; }

Result<std::unique_ptr<BlendJob>> BlendJob::make(const std::string& path,
                                                 const std::string& frames) {
  // Blender would go on with another scene.
  if (!std::ifstream(path, std::ios::binary).good()) {
    return Error{path + ": there is no such file, or it cannot be read"};
  }
  const auto blender = find_blender();
  if (!blender) return blender.error();
  const auto script = find_script();
  if (!script) return script.error();
  auto temporary = TemporaryFolder::make("hyades-blend-");
  if (!temporary) return temporary.error();
  const std::string folder = (*temporary)->path();
  std::unique_ptr<BlendJob> job(new BlendJob(std::move(*temporary)));
  // Not the user's settings, and none of the scene's own scripts.
  auto child = core::ChildProcess::start(
      *blender, {"--background", "--factory-startup", "--disable-autoexec", "-noaudio",
                 fs::absolute(path).string(), "--python-exit-code", "1", "--python", *script, "--",
                 folder, frames});
  if (!child) return child.error();
  const core::Status done = child->finish([] { return core::Status(); });
  std::string why = text_of(folder + "/error.txt");
  while (!why.empty() && why.back() == '\n') why.pop_back();
  if (!why.empty()) return Error{path + ": " + why};
  std::error_code none;
  if (!fs::exists(job->path(), none)) {
    return Error{path + ": " + (done ? "Blender made no job of it" : why_of(done.error().message))};
  }
  print_notes(lines_of(folder + "/notes.txt"));
  return job;
}

}  // namespace hyades::cli
