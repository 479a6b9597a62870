#include "cli/film_commands.h"
#include "cli/program.h"
#include "core/base/machine.h"

int main(int argc, char** argv) {
  using namespace hyades::cli;
  hyades::core::ignore_file_size_signal();
  constexpr ProgramCommand kCommands[] = {
      {"compare", compare_command}, {"contact-sheet", contact_sheet_command},
      {"convert", convert_command}, {"info", info_command},
      {"denoise", denoise_command}, {"encode", encode_command},
      {"finish", finish_command},   {"merge", merge_command},
      {"relight", relight_command}, {"video", finish_video_command},
  };
  return run_program(kCommands, argc, argv);
}
