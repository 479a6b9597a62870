// `hyades autoscale`: has a command start and end workers as the queue needs them.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "cli/client/client_app.h"
#include "cli/client/find_job.h"
#include "cli/client/finish_time.h"
#include "cli/client/scale_call.h"
#include "cli/client/scale_decision.h"
#include "cli/client_commands.h"
#include "cli/duration_option.h"
#include "cli/number_range.h"
#include "core/base/printable.h"

namespace hyades::cli {
namespace {

using Clock = std::chrono::steady_clock;

/// How often a command is called again though nothing has changed, s: machines get lost.
constexpr double kRefresh = 600;
/// Threads of a worker where none is there to ask.
constexpr double kUsualThreads = 8;

volatile std::sig_atomic_t g_end = 0;
void on_signal(int) { g_end = 1; }
bool ended() { return g_end != 0; }

Clock::duration seconds(double value) {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(value));
}

struct Options {
  std::string exec;
  uint32_t least = 0;
  uint32_t most = 0;
  std::string finish_by;
  double within = 3600;
  std::optional<double> money;
  std::optional<double> price;
  double interval = 60;
  double down_after = 300;
  double exec_limit = 60;
  uint32_t threads = 0;  ///< of a worker; 0: as those that are there
  std::vector<std::string> tags;
  bool once = false;
  bool dry = false;
};

/// What the coordinator says.
struct Seen {
  std::vector<v1::Job> jobs;
  std::vector<v1::Worker> workers;  ///< that are there and have the tags
};

bool has_all(const google::protobuf::RepeatedPtrField<std::string>& tags,
             const std::vector<std::string>& wanted) {
  return std::all_of(wanted.begin(), wanted.end(), [&](const std::string& tag) {
    return std::find(tags.begin(), tags.end(), tag) != tags.end();
  });
}

Outcome look(FarmClient& client, const Options& options, Seen& seen) {
  seen = {};
  std::vector<v1::Job> jobs;
  if (auto failure = list_all_jobs(client, false, "", jobs)) return failure;
  for (const v1::Job& job : jobs) {
    if (job.state() != v1::JOB_STATE_RUNNING) continue;
    // Workers with these tags can do it.
    const bool ours = std::all_of(job.tags().begin(), job.tags().end(), [&](const auto& tag) {
      return std::find(options.tags.begin(), options.tags.end(), tag) != options.tags.end();
    });
    if (ours) seen.jobs.push_back(job);
  }
  v1::WorkersResponse workers;
  if (auto failure = client.workers(workers)) return failure;
  for (const v1::Worker& worker : workers.workers()) {
    if (worker.state() == v1::WORKER_STATE_GONE || !has_all(worker.tags(), options.tags)) continue;
    seen.workers.push_back(worker);
  }
  return std::nullopt;
}

/// What is left of a job, in seconds of a thread, by what its samples have taken so far; nothing
/// where none is done.
std::optional<double> work_left(const v1::Job& job) {
  if (job.samples_done() >= job.samples()) return 0;
  if (job.samples_done() == 0 || !(job.core_seconds() > 0)) return std::nullopt;
  return job.core_seconds() / static_cast<double>(job.samples_done()) *
         static_cast<double>(job.samples() - job.samples_done());
}

class Autoscaler {
 public:
  explicit Autoscaler(const Options& options)
      : options_(options), plan_(seconds(options.down_after)) {}

  /// Decides, and calls the command where that is due. False where the command failed.
  bool step(const Seen& seen, Clock::time_point now) {
    if (looked_ && options_.price) {
      const double hours = std::chrono::duration<double>(now - *looked_).count() / 3600;
      spent_ += hours * static_cast<double>(seen.workers.size()) * *options_.price;
    }
    looked_ = now;
    const ScaleDecision decision = plan_.next(state_of(seen), now);
    const uint32_t wanted = decision.wanted;
    const bool changed = !called_ || *called_ != wanted;
    const bool stale = called_at_ && now - *called_at_ >= seconds(kRefresh);
    if (!changed && !stale) return true;
    if (changed) {
      say(fmt::format("wanted {}, there are {}: {}", wanted, seen.workers.size(), decision.why));
    }
    if (options_.dry) {
      called_ = wanted;
      return true;
    }
    called_at_ = now;
    const auto done = call_scaler(options_.exec, wanted, options_.exec_limit, ended);
    if (done) {
      called_ = wanted;
      return true;
    }
    called_.reset();  // tried again at the next interval
    if (!ended()) say("the command failed, it is tried again: " + done.error().message);
    return false;
  }

  static void say(const std::string& text) {
    std::fprintf(stderr, "hyades autoscale: %s\n", core::printable(text).c_str());
    std::fflush(stderr);
  }

 private:
  ScaleState state_of(const Seen& seen) const {
    ScaleState state;
    state.least = options_.least;
    state.most = options_.most;
    state.interval = options_.interval;
    state.price = options_.price;
    state.money_left = options_.money.value_or(0) - spent_;
    double threads = 0;
    for (const v1::Worker& worker : seen.workers) threads += worker.threads();
    state.threads_per_worker = options_.threads > 0 ? options_.threads
                               : seen.workers.empty()
                                   ? kUsualThreads
                                   : threads / static_cast<double>(seen.workers.size());
    const auto now = static_cast<double>(std::time(nullptr));
    for (const v1::Job& job : seen.jobs) {
      ScaleJob left;
      left.core_seconds = work_left(job);
      left.max_workers = job.max_workers();
      left.seconds_left = deadline_of(job) - now;
      state.jobs.push_back(left);
    }
    return state;
  }

  /// Unix seconds. A time of day is the first of its kind after the submission, so that a command
  /// that runs for weeks has every night's.
  double deadline_of(const v1::Job& job) const {
    const double submitted = 1e-3 * static_cast<double>(job.submitted_ms());
    if (options_.finish_by.empty()) return submitted + options_.within;
    const auto moment = parse_moment(options_.finish_by, static_cast<std::time_t>(submitted));
    return moment ? static_cast<double>(*moment) : submitted;
  }

  const Options options_;
  ScalePlan plan_;
  std::optional<Clock::time_point> looked_;
  double spent_ = 0;
  std::optional<uint32_t> called_;  ///< what the command was told last, if it did not fail
  std::optional<Clock::time_point> called_at_;
};

int run(const ClientApp& app, FarmClient& client, const Options& options) {
  Autoscaler scaler(options);
  std::string told;
  while (!ended()) {
    const auto begin = Clock::now();
    Seen seen;
    bool well = true;
    if (auto failure = look(client, options, seen)) {
      if (options.once || failure->code == kRefused) return app.report(*failure);
      // Nothing is known, so nothing is changed.
      if (failure->message != told) Autoscaler::say(failure->message);
      told = failure->message;
    } else {
      told.clear();
      well = scaler.step(seen, Clock::now());
    }
    if (options.once) return well ? kDone : kFailed;
    while (!ended() && Clock::now() - begin < seconds(options.interval)) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  }
  return kDone;
}

void declare_autoscale(CLI::App& words, Options& options) {
  words.add_option("--exec", options.exec,
                   "the command, run by a shell: the number is its last argument, and in "
                   "HYADES_WANTED");
  words.add_option("--min", options.least, "fewest workers")
      ->check(in_range(0U, 1'000'000U))
      ->capture_default_str();
  words.add_option("--max", options.most, "most workers")
      ->check(in_range(1U, 1'000'000U))
      ->required();
  auto* by = words.add_option("--finish-by", options.finish_by,
                              "when all shall be done: 18:00 (the first one after a job's "
                              "submission), 2026-03-01T18:00");
  add_duration(words, "--within", options.within,
               "how long after its submission a job shall be done (default: 1h)", 60)
      ->excludes(by);
  auto* money = words
                    .add_option("--max-cost", options.money,
                                "the most that workers may cost while this command runs; then "
                                "there are only --min")
                    ->check(in_range(0.0, 1e12));
  words.add_option("--price", options.price, "of a worker and hour, in the money of --max-cost")
      ->check(in_range(1e-9, 1e9))
      ->needs(money);
  add_duration(words, "--interval", options.interval,
               "between two looks at the queue; the command is called no more often (default: 1m)",
               0.1);
  add_duration(words, "--down-after", options.down_after,
               "fewer workers only when fewer were enough for so long (default: 5m)");
  add_duration(words, "--exec-limit", options.exec_limit,
               "a command that takes longer is ended, and tried again (default: 1m)", 0.1);
  words
      .add_option("--threads", options.threads,
                  "of a worker (default: as those that are there have, else 8)")
      ->check(in_range(1U, 4096U));
  words
      .add_option("--tags", options.tags,
                  "of the workers that the command starts: jobs that ask for others do not count")
      ->delimiter(',')
      ->allow_extra_args(false);
  words.add_flag("--once", options.once, "decide once and end");
  words.add_flag("--dry-run", options.dry, "only tell what would be wanted");
  words.footer(
      "examples:\n"
      "  hyades autoscale --max 50 --within 2h --exec 'kubectl scale deployment/worker "
      "--replicas'\n"
      "  hyades autoscale --max 20 --finish-by 08:00 --max-cost 40 --price 0.35 --exec ./resize\n"
      "  hyades autoscale --max 50 --once --dry-run\n"
      "docs/client.md tells how it decides. exit status: 0 after Ctrl-C or SIGTERM, with --once 1 "
      "where the command failed; 2 wrong arguments, 3 no coordinator (--once), 4 no token");
}

/// What is wrong with options that do not fit each other; empty: nothing.
std::string contradiction(const Options& options) {
  if (options.exec.empty() && !options.dry) return "--exec is missing (or --dry-run)";
  if (options.least > options.most) return "--min is more than --max";
  if (options.money && !options.price) return "--max-cost: expected --price beside it";
  if (options.finish_by.empty()) return {};
  const auto moment = parse_moment(options.finish_by, std::time(nullptr));
  return moment ? std::string() : "--finish-by " + moment.error().message;
}

}  // namespace

int autoscale_command(int argc, char** argv) {
  ClientApp app(
      "autoscale",
      "Calls a command with the number of workers that the queue needs, when it changes.");
  Options options;
  declare_autoscale(app.app(), options);
  if (const auto status = app.parse(argc, argv)) return *status;
  if (const std::string wrong = contradiction(options); !wrong.empty()) {
    return app.report({kBadArguments, wrong});
  }
  const auto client = app.connect();
  if (!client) return kBadArguments;
  struct sigaction action {};
  action.sa_handler = on_signal;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  return run(app, *client, options);
}

}  // namespace hyades::cli
