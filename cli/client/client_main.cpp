#include "cli/client/commands.h"
#include "cli/program.h"
#include "core/base/machine.h"

int main(int argc, char** argv) {
  using namespace hyades::cli;
  constexpr ProgramCommand kCommands[] = {
      {"submit", submit_command},       {"jobs", jobs_command},
      {"status", status_command},       {"watch", watch_command},
      {"fetch", fetch_command},         {"logs", logs_command},
      {"explain", explain_command},     {"pause", pause_command},
      {"resume", resume_command},       {"cancel", cancel_command},
      {"retry", retry_command},         {"priority", priority_command},
      {"delete", delete_command},       {"workers", workers_command},
      {"drain", drain_command},         {"quarantine", quarantine_command},
      {"release", release_command},     {"top", top_command},
      {"autoscale", autoscale_command}, {"trace", trace_command},
      {"token", token_command},         {"certs", certs_command},
      {"audit", audit_command},
  };
  hyades::core::ignore_file_size_signal();
  return run_program(kCommands, argc, argv);
}
