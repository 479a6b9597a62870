// `hyades COMMAND ...` starts the program that knows the command, as git does, so that a
// coordinator never loads a renderer and --help answers at once.

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "cli/client_commands.h"
#include "cli/completion.h"
#include "cli/program.h"
#include "core/base/machine.h"
#include "core/base/text.h"
#include "core/base/version.h"

namespace {

struct Command {
  const char* name;
  const char* program;  ///< null: this one
  const char* help;
};

struct Group {
  const char* title;
  std::vector<Command> commands;
};

const std::vector<Group>& groups() {
#define HYADES_ROW(word, about, help) {#word, "hyades-client", help},
  static const std::vector<Group> all = {
      {"rendering",
       {{"new", "hyades-render", "write a job with comments, to start from"},
        {"render", "hyades-render",
         "render a job, or a scene or mesh of another tool, on this machine"},
        {"check", "hyades-render",
         "read a job, report every mistake in it, and what it would cost"},
        {"import", "hyades-render", "write a scene of another tool, or a script, as a job"},
        {"finish", "hyades-render",
         "write a job's pictures out of films that others have rendered"},
        {"merge", "hyades-film", "join films of the same frame"},
        {"video", "hyades-render",
         "make a job's videos of the pictures that its frames have left"}}},
#ifdef HYADES_FARM
      {"jobs of a farm", {HYADES_JOB_COMMANDS(HYADES_ROW)}},
      {"a farm",
       {{"coordinator", "hyades-coordinator",
         "own jobs, lease their units to workers, merge the films"},
        {"worker", "hyades-worker", "render for a coordinator"},
        {"backup", "hyades-backup", "write what a coordinator keeps into one file, while it runs"},
        {"restore", "hyades-backup", "make a coordinator's folder out of a backup"},
        {"migrate", "hyades-backup",
         "move what a coordinator keeps into a database, for several of them, or back"},
        HYADES_FARM_COMMANDS(HYADES_ROW)}},
#endif
      {"pictures",
       {{"info", "hyades-film", "what is in a picture or a film"},
        {"convert", "hyades-film", "write a picture as another one, as a display shows it"},
        {"denoise", "hyades-film", "take the noise out of a picture"},
        {"relight", "hyades-film", "make light groups of a picture brighter or darker"},
        {"compare", "hyades-film",
         "compare two pictures, statistically where they carry variances"},
        {"contact-sheet", "hyades-film", "put many pictures on one sheet"}}},
      {"tools",
       {{"media", "hyades-render",
         "measured media: their numbers and colours; media files from other descriptions"},
        {"replay", "hyades-render", "trace one sample of one pixel and tell its path in words"},
        {"strategies", "hyades-render",
         "what each strategy of bidirectional path tracing brings to a picture"},
        {"bench", "hyades-render",
         "measure this machine: 'bench scaling' renders a job with 1..N threads"},
        {"completion", nullptr, "print a script that completes commands in bash, zsh or fish"}}},
  };
#undef HYADES_ROW
  return all;
}

void print_help() {
  std::printf("hyades %s: a path-tracing render farm\n\nusage: hyades COMMAND [ARGUMENTS]\n",
              hyades::core::kVersion);
  for (const Group& group : groups()) {
    std::printf("\n%s:\n", group.title);
    for (const Command& command : group.commands) {
      std::printf("  %-13s %s\n", command.name, command.help);
    }
  }
  std::printf(
      "\nexamples:\n"
      "  hyades render jobs/quickstart/job.yaml\n"
      "  hyades render robot.glb --samples 64\n"
      "  hyades check jobs/cornell/job.yaml\n"
      "\n'hyades COMMAND --help' or 'hyades help COMMAND' tells more about a command, 'hyades "
      "version' "
      "which version this is. docs/job.md describes jobs.\n");
}

/// `help COMMAND...` as `COMMAND... --help`; other arguments as they are.
std::vector<char*> spelled_out(int argc, char** argv) {
  std::vector<char*> words(argv, argv + argc);
  if (argc > 2 && std::string_view(argv[1]) == "help") {
    static char help[] = "--help";
    words.erase(words.begin() + 1);
    words.push_back(help);
  }
  words.push_back(nullptr);
  return words;
}

/// The command's exit status; where another program knows it, this one becomes that.
int start(const Command& command, int argc, std::vector<char*>& words) {
  if (command.program == nullptr) {
    return hyades::cli::printed_all(hyades::cli::completion_command(argc - 1, words.data() + 1));
  }
  const std::string program = hyades::core::program_folder() + command.program;
  execv(program.c_str(), words.data());
  std::fprintf(stderr, "hyades: %s could not be started: %s\n", program.c_str(),
               std::strerror(errno));
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<char*> words = spelled_out(argc, argv);
  const std::string name = argc > 1 ? words[1] : "--help";
  if (name == "--help" || name == "-h" || name == "help") {
    print_help();
    return hyades::cli::printed_all(0);
  }
  if (name == "--version" || name == "version") {
    std::printf("hyades %s\n", hyades::core::kVersion);
    return hyades::cli::printed_all(0);
  }
  std::vector<std::string> names;
  for (const Group& group : groups()) {
    for (const Command& command : group.commands) {
      if (name == command.name) return start(command, argc, words);
      names.emplace_back(command.name);
    }
  }
  std::fprintf(stderr, "hyades: there is no command '%s'", name.c_str());
  if (const auto close = hyades::core::closest_name(name, names)) {
    std::fprintf(stderr, "; did you mean '%s'?", close->c_str());
  }
  std::fprintf(stderr, "\n'hyades --help' lists the commands\n");
  return 2;
}
