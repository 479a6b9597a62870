#include "cli/shared_farm.h"

#include <linux/close_range.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <utility>

#include <fmt/format.h>

#include "coordinator/shared_state/database_film_logs.h"
#include "coordinator/sql/postgres.h"
#include "coordinator/web/standby_server.h"
#include "core/base/io_reason.h"
#include "core/base/mutex.h"
#include "farm/log.h"

namespace hyades::cli {
namespace {

using coordinator::LeaderLease;
using coordinator::LeaseRow;
using farm::LogLevel;

/// Set in the environment of a process that has led before: it waits for the database, which may
/// be failing over, from the beginning.
constexpr const char* kLedBefore = "HYADES_LED_BEFORE";

/// The arguments of this process, as it was started.
std::vector<std::string> own_arguments() {
  std::vector<std::string> arguments;
  std::ifstream file("/proc/self/cmdline");
  for (std::string text; std::getline(file, text, '\0');) arguments.push_back(text);
  return arguments;
}

std::atomic<bool> ends_soon{false};

/// Finishers write pictures, which the next leader's do from now on. Who stands by reaps them.
void end_children() {
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
    std::ifstream children(task.path() / "children");
    for (pid_t child = 0; children >> child;) (void)::kill(child, SIGKILL);
  }
}

/// This process becomes a new one, whose number, arguments and log are the same. All that it has
/// open goes; its threads end where they are.
[[noreturn]] void begin_anew(const std::string& why) {
  if (ends_soon) ::_exit(0);  // what was promised is durable
  farm::log(LogLevel::error, "does not lead any more, and stands by: " + why);
  end_children();
  (void)::close_range(3, UINT_MAX, CLOSE_RANGE_CLOEXEC);
  (void)::setenv(kLedBefore, "1", 1);  // NOLINT(concurrency-mt-unsafe): the end of this image
  std::vector<std::string> arguments = own_arguments();
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  ::execv("/proc/self/exe", pointers.data());
  farm::log(LogLevel::error, "cannot begin anew: " + core::io_reason(errno));
  ::_exit(1);
}

std::string name_of_this_machine() {
  std::array<char, HOST_NAME_MAX + 1> host{};
  (void)::gethostname(host.data(), host.size() - 1);
  return host.data();
}

/// What stands between a URL's scheme and its path: HOST:PORT.
std::string place_of(const std::string& url) {
  const size_t scheme = url.find("://");
  if (scheme == std::string::npos) return {};
  return url.substr(scheme + 3, url.find('/', scheme + 3) - scheme - 3);
}

/// Whether `pause` has passed without one of the signals. Finishers that an earlier image of this
/// process has started are its children still.
bool wait_without_signal(const sigset_t& signals, std::chrono::milliseconds pause) {
  while (::waitpid(-1, nullptr, WNOHANG) > 0) {
  }
  const auto whole = std::chrono::duration_cast<std::chrono::seconds>(pause);
  timespec time{};
  time.tv_sec = whole.count();
  time.tv_nsec = std::chrono::nanoseconds(pause - whole).count();
  return ::sigtimedwait(&signals, nullptr, &time) < 0;
}

/// Where a stand-by's visitors are sent; and what it last told the log.
class LeaderNews {
 public:
  void tell(const LeaseRow& leader, const std::string& trouble) {
    const core::MutexLock lock(mutex_);
    if (!trouble.empty()) {
      farm::log(LogLevel::warning, "stands by, and waits for the database: " + trouble);
    } else if (holder_ != leader.holder || had_trouble_) {
      farm::log(LogLevel::info, leader.holder.empty() ? "stands by: nobody leads"
                                                      : "stands by: " + leader.holder + " leads");
    }
    had_trouble_ = !trouble.empty();
    holder_ = leader.holder;
    // Another machine's own address leads nowhere from here.
    const bool here = leader.holder.starts_with(name_of_this_machine() + ":");
    const bool reached = here || !farm::is_loopback(place_of(leader.url));
    url_ = reached ? leader.url : "";
  }
  std::string url() const {
    const core::MutexLock lock(mutex_);
    return url_;
  }

 private:
  mutable core::Mutex mutex_;
  std::string holder_ HYADES_GUARDED_BY(mutex_);
  std::string url_ HYADES_GUARDED_BY(mutex_);
  bool had_trouble_ HYADES_GUARDED_BY(mutex_) = false;
};

}  // namespace

std::string database_error(const std::string& text) {
  if (coordinator::is_postgres_url(text)) return {};
  return "expected postgresql://[USER@]HOST[:PORT]/DATABASE";
}

SharedFarm::SharedFarm(std::string database, std::unique_ptr<LeaderLease> lease)
    : database_(std::move(database)), lease_(std::move(lease)) {}

core::Result<std::unique_ptr<SharedFarm>> SharedFarm::lead(const SharedFarmOptions& options) {
  LeaderNews news;
  std::vector<std::unique_ptr<coordinator::StandbyServer>> servers;
  for (const farm::Listen& door : options.doors) {
    auto server = coordinator::StandbyServer::start(door, [&news] { return news.url(); });
    if (server) {
      servers.push_back(std::move(*server));
    } else {  // another coordinator of this machine may have the address until this one leads
      farm::log(LogLevel::warning, "stands by without a page: " + server.error().message);
    }
  }
  coordinator::LeaderOptions leader;
  leader.database = options.database;
  leader.holder = fmt::format("{}:{}", name_of_this_machine(), ::getpid());
  leader.time = options.lease;
  leader.patient = std::getenv(kLedBefore) != nullptr;  // NOLINT(concurrency-mt-unsafe): read only
  leader.on_lost = begin_anew;
  leader.pause = [&options](std::chrono::milliseconds time) {
    return wait_without_signal(*options.signals, time);
  };
  leader.tell = [&news](const LeaseRow& row, const std::string& trouble) {
    news.tell(row, trouble);
  };
  auto lease = LeaderLease::wait(leader);
  if (!lease) return lease.error();
  if (!*lease) return std::unique_ptr<SharedFarm>();
  farm::log(LogLevel::info, fmt::format("leads (start {})", (*lease)->incarnation()));
  return std::unique_ptr<SharedFarm>(new SharedFarm(options.database, std::move(*lease)));
}

void SharedFarm::set_url(const std::string& url) {
  std::string told = url;
  while (told.ends_with('/')) told.pop_back();
  for (const std::string all : {"0.0.0.0", "[::]"}) {
    const size_t at = told.find("://" + all + ":");
    if (at != std::string::npos) told.replace(at + 3, all.size(), name_of_this_machine());
  }
  lease_->set_url(told);
}

void SharedFarm::end_soon() { ends_soon = true; }

void SharedFarm::lead_while(std::function<bool()> works) { lease_->renew_while(std::move(works)); }

core::Result<SharedFarm::Stores> SharedFarm::open_stores(const std::string& scratch) {
  const auto connection =
      coordinator::leader_connection(database_, lease_->incarnation(), begin_anew);
  Stores stores;
  auto jobs = coordinator::open_postgres_job_store(connection);
  if (!jobs) return jobs.error();
  stores.jobs = std::move(*jobs);
  stores.films = coordinator::database_film_logs(
      std::make_unique<coordinator::DatabaseLogFiles>(connection), scratch + "/aside");
  return stores;
}

}  // namespace hyades::cli
