#pragma once

#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <span>
#include <string>

namespace hyades::cli {

/// A command of a program: argv[0] is the program, argv[1] the command's name.
struct ProgramCommand {
  const char* name;
  int (*run)(int argc, char** argv);
};

/// The exit status of a command that has ended with `status`: 1 where not all that it has printed
/// has arrived, on a full disk, say, which is told. A reader that has gone wants no more.
inline int printed_all(int status) {
  errno = 0;
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return status;
  const std::string why = errno != 0 ? std::string(": ") + std::strerror(errno) : "";
  pollfd reader{STDOUT_FILENO, POLLOUT, 0};
  if (::poll(&reader, 1, 0) == 1 && (reader.revents & POLLERR) != 0) return status;
  std::fprintf(stderr, "hyades: cannot write standard output%s\n", why.c_str());
  return status != 0 ? status : 1;
}

/// Runs the command that argv[1] names, with argv shifted so that argv[0] is the command.
inline int run_program(std::span<const ProgramCommand> commands, int argc, char** argv) {
  const std::string name = argc > 1 ? argv[1] : "";
  for (const ProgramCommand& command : commands) {
    if (name == command.name) return printed_all(command.run(argc - 1, argv + 1));
  }
  std::fprintf(stderr, "%s: there is no command '%s'; run it through 'hyades'\n", argv[0],
               name.c_str());
  return 2;
}

}  // namespace hyades::cli
