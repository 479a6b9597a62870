#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "cli/client/client_app.h"
#include "cli/client/show.h"
#include "cli/client_commands.h"
#include "core/base/text.h"
#include "core/base/wall_clock.h"

namespace hyades::cli {
namespace {

/// How long ago a moment was, by this machine's clock.
std::string ago(int64_t ms) {
  return core::format_duration(1e-3 *
                               static_cast<double>(std::max<int64_t>(core::wall_ms() - ms, 0)));
}

void print_workers(const v1::WorkersResponse& response) {
  std::vector<std::vector<std::string>> rows = {{"id", "name", "state", "threads", "units out",
                                                 "done", "failed", "class", "portable", "tags",
                                                 "heard", "reason"}};
  std::vector<v1::Worker> workers(response.workers().begin(), response.workers().end());
  std::stable_sort(workers.begin(), workers.end(), [](const v1::Worker& a, const v1::Worker& b) {
    return is_before(a.name(), b.name());
  });
  for (const v1::Worker& worker : workers) {
    rows.push_back({std::to_string(worker.id()), worker.name(), state_name(worker.state()),
                    std::to_string(worker.threads()), std::to_string(worker.leased()),
                    core::format_count(worker.units_done()), std::to_string(worker.units_failed()),
                    worker.worker_class().substr(0, 12), worker.portable_class().substr(0, 12),
                    fmt::format("{}", fmt::join(worker.tags(), ",")),
                    ago(worker.heard_ms()) + " ago", worker.reason()});
  }
  print_table(rows);
}

/// What is said besides of a name that no worker has.
std::string near_workers(FarmClient& client, const std::string& name) {
  v1::WorkersResponse all;
  if (client.workers(all)) return {};
  std::vector<std::string> names;
  for (const v1::Worker& worker : all.workers()) names.push_back(worker.name());
  const std::string near = core::did_you_mean(name, names);
  return near.empty() ? " (hyades workers lists them)" : near;
}

int act_on_worker(const char* command, const char* description, const char* method, int argc,
                  char** argv) {
  ClientApp app(command, description);
  std::vector<std::string> names;
  std::string reason;
  bool json = false;
  app.app().add_option("workers", names, "their ids, or names that only one has")->required();
  app.app().add_option("--reason", reason, "why, for people; kept");
  app.app().add_flag("--json", json, "print the workers as JSON (field id)");
  const std::string words = std::string("hyades ") + command;
  app.give_examples({words + " north-3", words + " 4 5 --reason 'a new kernel'"});
  if (const auto status = app.parse(argc, argv)) return *status;
  const auto client = app.connect();
  if (!client) return kBadArguments;
  int worst = kDone;
  Json list = Json::array();
  for (const std::string& name : names) {
    v1::WorkerRequest request;
    request.set_worker(name);
    request.set_reason(reason);
    v1::WorkerResponse response;
    if (auto failure = client->call(method, request, response)) {
      if (failure->code == kUnknown) failure->message += near_workers(*client, name);
      const int status = app.report(*failure);
      if (worst == kDone) worst = status;
      if (status == kNoAnswer) break;
      continue;
    }
    const v1::Worker& worker = response.worker();
    if (json) {
      list.push_back(to_json(worker));
    } else {
      std::printf("worker %lu (%s) is %s\n", worker.id(), core::printable(worker.name()).c_str(),
                  state_name(worker.state()).c_str());
    }
  }
  if (json) print_json(list);
  return worst;
}

}  // namespace

int workers_command(int argc, char** argv) {
  ClientApp app("workers", "Lists the farm's workers.");
  bool names = false;
  bool json = false;
  app.app().add_flag("--names", names, "print their names alone, one a line");
  app.app().add_flag("--json", json, "print them as JSON (field id)");
  app.give_examples({"hyades workers", "hyades workers --json"});
  if (const auto status = app.parse(argc, argv)) return *status;
  const auto client = app.connect();
  if (!client) return kBadArguments;
  v1::WorkersResponse response;
  if (auto failure = client->workers(response)) return app.report(*failure);
  if (json) {
    print_json_rows(response.workers());
    std::printf("\n");
  } else if (names) {
    for (const v1::Worker& worker : response.workers()) {
      std::printf("%s\n", core::printable(worker.name()).c_str());
    }
  } else if (response.workers().empty()) {
    std::printf("no workers: start some with 'hyades worker'\n");
  } else {
    print_workers(response);
  }
  return kDone;
}

int drain_command(int argc, char** argv) {
  return act_on_worker("drain",
                       "Gives workers no more work; they deliver what they have and leave.",
                       "Farm/DrainWorker", argc, argv);
}

int quarantine_command(int argc, char** argv) {
  return act_on_worker("quarantine",
                       "Gives workers no more work and refuses what they have not delivered yet.",
                       "Farm/QuarantineWorker", argc, argv);
}

int release_command(int argc, char** argv) {
  return act_on_worker("release", "Ends the quarantine of workers.", "Farm/ReleaseWorker", argc,
                       argv);
}

}  // namespace hyades::cli
