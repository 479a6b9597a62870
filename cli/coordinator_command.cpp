// `hyades coordinator`: owns jobs, leases units, merges films. It links no renderer.

#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <google/protobuf/stubs/logging.h>
#include <CLI/CLI.hpp>

#include "cli/address_option.h"
#include "cli/command_line.h"
#include "cli/config_file.h"
#include "cli/log_options.h"
#include "cli/number_range.h"
#include "cli/shared_farm.h"
#include "coordinator/access/authority.h"
#include "coordinator/access/first_admin.h"
#include "coordinator/access/machine_key.h"
#include "coordinator/controller/controller.h"
#include "coordinator/notify/notifier.h"
#include "coordinator/services/memory_trim.h"
#include "coordinator/services/server.h"
#include "coordinator/web/web_server.h"
#include "core/base/atomic_file.h"
#include "core/base/machine.h"
#include "core/sandbox/landlock.h"
#include "farm/last_words.h"
#include "farm/log.h"

namespace {

using hyades::cli::SharedFarm;
using hyades::coordinator::Authority;
using hyades::coordinator::Controller;
using hyades::coordinator::ControllerOptions;
using hyades::coordinator::Duration;
using hyades::coordinator::Hook;
using hyades::coordinator::Notifier;
using hyades::coordinator::OwnerLimits;
using hyades::coordinator::Server;
using hyades::coordinator::Serves;
using hyades::coordinator::WebServer;
using hyades::farm::LogLevel;

constexpr int kBadArguments = 2;
constexpr double kDearest = 1e9;  // whatever the currency
constexpr const char* kHttp = "localhost:8080";

Duration seconds(double value) {
  return std::chrono::duration_cast<Duration>(std::chrono::duration<double>(value));
}

struct Arguments {
  ControllerOptions controller;
  hyades::farm::Listen listen;
  hyades::farm::LogOptions log;
  std::string http = kHttp;
  bool http_asked = false;
  std::string health = "off";
  std::vector<std::string> http_names;
  Notifier::Options news;
  hyades::cli::SharedFarmOptions shared;
};

/// Of a URL, without its port; empty where it has none.
std::string host_of(const std::string& url) {
  const size_t scheme = url.find("://");
  if (scheme == std::string::npos) return {};
  const std::string rest = url.substr(scheme + 3);
  return rest.substr(0, rest.find_first_of(":/?#"));
}

/// The dashboard and the HTTP API; null where there is to be none. Where nobody has asked for the
/// address, somebody else may have it.
hyades::core::Result<std::unique_ptr<WebServer>> open_http(const Arguments& arguments,
                                                           Controller& controller,
                                                           Authority& authority) {
  if (arguments.http == "off") return std::unique_ptr<WebServer>();
  hyades::farm::Listen listen = arguments.listen;
  listen.address = arguments.http;
  std::vector<std::string> names = arguments.http_names;
  if (const std::string host = host_of(arguments.news.dashboard); !host.empty()) {
    names.push_back(host);
  }
  auto server = WebServer::start(listen, controller, authority, std::move(names));
  if (server || arguments.http_asked) return server;
  hyades::farm::log(LogLevel::warning, "no dashboard: " + server.error().message +
                                           "; choose another place with --http");
  return std::unique_ptr<WebServer>();
}

/// /healthz, /readyz and /metrics at a place of their own; null where none was asked for.
hyades::core::Result<std::unique_ptr<WebServer>> open_health(const Arguments& arguments,
                                                             Controller& controller,
                                                             Authority& authority) {
  if (arguments.health == "off") return std::unique_ptr<WebServer>();
  hyades::farm::Listen listen = arguments.listen;
  listen.address = arguments.health;
  return WebServer::start(listen, controller, authority, arguments.http_names, Serves::health);
}

/// A thousand workers are a thousand open files; the usual limit is that, and the hard one is
/// higher.
void open_many_files() {
  rlimit files{};
  if (::getrlimit(RLIMIT_NOFILE, &files) != 0) return;
  files.rlim_cur = files.rlim_max;
  (void)::setrlimit(RLIMIT_NOFILE, &files);
}

/// Tells those who want to hear of jobs; null where nobody does.
std::unique_ptr<Notifier> open_notifier(const Arguments& arguments, Controller& controller,
                                        const WebServer* http) {
  Notifier::Options options = arguments.news;
  if (options.hooks.empty() && options.chats.empty()) return nullptr;
  if (options.dashboard.empty() && http != nullptr) options.dashboard = http->url();
  options.stall =
      std::chrono::duration_cast<std::chrono::milliseconds>(arguments.controller.stall_time);
  options.hook.tell = [](const std::string& line) { hyades::farm::log(LogLevel::warning, line); };
  return std::make_unique<Notifier>(controller, std::move(options));
}

/// Writes where it listens; an empty text where it does not. That it cannot be written keeps
/// nothing from starting: who makes room has to reach the coordinator.
void note_address(const std::string& path, const std::string& address) {
  if (address.empty()) {
    (void)std::remove(path.c_str());
    return;
  }
  auto noted = hyades::core::write_file(path, std::as_bytes(std::span(address)));
  if (!noted && std::remove(path.c_str()) == 0) {  // what it said is not true any more
    noted = hyades::core::write_file(path, std::as_bytes(std::span(address)));
  }
  if (!noted) hyades::farm::log(LogLevel::error, noted.error().message);
}

std::string hook_error(const std::string& url) {
  const auto right = Hook::check(url);
  return right ? std::string() : right.error().message;
}

/// PER_CORE_HOUR[:CURRENCY]; what is wrong with it, or an empty text.
std::string read_price(const std::string& text, hyades::coordinator::Price& price) {
  const size_t colon = std::min(text.find(':'), text.size());
  const char* end = text.data() + colon;
  const auto [read, error] = std::from_chars(text.data(), end, price.per_core_hour);
  const bool number = error == std::errc() && read == end && price.per_core_hour >= 0 &&
                      price.per_core_hour <= kDearest;
  price.currency = colon < text.size() ? text.substr(colon + 1) : "";
  const bool code =
      colon == text.size() ||
      (price.currency.size() == 3 && std::all_of(price.currency.begin(), price.currency.end(),
                                                 [](char c) { return c >= 'A' && c <= 'Z'; }));
  if (number && code) return {};
  return "'" + text +
         "': expected what an hour of a thread costs, with or without the three "
         "letters of the currency, such as 0.04:EUR";
}

bool is_beyond(const Arguments& arguments) {
  const auto leads_out = [](const std::string& address) {
    return address != "off" && !hyades::farm::is_loopback(address);
  };
  return leads_out(arguments.http) || leads_out(arguments.health) ||
         !hyades::farm::is_loopback(arguments.listen.address);
}

/// Who may come in. A farm that can be reached from elsewhere has tokens: where there is none of an
/// admin (none was made yet, they have expired, it could not be written) one is put into the folder
/// for whoever runs the farm.
hyades::core::Result<std::unique_ptr<Authority>> open_authority(const Arguments& arguments,
                                                                const std::string& shared_token,
                                                                Controller& controller) {
  Authority::Options options;
  if (auto key = hyades::coordinator::machine_key(arguments.controller.files); key) {
    options.machine_key = std::move(*key);
  } else {
    hyades::farm::log(LogLevel::warning, key.error().message +
                                             ": workers join anew when this coordinator starts "
                                             "again");
  }
  options.shared_token = shared_token;
  options.beyond = is_beyond(arguments);
  options.audit_folder = arguments.controller.files;
  options.plain = arguments.listen.cert_file.empty();
  options.owner_only = !arguments.listen.insecure;
  options.tell_unguarded = [&controller](const std::string& how) {
    controller.farm().set_unguarded(how);
    if (!how.empty()) {
      hyades::farm::log(LogLevel::warning, how);
    }
  };
  options.tell_expiring = [](const std::string& line) {
    hyades::farm::log(LogLevel::warning, line);
  };
  auto authority = Authority::open(controller.store(), options);
  if (!authority || !options.beyond || arguments.listen.insecure || (*authority)->has_admin()) {
    return authority;
  }
  const auto made = hyades::coordinator::make_first_admin(**authority, arguments.controller.files);
  if (!made) return made.error();
  hyades::farm::log(LogLevel::info,
                    "an admin's token (" + made->id + ") is in " + arguments.controller.files +
                        "/admin-token and holds for 30 days: make your own with it (hyades token "
                        "create --role admin --name NAME), revoke it and remove the file");
  return authority;
}

/// Where it listens, for people and scripts on standard output; logs in JSON have it in a line.
void tell_where(const std::string& address, const WebServer* http) {
  const auto tell = [](const std::string& line) {
    if (hyades::farm::log_format() == hyades::farm::LogFormat::json) {
      hyades::farm::log(LogLevel::info, line);
    } else {
      std::printf("%s\n", line.c_str());
    }
  };
  tell("listening on " + address);
  if (http != nullptr) tell("dashboard at " + http->url());
  std::fflush(stdout);
}

int log_and_fail(const std::string& why) {
  hyades::farm::log(LogLevel::error, why);
  return 1;
}

/// Serves until one of `signals` comes. Exit status. `shared`: where there is one, this process
/// leads it.
int serve_until(const sigset_t& signals, const Arguments& arguments, const hyades::farm::Door& door,
                Controller& controller, SharedFarm* shared) {
  auto authority = open_authority(arguments, door.token, controller);
  if (!authority) return log_and_fail(authority.error().message);
  auto server = Server::start(door, controller, **authority);
  if (!server) return log_and_fail(server.error().message);
  note_address(arguments.controller.folder + "/address", (*server)->address() + "\n");
  if (const grpc::Status room = controller.disk().admit(0); !room.ok()) {
    hyades::farm::log(LogLevel::error, room.error_message());
  }
  auto http = open_http(arguments, controller, **authority);
  if (!http) return log_and_fail(http.error().message);
  const auto health = open_health(arguments, controller, **authority);
  if (!health) return log_and_fail(health.error().message);
  if (*health)
    note_address(arguments.controller.folder + "/health-address", (*health)->url() + "\n");
  const auto notifier = open_notifier(arguments, controller, http->get());
  note_address(arguments.controller.folder + "/http-address", *http ? (*http)->url() + "\n" : "");
  if (shared != nullptr && *http) {
    const std::string& said = arguments.news.dashboard;
    shared->set_url(said.empty() ? (*http)->url() : said);
  }
  tell_where((*server)->address(), http->get());
  int signal = 0;
  sigwait(&signals, &signal);
  SharedFarm::end_soon();
  controller.stop();
  return 0;
}

/// Stands by until this process leads the coordinators of a database, and serves then.
int serve_shared(const sigset_t& signals, const Arguments& arguments,
                 const hyades::farm::Door& door) {
  hyades::cli::SharedFarmOptions options = arguments.shared;
  options.signals = &signals;
  for (const std::string& place : {arguments.http, arguments.health}) {
    if (place == "off") continue;
    options.doors.push_back(arguments.listen);
    options.doors.back().address = place;
  }
  // A place that this process had when it led before is another's by now.
  for (const char* name : {"address", "http-address", "health-address"})
    (void)std::remove((arguments.controller.folder + "/" + name).c_str());
  auto shared = SharedFarm::lead(options);
  if (!shared) return log_and_fail(shared.error().message);
  if (!*shared) return 0;
  ControllerOptions leading = arguments.controller;
  leading.leads = [&farm = **shared] { return farm.leads(); };
  auto stores = (*shared)->open_stores(leading.folder + "/tmp");
  if (!stores) return log_and_fail(stores.error().message);
  auto controller = Controller::open(leading, std::move(stores->jobs), std::move(stores->films));
  if (!controller) return log_and_fail(controller.error().message);
  (*shared)->lead_while([&controller = **controller, patience = options.lease] {
    return std::chrono::steady_clock::now() - controller.last_turn() < patience;
  });
  const int status = serve_until(signals, arguments, door, **controller, shared->get());
  (*shared)->lead_while(nullptr);
  return status;
}

int serve(const Arguments& arguments) {
  hyades::farm::set_log("hyades coordinator", arguments.log);
  // Jobs, films and pictures are nobody's but the owner's and the group's, whatever the caller
  // allows.
  ::umask(::umask(0) | S_IWGRP | S_IRWXO);
  // Before the folder is touched.
  auto door = hyades::farm::open_door(arguments.listen);
  if (!door) {
    hyades::farm::log(LogLevel::error, door.error().message);
    return kBadArguments;
  }
  open_many_files();
  if (const std::string lacks = hyades::core::landlock_lacks(); !lacks.empty()) {
    hyades::farm::log(LogLevel::warning,
                      "pictures are made in a process that can read this coordinator's files (" +
                          lacks + "): docs/safety.md");
  }
  // Who sends what is no message is told so; it does not fill the log.
  google::protobuf::SetLogHandler(nullptr);
  // Signals are waited for below; every thread inherits that they are blocked.
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);

  if (arguments.shared.database.empty()) {
    auto controller = Controller::open(arguments.controller);
    if (!controller) return log_and_fail(controller.error().message);
    return serve_until(signals, arguments, *door, **controller, nullptr);
  }
  return serve_shared(signals, arguments, *door);
}

struct Bounds {
  double low = 0.0;
  double high = 0.0;
};

/// An option in seconds, whose default is what `value` is.
void add_seconds(CLI::App& app, const std::string& name, Duration& value, const Bounds& bounds,
                 const std::string& text) {
  app.add_option_function<double>(
         name, [&value](double said) { value = seconds(said); }, text)
      ->check(hyades::cli::in_range(bounds.low, bounds.high))
      ->default_str(fmt::format("{:g}", std::chrono::duration<double>(value).count()));
}

void add_addresses(CLI::App& app, Arguments& arguments) {
  app.add_option("--data", arguments.controller.folder,
                 "folder for everything that is kept, or, with --state, for what is temporary")
      ->required();
  app.add_option("--listen", arguments.listen.address, "HOST:PORT; port 0 takes a free one")
      ->check(hyades::cli::address_error)
      ->capture_default_str();
  app.add_option("--http", arguments.http,
                 "HOST:PORT of the dashboard and the HTTP API, or off; where the "
                 "default is taken it goes without")
      ->check([](const std::string& text) {
        return text == "off" ? std::string() : hyades::cli::address_error(text);
      })
      ->capture_default_str();
  app.add_option(
         "--health", arguments.health,
         "HOST:PORT of /healthz, /readyz and /metrics alone, where nobody who crowds --http "
         "is in their way; or off")
      ->check([](const std::string& text) {
        return text == "off" ? std::string() : hyades::cli::address_error(text);
      })
      ->capture_default_str();
  app.add_option(
      "--http-name", arguments.http_names,
      "a name by which browsers reach the dashboard, beside addresses and this machine's "
      "own names; only needed where no token is asked for; again for others");
}

/// Of several coordinators that take over from each other.
void add_shared(CLI::App& app, Arguments& arguments) {
  auto* state =
      app.add_option("--state", arguments.shared.database,
                     "postgresql://USER@HOST/DATABASE that keeps jobs and films instead of --data: "
                     "of all coordinators with the same one leads, the others stand by")
          ->envname("HYADES_STATE")
          ->check(hyades::cli::database_error)
          ->type_name("URL");
  app.add_option("--files", arguments.controller.files,
                 "folder that all coordinators of --state see, for assets and outputs")
      ->needs(state)
      ->type_name("FOLDER");
  app.add_option_function<double>(
         "--leader-seconds",
         [&arguments](double said) {
           arguments.shared.lease = std::chrono::milliseconds(static_cast<int64_t>(said * 1e3));
         },
         "a leader that nobody has heard of for so long is replaced by another coordinator")
      ->check(hyades::cli::in_range(0.5, 3600.0))
      ->default_str(
          fmt::format("{:g}", std::chrono::duration<double>(arguments.shared.lease).count()));
}

void add_guards(CLI::App& app, Arguments& arguments) {
  app.add_option("--tls-cert", arguments.listen.cert_file, "certificate (PEM): TLS");
  app.add_option("--tls-key", arguments.listen.key_file, "its private key (PEM)");
  app.add_option("--tls-ca", arguments.listen.ca_file,
                 "callers must show a certificate signed by this one (PEM)");
  app.add_option("--worker-ca", arguments.listen.worker_ca_file,
                 "workers must show a certificate signed by this one (PEM); others need none");
  app.add_option(
      "--token-file", arguments.listen.token_file,
      "file with one token for all roles, beside those of 'hyades token' (docs/safety.md)");
  app.add_flag("--insecure", arguments.listen.insecure,
               "plaintext, and no token where none was made, also beyond this machine");
}

void add_news(CLI::App& app, Arguments& arguments) {
  app.add_option("--notify", arguments.news.hooks,
                 "URL that hears, as JSON, of jobs that are done, failed or stand still; again for "
                 "others")
      ->check(hook_error);
  app.add_option("--notify-chat", arguments.news.chats,
                 "the same for a chat server's incoming webhook: {\"text\": ...}")
      ->check(hook_error);
  app.add_flag(
      "--notify-private", arguments.news.hook.may_be_private,
      "names in URLs of --notify and --notify-chat may stand for addresses of this machine "
      "or of private networks");
  app.add_option("--dashboard-url", arguments.news.dashboard,
                 "the dashboard as people reach it, for links (default: as --http has it)");
}

void add_times(CLI::App& app, ControllerOptions& options) {
  add_seconds(app, "--unit-seconds", options.unit_time, {0.01, 3600.0},
              "what one thread shall take for a unit");
  add_seconds(app, "--lease-seconds", options.lease_time, {1.0, 3600.0},
              "a worker that is silent for so long loses its units");
  add_seconds(app, "--class-patience", options.class_patience, {0.1, 1e6},
              "seconds after which a frame begins again whose class of workers has vanished");
  add_seconds(app, "--adoption-seconds", options.adoption_time, {0.0, 3600.0},
              "after a start, workers have so long to say what they hold before others get it");
  add_seconds(app, "--stall-seconds", options.stall_time, {1.0, 1e6},
              "a unit of which a worker gets no sample done for so long is taken from it");
}

void add_limits(CLI::App& app, ControllerOptions& options) {
  app.add_option_function<double>(
         "--compact-mb",
         [&options](double said) { options.compact_bytes = static_cast<uint64_t>(said * 1e6); },
         "a job's film log is rewritten when it has grown by this much")
      ->check(hyades::cli::in_range(0.01, 1e6))
      ->default_str(fmt::format("{:g}", static_cast<double>(options.compact_bytes) * 1e-6));
  app.add_option("--disk-budget", options.disk.budget,
                 "most bytes that the data may take, such as 200G (default: no limit)")
      ->transform(CLI::AsSizeValue(false));
  app.add_option("--disk-reserve", options.disk.reserve,
                 "bytes of the disk to keep free (default: a twentieth of it, at most 2G)")
      ->transform(CLI::AsSizeValue(false));
  app.add_option("--film-memory", options.film_memory,
                 "most bytes that films of frames in work may take in memory; jobs of which one "
                 "takes more are refused (default: a third of the machine's memory)")
      ->transform(CLI::AsSizeValue(false));
  app.add_option_function<std::string>(
         "--price",
         [&options](const std::string& text) {
           if (const auto wrong = read_price(text, options.price); !wrong.empty()) {
             throw CLI::ValidationError("--price", wrong);
           }
         },
         "what an hour of one rendering thread costs, with or without the currency, such as "
         "0.04:EUR: jobs tell what they have cost")
      ->type_name("PRICE");
  add_seconds(app, "--asset-grace", options.asset_grace, {0.0, 1e9},
              "seconds that files which no job needs any more stay after their last use");
}

/// What one owner may have; of what has no default he may have as much as he likes.
void add_quotas(CLI::App& app, OwnerLimits& limits) {
  constexpr uint64_t kMost = 1'000'000;
  app.add_option("--owner-bytes", limits.bytes,
                 "most bytes that an owner may have in uploads that are unfinished or that no job "
                 "has had, such as 500G (default: no limit)")
      ->transform(CLI::AsSizeValue(false));
  app.add_option("--owner-files", limits.files, "most unfinished uploads of an owner")
      ->check(hyades::cli::in_range(uint64_t{1}, kMost))
      ->capture_default_str();
  app.add_option("--owner-jobs", limits.jobs,
                 "most jobs of an owner that are not over (default: no limit)")
      ->check(hyades::cli::in_range(uint64_t{1}, kMost));
  app.add_option("--owner-core-hours", limits.core_hours,
                 "an owner whose jobs took so many hours of threads within 24 hours may begin no "
                 "others (default: no limit)")
      ->check(hyades::cli::in_range(0.001, 1e9));
  app.add_option("--owner-connections", limits.connections,
                 "most streams (uploads, downloads, pages that are open) that tokens of one name "
                 "may have open (default: no limit)")
      ->check(hyades::cli::in_range(uint64_t{1}, kMost));
}

}  // namespace

int main(int argc, char** argv) {
  hyades::coordinator::return_large_blocks();
  hyades::core::ignore_file_size_signal();
  hyades::farm::die_with_words("hyades coordinator",
                               "what was promised is durable: start it again");
  Arguments arguments;
  CLI::App app("Owns jobs, leases their units to workers, merges the films and writes the outputs.",
               "hyades coordinator");
  add_addresses(app, arguments);
  add_shared(app, arguments);
  add_guards(app, arguments);
  add_news(app, arguments);
  hyades::cli::add_log_options(app, arguments.log);
  add_times(app, arguments.controller);
  add_limits(app, arguments.controller);
  add_quotas(app, arguments.controller.per_owner);
  hyades::cli::add_config_option(app);
  app.footer(
      "examples:\n"
      "  hyades coordinator --data /var/lib/hyades\n"
      "  hyades coordinator --data my-farm --listen 0.0.0.0:7700 --tls-cert c.pem --tls-key k.pem "
      "--token-file token\n"
      "  hyades coordinator --data my-farm --listen 0.0.0.0:7700 --http 0.0.0.0:8080 --insecure "
      "--http-name farm.example\n"
      "  hyades coordinator --data my-farm --price 0.04:EUR --log-format json\n"
      "  hyades coordinator --data /var/lib/hyades --state postgresql://hyades@db/hyades "
      "--files /shared/hyades\n"
      "docs/farm.md tells more. exit status: 0 after SIGTERM or SIGINT, 1 it could not start, 2 "
      "wrong arguments (or a token, certificate or key that is none)");
  // argv[1] is the word "coordinator".
  const int skipped = argc > 1 ? 1 : 0;
  if (const auto status =
          hyades::cli::parse_command_line(app, argc - skipped, argv + skipped, kBadArguments)) {
    return *status;
  }
  if (arguments.shared.database.empty()) {
    arguments.controller.files = arguments.controller.folder;
  } else if (arguments.controller.files.empty()) {
    std::fprintf(stderr,
                 "hyades coordinator: --state keeps no files: expected --files FOLDER too, which "
                 "all coordinators see\n");
    return kBadArguments;
  }
  arguments.http_asked = app["--http"]->count() > 0;
  arguments.listen.asks_tokens = true;  // open_authority sees to it
  arguments.controller.finisher = hyades::core::program_folder() + "hyades-film";
  return serve(arguments);
}
