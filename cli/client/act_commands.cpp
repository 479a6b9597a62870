#include <cstdint>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "cli/client/client_app.h"
#include "cli/client/find_job.h"
#include "cli/client/show.h"
#include "cli/client_commands.h"
#include "cli/number_range.h"
#include "core/base/text.h"

namespace hyades::cli {
namespace {

using Action = std::function<Outcome(FarmClient&, uint64_t id, v1::Job& after)>;

/// Does `action` to each of the jobs called `names`; the first failure's exit status, after all
/// were tried.
int for_each_job(const ClientApp& app, const std::vector<std::string>& names, Namesakes namesakes,
                 bool json, const Action& action) {
  const auto client = app.connect();
  if (!client) return kBadArguments;
  int worst = kDone;
  Json list = Json::array();
  for (const std::string& name : names) {
    uint64_t id = 0;
    v1::Job job;
    Outcome failure = find_job(*client, name, namesakes, id);
    if (!failure) failure = action(*client, id, job);
    if (failure) {
      const int status = app.report(*failure);
      if (worst == kDone) worst = status;
      if (status == kNoAnswer) break;
      continue;
    }
    if (json) {
      list.push_back(to_json(job));
    } else if (job.state() == v1::JOB_STATE_CANCELLED) {
      std::printf(
          "job %lu (%s) is cancelled at %s, %u of %s done: hyades retry %lu goes on from "
          "there\n",
          id, core::printable(job.name()).c_str(),
          percent(job.samples_done(), job.samples()).c_str(), job.frames_done(),
          core::counted(job.frames(), "frame").c_str(), id);
    } else if (job.state() != v1::JOB_STATE_UNSPECIFIED) {
      std::printf("job %lu (%s) is %s, priority %d\n", id, core::printable(job.name()).c_str(),
                  job_look(job).c_str(), job.priority());
    } else {
      std::printf("job %lu is deleted\n", id);
    }
  }
  if (json) print_json(list);
  return worst;
}

/// Adds the options, and acts on each of the jobs that the command line names.
int for_each_job(ClientApp& app, Namesakes namesakes, int argc, char** argv, const Action& action) {
  std::vector<std::string> names;
  bool json = false;
  app.app()
      .add_option("jobs", names,
                  namesakes == Namesakes::open ? "their ids, or names that only one (open) job has"
                  : namesakes == Namesakes::failed
                      ? "their ids, or names that only one (failed or cancelled) job has"
                      : "their ids, or names that only one job has")
      ->required();
  app.app().add_flag("--json", json, "print the jobs as JSON (field id)");
  const std::string words = std::string("hyades ") + app.command();
  app.give_examples({words + " perlin-sphere", words + " 12 13 --json"});
  if (const auto status = app.parse(argc, argv)) return *status;
  return for_each_job(app, names, namesakes, json, action);
}

v1::JobRequest ask_of(uint64_t id) {
  v1::JobRequest request;
  request.set_job(id);
  return request;
}

int act(const char* command, const char* description, const char* method, int argc, char** argv,
        Namesakes namesakes = Namesakes::open) {
  ClientApp app(command, description);
  return for_each_job(app, namesakes, argc, argv,
                      [&](FarmClient& client, uint64_t id, v1::Job& after) {
                        v1::JobResponse response;
                        auto failure = client.call(method, ask_of(id), response);
                        after = response.job();
                        return failure;
                      });
}

}  // namespace

int pause_command(int argc, char** argv) {
  return act("pause", "Stops leasing units of jobs; those that are out go on.", "Jobs/Pause", argc,
             argv);
}

int resume_command(int argc, char** argv) {
  return act("resume", "Lets paused jobs go on.", "Jobs/Resume", argc, argv);
}

int cancel_command(int argc, char** argv) {
  return act("cancel", "Ends jobs; frames that are finished stay.", "Jobs/Cancel", argc, argv);
}

int retry_command(int argc, char** argv) {
  return act("retry",
             "Renders again the failed frames of jobs, or all that a cancelled job has left.",
             "Jobs/Retry", argc, argv, Namesakes::failed);
}

int delete_command(int argc, char** argv) {
  ClientApp app("delete", "Forgets jobs that have ended, with their films and outputs.");
  return for_each_job(app, Namesakes::none, argc, argv,
                      [](FarmClient& client, uint64_t id, v1::Job& after) {
                        after.set_id(id);
                        v1::DeleteJobResponse response;
                        return client.call("Jobs/Delete", ask_of(id), response);
                      });
}

int priority_command(int argc, char** argv) {
  ClientApp app("priority", "Changes the priority of a job; higher goes first.");
  std::string name;
  int32_t priority = 0;
  bool json = false;
  app.app().add_option("job", name, "its id, or the name of the only one (open)")->required();
  app.app()
      .add_option("priority", priority, "the new priority (write -- before a negative one)")
      ->check(in_range(-1'000'000, 1'000'000))
      ->required();
  app.app().add_flag("--json", json, "print the job as JSON (field id)");
  app.give_examples({"hyades priority perlin-sphere 10", "hyades priority 12 -- -5"});
  if (const auto status = app.parse(argc, argv)) return *status;
  return for_each_job(app, {name}, Namesakes::open, json,
                      [&](FarmClient& client, uint64_t id, v1::Job& after) {
                        v1::SetPriorityRequest request;
                        request.set_job(id);
                        request.set_priority(priority);
                        v1::JobResponse response;
                        auto failure = client.call("Jobs/SetPriority", request, response);
                        after = response.job();
                        return failure;
                      });
}

}  // namespace hyades::cli
