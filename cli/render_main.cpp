#include "cli/program.h"
#include "core/base/machine.h"

namespace hyades::cli {
int bench_command(int argc, char** argv);
int check_command(int argc, char** argv);
int finish_job_command(int argc, char** argv);
int import_command(int argc, char** argv);
int media_command(int argc, char** argv);
int new_command(int argc, char** argv);
int render_command(int argc, char** argv);
int replay_command(int argc, char** argv);
int strategies_command(int argc, char** argv);
int video_command(int argc, char** argv);
}  // namespace hyades::cli

int main(int argc, char** argv) {
  using namespace hyades::cli;
  hyades::core::ignore_file_size_signal();
  constexpr ProgramCommand kCommands[] = {
      {"render", render_command},         {"check", check_command},
      {"replay", replay_command},         {"import", import_command},
      {"media", media_command},           {"bench", bench_command},
      {"strategies", strategies_command}, {"video", video_command},
      {"finish", finish_job_command},     {"new", new_command},
  };
  return run_program(kCommands, argc, argv);
}
