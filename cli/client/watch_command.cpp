#include "cli/client/client_app.h"
#include "cli/client/commands.h"
#include "cli/client/find_job.h"
#include "cli/client/watch.h"

namespace hyades::cli {

int watch_command(int argc, char** argv) {
  ClientApp app("watch", "Shows how a job gets on, until it has ended.");
  std::string job;
  bool quiet = false;
  app.app().add_option("job", job, "its id, or the name of the only one (open)")->required();
  app.app().add_flag("--quiet", quiet, "show no progress, only wait");
  app.app().footer(
      "exit status: 0 the job is done, 1 some of its frames failed, 6 it was cancelled,\n"
      "130 Ctrl-C (the job goes on); others: docs/client.md");
  if (const auto status = app.parse(argc, argv)) return *status;
  const auto client = app.connect();
  if (!client) return kBadArguments;
  uint64_t id = 0;
  if (auto failure = find_job(*client, job, Namesakes::open, id)) return app.report(*failure);
  if (auto failure = watch_job(*client, id, quiet)) return app.report(*failure);
  return kDone;
}

}  // namespace hyades::cli
