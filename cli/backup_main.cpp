// `hyades backup`, `hyades restore`, `hyades migrate`: what a coordinator keeps, as one file and
// back, or moved into a database and back.
#include <cstdio>
#include <string>

#include <CLI/CLI.hpp>

#include "cli/command_line.h"
#include "cli/program.h"
#include "coordinator/backup/backup.h"
#include "coordinator/shared_state/migrate_farm.h"
#include "core/base/machine.h"
#include "core/base/printable.h"
#include "core/base/text.h"

namespace {

using hyades::coordinator::BackupCount;

constexpr int kBadArguments = 2;

/// Exit status, after a line that says what came of it.
int tell(const char* command, const hyades::core::Result<BackupCount>& done,
         const std::string& what) {
  if (!done) {
    std::fprintf(stderr, "%s: %s\n", command, done.error().message.c_str());
    return 1;
  }
  std::printf("%s: %s files, %s\n", what.c_str(), hyades::core::format_count(done->files).c_str(),
              hyades::core::format_bytes(done->bytes).c_str());
  for (const std::string& file : done->left_out) {
    std::printf("left out, as no job can have made it: %s\n",
                hyades::core::printable(file).c_str());
  }
  return 0;
}

int backup_command(int argc, char** argv) {
  CLI::App app("Writes what a coordinator keeps into one file; the coordinator may be running.",
               "hyades backup");
  std::string data;
  std::string to;
  app.add_option("--data", data, "the coordinator's folder")->required();
  app.add_option("-o,--output", to, "the tar file")->required()->type_name("FILE");
  app.footer(
      "examples:\n  hyades backup --data /var/lib/hyades -o /backup/hyades.tar\n"
      "Run it as the coordinator's user. The file appears when it is whole.\n"
      "exit status: 0 done, 1 it could not be written, 2 wrong arguments");
  if (const auto status = hyades::cli::parse_command_line(app, argc, argv, kBadArguments)) {
    return *status;
  }
  return tell("hyades backup", hyades::coordinator::write_backup(data, to), to);
}

int restore_command(int argc, char** argv) {
  CLI::App app("Makes a coordinator's folder out of a backup.", "hyades restore");
  std::string from;
  std::string data;
  app.add_option("backup", from, "the tar file that 'hyades backup' has written")->required();
  app.add_option("--data", data, "the new folder: not there yet, or empty")->required();
  app.footer(
      "examples:\n  hyades restore /backup/hyades.tar --data /var/lib/hyades\n"
      "Every file is checked against its digest; the folder appears when it is whole.\n"
      "exit status: 0 done, 1 the backup is torn or damaged, or could not be read, 2 wrong "
      "arguments");
  if (const auto status = hyades::cli::parse_command_line(app, argc, argv, kBadArguments)) {
    return *status;
  }
  return tell("hyades restore", hyades::coordinator::restore_backup(from, data), data);
}

int migrate_command(int argc, char** argv) {
  CLI::App app(
      "Moves what a coordinator keeps in its folder into a database that several coordinators "
      "share, or back. No coordinator may run.",
      "hyades migrate");
  hyades::coordinator::FarmHomes homes;
  bool back = false;
  app.add_option("--data", homes.folder, "the coordinator's folder")->required();
  app.add_option("--state", homes.database, "postgresql://USER@HOST/DATABASE")
      ->envname("HYADES_STATE")
      ->required();
  app.add_option("--files", homes.files,
                 "the folder beside the database, which may be that of --data")
      ->required();
  app.add_flag("--back", back, "from the database into the folder");
  app.footer(
      "examples:\n  hyades migrate --data /var/lib/hyades --state postgresql://hyades@db/hyades "
      "--files /shared/hyades\n"
      "The farm stays where it was until all of it is copied.\n"
      "exit status: 0 done, 1 it could not be done, 2 wrong arguments");
  if (const auto status = hyades::cli::parse_command_line(app, argc, argv, kBadArguments)) {
    return *status;
  }
  const auto done = back ? hyades::coordinator::migrate_to_folder(homes)
                         : hyades::coordinator::migrate_to_database(homes);
  if (!done) {
    std::fprintf(stderr, "hyades migrate: %s\n", done.error().message.c_str());
    return 1;
  }
  std::printf("%s: %s film logs (%s), %s files copied\n",
              back ? homes.folder.c_str() : homes.files.c_str(),
              hyades::core::format_count(done->logs).c_str(),
              hyades::core::format_bytes(done->log_bytes).c_str(),
              hyades::core::format_count(done->files).c_str());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  hyades::core::ignore_file_size_signal();
  constexpr hyades::cli::ProgramCommand kCommands[] = {
      {"backup", backup_command}, {"restore", restore_command}, {"migrate", migrate_command}};
  return hyades::cli::run_program(kCommands, argc, argv);
}
