#pragma once

#include <cstdio>
#include <span>
#include <string>

namespace hyades::cli {

/// A command of a program: argv[0] is the program, argv[1] the command's name.
struct ProgramCommand {
  const char* name;
  int (*run)(int argc, char** argv);
};

/// Runs the command that argv[1] names, with argv shifted so that argv[0] is the command.
inline int run_program(std::span<const ProgramCommand> commands, int argc, char** argv) {
  const std::string name = argc > 1 ? argv[1] : "";
  for (const ProgramCommand& command : commands) {
    if (name == command.name) return command.run(argc - 1, argv + 1);
  }
  std::fprintf(stderr, "%s: there is no command '%s'; run it through 'hyades'\n", argv[0],
               name.c_str());
  return 2;
}

}  // namespace hyades::cli
