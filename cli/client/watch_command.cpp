#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "cli/address_option.h"
#include "cli/client/client_app.h"
#include "cli/client/find_job.h"
#include "cli/client/watch.h"
#include "cli/client_commands.h"

namespace hyades::cli {

int watch_command(int argc, char** argv) {
  ClientApp app("watch", "Shows how a job gets on, until it has ended.");
  std::string job;
  bool quiet = false;
  std::string display;
  app.app().add_option("job", job, "its id, or the name of the only one (open)")->required();
  app.app().add_flag("-q,--quiet", quiet, "show no progress, only wait");
  app.app()
      .add_option("--display", display,
                  "HOST:PORT of the viewer tev: shows the frames there while they are rendered, "
                  "with all their layers (tev listens on 127.0.0.1:14158)")
      ->check(address_error);
  app.app().footer(
      "examples:\n"
      "  hyades watch perlin-sphere\n"
      "  hyades watch 12 --display 127.0.0.1:14158\n"
      "exit status: 0 the job is done, 1 some of its frames failed, 6 it was cancelled,\n"
      "130 Ctrl-C (the job goes on); others: docs/client.md");
  if (const auto status = app.parse(argc, argv)) return *status;
  const auto client = app.connect();
  if (!client) return kBadArguments;
  uint64_t id = 0;
  if (auto failure = find_job(*client, job, Namesakes::open, id)) return app.report(*failure);
  std::optional<Viewer> viewer;
  std::optional<FilmDisplay> films;
  if (!display.empty()) {
    auto own = app.connect_impatiently();
    if (!own) return kBadArguments;
    viewer.emplace(display);
    films.emplace(std::move(own), *viewer, id);
  }
  const Outcome failure = watch_job(*client, id, quiet, nullptr, films ? &*films : nullptr,
                                    viewer ? &*viewer : nullptr);
  return failure ? app.report(*failure) : kDone;
}

}  // namespace hyades::cli
