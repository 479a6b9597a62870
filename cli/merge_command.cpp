#include "cli/film_commands.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <string>
#include <vector>

#include "cli/command_line.h"
#include "cli/join_films.h"
#include "cli/written_file.h"
#include "core/base/text.h"
#include "core/film/film_exr.h"

namespace hyades::cli {
namespace {

struct MergeOptions {
  std::vector<std::string> inputs;
  std::string output;
  WrittenFile written;
};

void declare_merge(CLI::App& app, MergeOptions& options) {
  app.add_option("films", options.inputs, "film EXRs of the same frame of the same job")
      ->required();
  app.add_option("-o,--output", options.output, "where to write the joined film")
      ->required()
      ->type_name("FILE");
  declare_written_file(app, options.written);
  app.footer(
      "examples:\n"
      "  hyades merge north.0007.exr south.0007.exr -o film.0007.exr\n"
      "'hyades finish job.yaml' joins the films of all frames and writes the job's pictures.\n"
      "Films that were merged in any order, or by way of other films, are the same to the last "
      "bit. Refused are films of different render keys, frames, sizes, crops, sample counts or "
      "classes of machines, and films that hold the same samples.\n"
      "exit status: 0 fine, 2 wrong arguments, or films that cannot be read or do not fit.");
}

int merge_error(const std::string& message) {
  std::fprintf(stderr, "hyades merge: %s\n", message.c_str());
  return kExitRefused;
}

int merge(const MergeOptions& options) {
  if (const auto may = options.written.check(options.output); !may) {
    return merge_error(may.error().message);
  }
  const auto whole = join_films(options.inputs);
  if (!whole) return merge_error(whole.error().message);
  if (const core::Status written = core::write_film_exr(options.output, *whole); !written) {
    return merge_error(written.error().message);
  }
  if (options.written.quiet) return 0;
  std::printf("%s: frame %d of %s: %s, %s\n", options.output.c_str(), whole->info.frame,
              whole->info.job_name.c_str(), core::counted(options.inputs.size(), "film").c_str(),
              share_held(*whole).c_str());
  if (const std::string missing = what_is_missing(*whole); !missing.empty()) {
    std::printf("missing: %s\n", missing.c_str());
  }
  return 0;
}

}  // namespace

int merge_command(int argc, char** argv) {
  CLI::App app("joins films of the same frame into one", "hyades merge");
  MergeOptions options;
  declare_merge(app, options);
  if (const auto status = parse_command_line(app, argc, argv)) return *status;
  return merge(options);
}

}  // namespace hyades::cli
