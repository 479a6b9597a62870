// `hyades worker`: works for a coordinator.
#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <optional>
#include <string>
#include <string_view>

#include <CLI/CLI.hpp>

#include "cli/command_line.h"
#include "cli/config_file.h"
#include "cli/duration_option.h"
#include "cli/log_options.h"
#include "cli/number_range.h"
#include "cli/peer_options.h"
#include "core/base/machine.h"
#include "core/base/parallel.h"
#include "worker/worker.h"

namespace {

using hyades::worker::Cloud;
using hyades::worker::WorkerOptions;

volatile std::sig_atomic_t g_signals = 0;

/// The first signal and when it came: milliseconds of the monotonic clock times 128, and its
/// number; 0: none yet.
std::atomic<int64_t> g_first_signal{0};
static_assert(std::atomic<int64_t>::is_always_lock_free, "a signal's handler may not wait");

/// A batch system or a container's init may tell a whole group of processes, whose parent tells its
/// child as well: the same signal within this time is still the first one.
constexpr int64_t kSameSignalMs = 1000;

/// The first signal asks for an orderly end, the second ends the process: the rendering child goes
/// with it, and what was not delivered is rendered again elsewhere.
void on_signal(int signal) {
  const int reason = errno;
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  errno = reason;
  const int64_t ms = int64_t{now.tv_sec} * 1000 + now.tv_nsec / 1'000'000;
  int64_t first = 0;
  if (g_first_signal.compare_exchange_strong(first, ms * 128 + signal)) {
    g_signals = 1;
  } else if (first % 128 != signal || ms - first / 128 >= kSameSignalMs) {
    _exit(128 + signal);
  }
}

/// Less than a second would kill healthy renderers.
std::string hang_limit_error(const std::string& text) {
  double seconds = -1;
  if (CLI::detail::lexical_cast(text, seconds) &&
      (seconds == 0 || (seconds >= 1 && seconds <= 1e6))) {
    return {};
  }
  return text + ": expected 1 to 1000000 seconds, or 0 for never";
}

/// Less than a few megabytes is meant to be something else: 8, say, for 8G.
std::string memory_error(const std::string& text) {
  uint64_t bytes = 0;
  if (CLI::detail::lexical_cast(text, bytes) && (bytes == 0 || bytes >= uint64_t{16} << 20U))
    return {};
  return text + " bytes: expected at least 16M (8G, 512M), or 0 for no limit";
}

std::string endpoint_error(const std::string& text) {
  constexpr std::string_view kScheme = "http://";
  const bool right = text.starts_with(kScheme) && text.size() > kScheme.size() &&
                     text.find_first_of("/?# ", kScheme.size()) == std::string::npos;
  return right ? std::string() : text + ": expected http://HOST:PORT";
}

/// What --preemption says; "auto" reads what the firmware says and asks nobody.
std::optional<Cloud> chosen_cloud(const std::string& word) {
  for (const Cloud cloud : {Cloud::aws, Cloud::gcp, Cloud::azure}) {
    if (word == hyades::worker::name_of(cloud)) return cloud;
  }
  if (word != "auto") return std::nullopt;
  auto found = hyades::worker::find_cloud();
  if (!found) {
    hyades::farm::log(hyades::farm::LogLevel::warning,
                      "this is no machine of aws, gcp or azure: no notices of pre-emption are "
                      "watched for");
  }
  return found;
}

std::string default_cache() {
  if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache != nullptr && *cache == '/') {
    return std::string(cache) + "/hyades";
  }
  const char* home = std::getenv("HOME");
  return std::string(home == nullptr ? "/var/tmp" : home) + "/.cache/hyades";
}

WorkerOptions default_options() {
  WorkerOptions options;
  options.threads = hyades::core::hardware_threads();
  options.memory = hyades::core::usable_memory() / 5 * 4;  // the rest is for all else
  options.cache = default_cache();
  options.cache_size = uint64_t{16} << 30U;
  options.renderer = hyades::core::program_folder() + "hyades-worker-render";
  return options;
}

/// Each file of the jobs in work is an open one; the usual limit is a thousand, and the hard one is
/// higher.
void open_many_files() {
  rlimit files{};
  if (::getrlimit(RLIMIT_NOFILE, &files) != 0) return;
  files.rlim_cur = files.rlim_max;
  (void)::setrlimit(RLIMIT_NOFILE, &files);
}

void add_resources(CLI::App& app, WorkerOptions& options) {
  app.add_option("--threads", options.threads, "units rendered at once")
      ->check(hyades::cli::in_range(1, 4096))
      ->capture_default_str();
  app.add_option("--memory", options.memory,
                 "most memory of the process that renders: 8G, 512M (default: four fifths of what "
                 "is here)")
      ->transform(CLI::AsSizeValue(false))
      ->check(memory_error);
  app.add_option("--cache", options.cache, "folder for the files of jobs; workers may share it")
      ->capture_default_str();
  app.add_option("--cache-size", options.cache_size, "most bytes in it (default: 16G)")
      ->transform(CLI::AsSizeValue(false));
  app.add_option("--texture-disk", options.texture_disk,
                 "most bytes of textures that memory does not hold, in a file in TMPDIR or the "
                 "cache (default: four times --memory); never more than half of what is free there")
      ->transform(CLI::AsSizeValue(false));
  app.add_option("--name", options.name, "what people call it (default: this host's name)");
  app.add_option("--tags", options.tags, "what jobs may ask for: a,b")
      ->delimiter(',')
      ->allow_extra_args(false);
}

void add_limits(CLI::App& app, WorkerOptions& options) {
  app.add_option("--grace", options.grace, "seconds from SIGTERM to the end")
      ->check(hyades::cli::in_range(0.3, 3600.0))
      ->capture_default_str();
  app.add_option("--hang-limit", options.hang_limit,
                 "seconds without a new sample of a unit after which the process that renders is "
                 "killed; 0: never")
      ->check(hang_limit_error)
      ->capture_default_str();
  hyades::cli::add_duration(app, "--unit-time-limit", options.unit_limit,
                            "most time for one unit, such as 30m, after which it has failed; 0: "
                            "no limit (default: 1h)");
  app.add_option(
         "--sandbox", options.sandbox,
         "of the process that renders: auto (as far as this machine can), require (else the "
         "worker ends) or off")
      ->check(CLI::IsMember({"auto", "require", "off"}))
      ->capture_default_str();
}

/// `preemption`: the cloud's name, auto or off.
void add_leaving(CLI::App& app, WorkerOptions& options, std::string& preemption) {
  hyades::cli::add_duration(app, "--exit-when-idle", options.idle_limit,
                            "end after so long without work, such as 5m; also where no coordinator "
                            "answers (default: never)",
                            0.1);
  app.add_option("--exit-status-when-told", options.told_status,
                 "exit status where SIGTERM, Ctrl-C or the cloud (--preemption) ended it, such as "
                 "143 where 0 would mean that its work is done")
      ->check(hyades::cli::in_range(0, 255))
      ->capture_default_str();
  auto* cloud = app.add_option("--preemption", preemption,
                               "hand over what is done when this cloud says that it takes the "
                               "machine away: aws, gcp, azure, auto (which the firmware names) or "
                               "off")
                    ->check(CLI::IsMember({"aws", "gcp", "azure", "auto", "off"}))
                    ->capture_default_str();
  app.add_option("--preemption-endpoint", options.cloud_endpoint,
                 "http://HOST:PORT to ask instead of the cloud's own metadata service")
      ->needs(cloud)
      ->check(endpoint_error);
}

}  // namespace

int main(int argc, char** argv) {
  hyades::core::ignore_file_size_signal();
  CLI::App app("Renders for a coordinator.", "hyades worker");
  WorkerOptions options = default_options();
  std::string preemption = "off";
  hyades::farm::LogOptions log;
  hyades::cli::add_peer_options(app, options.coordinator, "The coordinator");
  add_resources(app, options);
  add_limits(app, options);
  add_leaving(app, options, preemption);
  hyades::cli::add_log_options(app, log);
  hyades::cli::add_config_option(app);
  app.footer(
      "examples:\n"
      "  hyades worker\n"
      "  hyades worker --coordinator farm.example:7700 --tls-ca ca.pem --token-file token\n"
      "  hyades worker --exit-when-idle 5m --preemption auto --log-format json\n"
      "  hyades worker --memory 8G --unit-time-limit 30m --sandbox require\n"
      "Ctrl-C or SIGTERM: what is done is handed over, the rest given back; a second one, a second "
      "later or more, ends it at once.\n"
      "exit status: 0 asked to leave (or --exit-status-when-told) or without work, 1 cannot work "
      "here, 2 wrong arguments or refused by the coordinator");
  // Where `hyades` has started this program, argv[1] is the word "worker".
  const int skipped = argc > 1 && std::string_view(argv[1]) == "worker" ? 1 : 0;
  if (const auto status = hyades::cli::parse_command_line(app, argc - skipped, argv + skipped)) {
    return *status;
  }
  hyades::farm::set_log("hyades worker", log);
  open_many_files();
  options.cloud = chosen_cloud(preemption);
  struct sigaction action {};
  action.sa_handler = on_signal;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  return hyades::worker::run_worker(options, g_signals);
}
