#include "cli/rewrite_picture.h"

#include <cstdio>
#include <filesystem>
#include <system_error>

#include "cli/command_line.h"
#include "core/base/fp_mode.h"
#include "core/finish/picture.h"
#include "core/image/read_image.h"

namespace hyades::cli {

int rewrite_picture(const char* command, const std::string& input, const ShownOutput& shown,
                    const WrittenFile& written, const PictureChange& change) {
  const core::FpMode mode;
  const auto refuse = [&](const std::string& message) {
    std::fprintf(stderr, "%s: %s\n", command, message.c_str());
    return kExitRefused;
  };
  std::error_code none;
  if (std::filesystem::equivalent(input, shown.output.file, none)) {
    return refuse(input + ": would be replaced by itself, expected another file as -o");
  }
  if (const auto may = written.check(shown.output.file); !may) return refuse(may.error().message);
  auto picture = core::read_image_file(input);
  if (!picture) return refuse(picture.error().message);
  core::OutputDesc output = shown.desc(input);
  if (const auto changed = change(*picture, output); !changed) {
    return refuse(changed.error().in(input).message);
  }
  if (const auto done = core::write_output(output, *picture, output.file); !done) {
    return refuse(done.error().in(input).message);
  }
  written.tell(output.file);
  return 0;
}

}  // namespace hyades::cli
