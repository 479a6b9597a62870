#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <ios>
#include <optional>
#include <ostream>
#include <string>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "cli/client/client_app.h"
#include "cli/client/find_job.h"
#include "cli/client/show.h"
#include "cli/client/trace_writer.h"
#include "cli/client_commands.h"
#include "cli/status_line.h"
#include "cli/written_file.h"
#include "core/base/io_reason.h"
#include "farm/job_state.h"

namespace hyades::cli {
namespace {

constexpr auto kLook = std::chrono::seconds(1);
constexpr auto kGlance = std::chrono::milliseconds(50);
/// Taken until there are no more: twice what a coordinator keeps
/// (coordinator/controller/timeline.h), for more may come meanwhile.
constexpr int kMostSteps = 80'000;
/// Lines of a job's log: what a coordinator keeps, and those that come meanwhile.
constexpr int kMostLines = 100'000;

volatile std::sig_atomic_t g_trace_ends = 0;

void end_trace(int) { g_trace_ends = 1; }

/// From now on Ctrl-C and SIGTERM end the following, and the document is written to its end.
void mind_signals() {
  struct sigaction action {};
  action.sa_handler = end_trace;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

void wait_for_more() {
  for (auto waited = kGlance; waited <= kLook && g_trace_ends == 0; waited += kGlance) {
    std::this_thread::sleep_for(kGlance);
  }
}

/// A job without its frames.
Outcome get_job(FarmClient& client, uint64_t id, v1::Job& job) {
  v1::ListJobsRequest request;
  request.set_ended(true);
  request.set_limit(1);
  request.set_before(id + 1);
  v1::ListJobsResponse response;
  if (auto failure = client.call("Jobs/List", request, response)) return failure;
  if (response.jobs().empty() || response.jobs(0).id() != id) {
    return Failure{kUnknown, fmt::format("there is no job {} any more", id)};
  }
  job = response.jobs(0);
  return std::nullopt;
}

/// Steps are kept in memory only. Where the coordinator does not tell when it was started, neither
/// does this; the trace is what was asked for.
void tell_what_is_lost(FarmClient& client, const v1::Job& job) {
  v1::InfoResponse coordinator;
  if (!client.call("Farm/Info", v1::InfoRequest(), coordinator) &&
      coordinator.started_ms() > job.submitted_ms()) {
    std::fprintf(stderr,
                 "the coordinator was started again after job %lu was submitted: what was done "
                 "before that is not in the trace\n",
                 job.id());
  }
}

/// All that is known of the job, and with `follow` what comes until it has ended.
Outcome write_trace(FarmClient& client, uint64_t id, bool follow, std::ostream& out,
                    TraceWriter& writer, v1::Job& job) {
  StatusLine line;
  v1::ListTimelineRequest request;
  request.set_job(id);
  for (bool begins = true;; begins = false) {
    // Asked for first: what came until the job ended is then in the steps that follow.
    if (auto failure = get_job(client, id, job)) return failure;
    v1::ListTimelineResponse page;
    int steps = 0;
    do {
      if (auto failure = client.call("Jobs/ListTimeline", request, page)) return failure;
      if (std::exchange(begins, false) && page.dropped() > 0) {
        std::fprintf(stderr,
                     "%lu older steps are not kept by the coordinator: the trace begins later\n",
                     page.dropped());
      }
      for (const v1::TimelineStep& step : page.steps()) {
        if (step.number() <= request.after()) {
          return Failure{kFailed, "the coordinator tells steps whose numbers do not grow"};
        }
        if (++steps > kMostSteps) {
          return Failure{kFailed, "the coordinator tells more steps than one keeps"};
        }
        writer.take(step);
        request.set_after(step.number());
      }
      if (line.is_due()) line.show(fmt::format("{} units", writer.units()));
    } while (page.more() && page.steps_size() > 0 && out.good());
    if (!follow || farm::has_ended(job) || !out.good()) break;
    wait_for_more();
    if (g_trace_ends != 0) return std::nullopt;
  }
  v1::LogsRequest logs;
  logs.set_job(id);
  int lines = 0;
  Outcome too_many;
  const auto failure = client.logs(logs, [&](const v1::LogLine& one) {
    if (++lines > kMostLines) {
      too_many = Failure{kFailed, "the coordinator tells more lines of a log than one keeps"};
      return false;
    }
    writer.take(one);
    return true;
  });
  return too_many ? too_many : failure;
}

}  // namespace

int trace_command(int argc, char** argv) {
  ClientApp app("trace",
                "Writes what workers and coordinator did for a job, and when, as a trace that "
                "ui.perfetto.dev shows.");
  std::string name;
  std::string file;
  bool follow = false;
  WrittenFile written;
  app.app().add_option("job", name, "its id, or its name (of several: the newest)")->required();
  app.app()
      .add_option("-o,--output", file, "the JSON file to write")
      ->required()
      ->type_name("FILE");
  app.app().add_flag("--follow", follow,
                     "stay until the job has ended: the coordinator keeps the last 40,000 steps");
  declare_written_file(app.app(), written);
  app.give_examples(
      {"hyades trace perlin-sphere -o trace.json", "hyades trace 12 --follow -o trace.json"},
      "Open the file at ui.perfetto.dev or chrome://tracing.");
  if (const auto status = app.parse(argc, argv)) return *status;
  if (const auto may = written.check(file); !may) {
    return app.report({kBadArguments, may.error().message});
  }
  const auto client = app.connect();
  if (!client) return kBadArguments;
  uint64_t id = 0;
  if (auto failure = find_job(*client, name, Namesakes::newest, id)) return app.report(*failure);
  v1::Job job;
  if (auto failure = get_job(*client, id, job)) return app.report(*failure);
  tell_what_is_lost(*client, job);
  errno = 0;
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  const auto cannot_write = [&] {
    return app.report({kFailed, "cannot write " + file + ": " + core::io_reason(errno)});
  };
  if (!out) return cannot_write();
  TraceWriter writer(out, job);
  if (follow) mind_signals();
  const Outcome failure = write_trace(*client, id, follow, out, writer, job);
  // What has come is a whole document also where the coordinator went away.
  writer.end(job);
  out.flush();
  if (!out) return cannot_write();
  if (failure) return app.report(*failure);
  if (!written.quiet) {
    std::fprintf(stderr, "wrote %s: %lu units of job %lu\n", core::printable(file).c_str(),
                 writer.units(), id);
  }
  return kDone;
}

}  // namespace hyades::cli
