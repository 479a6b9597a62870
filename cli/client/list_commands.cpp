#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "cli/client/client_app.h"
#include "cli/client/find_job.h"
#include "cli/client/show.h"
#include "cli/client_commands.h"
#include "cli/frame_range.h"
#include "core/base/text.h"
#include "core/film/black.h"
#include "farm/job_state.h"

namespace hyades::cli {
namespace {

constexpr size_t kMostEnded = 5;    ///< told by jobs without --all
constexpr size_t kMostFrames = 20;  ///< told by status without --json or --frames

std::string frames_text(const v1::Job& job) {
  std::string text = fmt::format("{}/{}", job.frames_done(), job.frames());
  if (job.frames_finishing() > 0) text += fmt::format(", {} finishing", job.frames_finishing());
  if (job.frames_failed() > 0) text += fmt::format(", {} failed", job.frames_failed());
  return text;
}

std::string left_text(const v1::Job& job) {
  return job_look(job) == "running" && job.seconds_left() >= 0
             ? core::format_time_left(job.seconds_left())
             : "-";
}

constexpr const char* kSuspect = "in doubt: a divergent worker had a part in it";

/// How long the job has been rendered; "-" of one that nobody has begun.
std::string taken_text(const v1::Job& job) {
  const auto taken = seconds_taken(job);
  return taken ? core::format_duration(*taken) : "-";
}

/// "1.25", and at the coordinator's price "1.25 (3.10)"; "-" where nothing was rendered.
std::string hours_text(const v1::Job& job) {
  const double hours = job.core_seconds() / 3600;
  if (!(hours > 0)) return "-";
  std::string text = hours < 0.01 ? "< 0.01" : fmt::format("{:.2f}", hours);
  if (job.cost() > 0) {
    text += job.cost() < 0.01 ? " (< 0.01)" : fmt::format(" ({:.2f})", job.cost());
  }
  return text;
}

/// Whether the command can do something to the job.
bool suits(const v1::Job& job, const std::string& command) {
  const bool ended = farm::has_ended(job);
  if (command == "resume") return job.state() == v1::JOB_STATE_PAUSED;
  if (command == "pause") return job.state() == v1::JOB_STATE_RUNNING;
  if (command == "cancel" || command == "priority") return !ended;
  if (command == "delete") return ended;
  if (command == "retry") {
    return job.state() == v1::JOB_STATE_CANCELLED || job.state() == v1::JOB_STATE_FAILED ||
           job.frames_failed() > 0;
  }
  return true;
}

/// What a person can call each of those that suit the command: the name, or the id where others
/// have that name too.
void print_names(const std::vector<v1::Job>& jobs, const std::string& command) {
  std::map<std::string, int> named;
  for (const v1::Job& job : jobs) ++named[job.name()];
  for (const v1::Job& job : jobs) {
    if (!suits(job, command)) continue;
    const bool alone = named[job.name()] == 1;
    std::printf("%s\n", core::printable(alone ? job.name() : std::to_string(job.id())).c_str());
  }
}

void print_jobs(const std::vector<v1::Job>& jobs) {
  const bool priced =
      std::any_of(jobs.begin(), jobs.end(), [](const v1::Job& job) { return job.cost() > 0; });
  std::vector<std::vector<std::string>> rows = {
      {"id", "name", "owner", "prio", "state", "frames", "samples", "submitted", "took", "left",
       priced ? "core-hours (cost)" : "core-hours", "reason"}};
  for (const v1::Job& job : jobs) {
    rows.push_back({std::to_string(job.id()), job.name(), job.owner(),
                    std::to_string(job.priority()), job_look(job), frames_text(job),
                    percent(job.samples_done(), job.samples()), format_time(job.submitted_ms()),
                    taken_text(job), left_text(job), hours_text(job), job.reason()});
  }
  print_table(rows);
}

void print_line(const char* name, const std::string& value) {
  std::printf("%-10s %s\n", name, core::printable(value).c_str());
}

void print_frames(const v1::GetJobResponse& response, bool all) {
  std::vector<std::vector<std::string>> rows = {
      {"frame", "state", "samples", "class", "restarts", "reason"}};
  size_t more = 0;
  for (const v1::Frame& frame : response.frames()) {
    const bool telling =
        frame.doubtful() || frame.black() ||
        (frame.state() != v1::FRAME_STATE_WAITING && frame.state() != v1::FRAME_STATE_DONE);
    if (!all && !telling) continue;
    if (!all && rows.size() > kMostFrames) {
      ++more;
      continue;
    }
    rows.push_back({std::to_string(frame.frame()), state_name(frame.state()),
                    percent(frame.samples_done(), frame.samples()),
                    frame.worker_class().substr(0, 12), std::to_string(frame.restarts()),
                    frame.doubtful() ? kSuspect
                    : frame.black()  ? core::kBlackWords
                                     : frame.reason()});
  }
  if (rows.size() == 1) return;
  std::printf("\n");
  print_table(rows);
  if (more > 0) std::printf("... and %zu more: --frames shows all\n", more);
}

void print_status(const v1::GetJobResponse& response, bool all) {
  const v1::Job& job = response.job();
  std::printf("job %lu: %s\n", job.id(), core::printable(job.name()).c_str());
  print_line("state", job_look(job) + (job.reason().empty() ? "" : ": " + job.reason()));
  print_line("owner", fmt::format("{}, priority {}", job.owner(), job.priority()));
  if (job.tags_size() > 0 || job.memory_bytes() > 0) {
    std::string needs = fmt::format("{}", fmt::join(job.tags(), ", "));
    if (job.memory_bytes() > 0) {
      needs += (needs.empty() ? "" : ", ") + core::format_bytes(job.memory_bytes()) + " of memory";
    }
    print_line("workers", "with " + needs);
  }
  print_line("frames", frames_text(job));
  print_line("samples", fmt::format("{} of {}", percent(job.samples_done(), job.samples()),
                                    core::format_count(job.samples())));
  if (job.has_noise()) {
    const std::string aim =
        job.noise_aim() > 0 ? " (aim " + core::format_noise(job.noise_aim()) + ")" : "";
    print_line("noise", core::format_noise(job.noise()) + aim);
  }
  if (job_look(job) == "running") {
    std::string now = fmt::format("{} with workers, {}", core::counted(job.leased(), "unit"),
                                  core::format_rate(job.samples_per_second(), "samples"));
    if (job.seconds_left() >= 0) now += ", " + left_text(job) + " left";
    print_line("now", now);
  }
  print_line("submitted", format_time(job.submitted_ms()));
  if (job.begun_ms() != 0) print_line("begun", format_time(job.begun_ms()));
  if (job.ended_ms() != 0) print_line("ended", format_time(job.ended_ms()));
  print_line("took", taken_text(job));
  print_line("core-hours", hours_text(job));
  print_frames(response, all);
}

void print_log_line(const v1::LogLine& line) {
  std::string text = format_time(line.time_ms());
  if (line.level() != v1::LOG_LEVEL_INFO) text += "  " + level_name(line.level());
  if (line.of_frame()) text += fmt::format("  frame {}", line.frame());
  if (!line.worker().empty()) text += "  " + core::printable(line.worker());
  std::printf("%s  %s\n", text.c_str(), core::printable(line.text()).c_str());
}

}  // namespace

int jobs_command(int argc, char** argv) {
  ClientApp app("jobs",
                "Lists the farm's open jobs and the last that have ended, the newest first.");
  bool all = false;
  bool names = false;
  bool json = false;
  std::string owner;
  std::string command;
  app.app().add_flag("--all", all, "all that have ended");
  app.app().add_option("--owner", owner, "only the jobs of this owner");
  CLI::Option* only_names = app.app().add_flag(
      "--names", names, "print their names alone, one a line: ids where several have one name");
  app.app()
      .add_option("--for", command, "only the names of those that this command can do something to")
      ->needs(only_names);
  app.app().add_flag("--json", json,
                     "print them as JSON (field id); without --all only those that are open");
  app.give_examples({"hyades jobs", "hyades jobs --all --owner ann", "hyades jobs --json"});
  if (const auto status = app.parse(argc, argv)) return *status;
  const auto client = app.connect();
  if (!client) return kBadArguments;
  std::vector<v1::Job> jobs;
  const bool latest = !all && !json && !names;
  if (auto failure = latest ? list_latest_jobs(*client, kMostEnded, owner, jobs)
                            : list_all_jobs(*client, all, owner, jobs)) {
    return app.report(*failure);
  }
  if (json) {
    print_json_rows(jobs);
    std::printf("\n");
  } else if (names) {
    print_names(jobs, command);
  } else if (jobs.empty()) {
    std::printf("no jobs\n");
  } else {
    print_jobs(jobs);
  }
  return kDone;
}

int status_command(int argc, char** argv) {
  ClientApp app("status", "Tells how a job and its frames are.");
  std::string job;
  bool all = false;
  bool json = false;
  app.app().add_option("job", job, "its id, or its name (of several: the newest)")->required();
  app.app().add_flag("--frames", all, "tell of every frame");
  app.app().add_flag("--json", json, "print the job as JSON (fields id and frame_list)");
  app.give_examples({"hyades status perlin-sphere", "hyades status 12 --frames"});
  if (const auto status = app.parse(argc, argv)) return *status;
  const auto client = app.connect();
  if (!client) return kBadArguments;
  uint64_t id = 0;
  if (auto failure = find_job(*client, job, Namesakes::newest, id)) return app.report(*failure);
  v1::GetJobResponse response;
  if (auto failure = client->get(id, response)) return app.report(*failure);
  if (!json) {
    print_status(response, all);
    return kDone;
  }
  Json out = to_json(response.job());
  out["frame_list"] = Json::array();
  const std::string text = json_line(out);
  const std::string list = "\"frame_list\":";  // in no string: its quotes would be escaped
  const size_t at = text.find(list + "[]") + list.size();
  std::printf("%s", text.substr(0, at).c_str());
  print_json_rows(response.frames());
  std::printf("%s\n", text.substr(at + 2).c_str());
  return kDone;
}

int explain_command(int argc, char** argv) {
  ClientApp app("explain", "Tells why a job does or does not get on.");
  std::string job;
  bool json = false;
  app.app().add_option("job", job, "its id, or the name of the only one (open)")->required();
  app.app().add_flag("--json", json, "print JSON (fields id and reasons)");
  app.give_examples({"hyades explain perlin-sphere"});
  if (const auto status = app.parse(argc, argv)) return *status;
  const auto client = app.connect();
  if (!client) return kBadArguments;
  uint64_t id = 0;
  if (auto failure = find_job(*client, job, Namesakes::open, id)) return app.report(*failure);
  v1::JobRequest request;
  request.set_job(id);
  v1::ExplainResponse response;
  if (auto failure = client->call("Jobs/Explain", request, response)) {
    return app.report(*failure);
  }
  if (json) {
    Json out = {{"id", id}, {"reasons", Json::array()}};
    for (const std::string& reason : response.reasons()) out["reasons"].push_back(reason);
    print_json(out);
    return kDone;
  }
  for (const std::string& reason : response.reasons())
    std::printf("%s\n", core::printable(reason).c_str());
  return kDone;
}

int logs_command(int argc, char** argv) {
  ClientApp app("logs", "Shows what has happened to a job, oldest first.");
  std::string job;
  std::string chosen;
  bool follow = false;
  bool json = false;
  app.app().add_option("job", job, "its id, or its name (of several: the newest)")->required();
  app.app()
      .add_option("--frames,--frame", chosen, "only these frames: 7,8 or 1-10 or 1-10x2")
      ->check(frame_list_error);
  app.app().add_flag("--follow", follow, "stay until the job has ended");
  app.app().add_flag("--json", json, "print one JSON object a line (field id: its number)");
  app.give_examples({"hyades logs perlin-sphere --follow", "hyades logs 12 --frames 7,8 --json"});
  if (const auto status = app.parse(argc, argv)) return *status;
  const auto client = app.connect();
  if (!client) return kBadArguments;
  v1::LogsRequest request;
  uint64_t id = 0;
  if (auto failure = find_job(*client, job, Namesakes::newest, id)) return app.report(*failure);
  std::vector<int32_t> frames;
  if (auto failure = select_frames(*client, id, chosen, frames)) return app.report(*failure);
  request.set_job(id);
  request.set_follow(follow);
  request.mutable_frames()->Add(frames.begin(), frames.end());
  const auto failure = client->logs(request, [&](const v1::LogLine& line) {
    if (json) {
      Json out = {{"id", line.number()}};
      out.update(to_json(line));
      print_json(out);
    } else {
      print_log_line(line);
    }
    std::fflush(stdout);
    return true;
  });
  return failure ? app.report(*failure) : kDone;
}

}  // namespace hyades::cli
