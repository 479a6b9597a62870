#include "cli/client_commands.h"
#include "cli/program.h"
#include "core/base/machine.h"

int main(int argc, char** argv) {
  using namespace hyades::cli;
#define HYADES_ROW(word, about, help) {#word, word##_command},
  constexpr ProgramCommand kCommands[] = {HYADES_CLIENT_COMMANDS(HYADES_ROW)};
#undef HYADES_ROW
  hyades::core::ignore_file_size_signal();
  return run_program(kCommands, argc, argv);
}
