#include "tests/coordinator/sql/postgres_server.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <grp.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <pwd.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "coordinator/sql/postgres.h"
#include "core/base/descriptor.h"
#include "core/base/random_id.h"

namespace hyades::test {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds kPatience{60};
constexpr std::chrono::milliseconds kLook{20};
constexpr int kTries = 5;  ///< for a port that nobody else has

[[noreturn]] void give_up(const std::string& why) { throw std::runtime_error(why); }

/// The newest version that is installed, or 0.
int version() {
  int newest = 0;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator("/usr/lib/postgresql", none)) {
    if (fs::exists(entry.path() / "bin/initdb")) {
      newest = std::max(newest, std::atoi(entry.path().filename().c_str()));
    }
  }
  return newest;
}

std::string program(const std::string& name) {
  return fmt::format("/usr/lib/postgresql/{}/bin/{}", version(), name);
}

struct User {
  uid_t user;
  gid_t group;
};

/// PostgreSQL refuses to run as root.
std::optional<User> other_than_root() {
  if (::geteuid() != 0) return std::nullopt;
  const passwd* entry = ::getpwnam("postgres");
  if (entry == nullptr) entry = ::getpwnam("nobody");
  if (entry == nullptr) give_up("there is no user for PostgreSQL");
  return User{entry->pw_uid, entry->pw_gid};
}

/// A child that ends with this process, and writes to the file `log`.
pid_t start_program(const std::vector<std::string>& words, const std::string& log) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const std::optional<User> user = other_than_root();
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child != 0) return child;
  const int output = ::open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
  const int input = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  ::dup2(input, STDIN_FILENO);
  ::dup2(output, STDOUT_FILENO);
  ::dup2(output, STDERR_FILENO);
  if (user && (::setgroups(0, nullptr) != 0 || ::setgid(user->group) != 0 ||
               ::setuid(user->user) != 0 || ::chdir("/") != 0)) {
    ::_exit(126);
  }
  // After setuid, which forgets it. A quick end, after which nothing of it is left in memory.
  ::prctl(PR_SET_PDEATHSIG, SIGQUIT);
  if (::getppid() != parent) ::_exit(0);
  ::execv(arguments[0], arguments.data());
  ::_exit(127);
}

std::string text_of(const std::string& file) {
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// All of the folder is of the user that PostgreSQL runs as.
void give_away(const std::string& folder) {
  const std::optional<User> user = other_than_root();
  if (!user) return;
  (void)::lchown(folder.c_str(), user->user, user->group);
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    (void)::lchown(entry.path().c_str(), user->user, user->group);
  }
}

void make_cluster(const std::string& folder, const std::string& log) {
  std::vector<std::string> words = {program("initdb"),
                                    "-D",
                                    folder,
                                    "-U",
                                    "postgres",
                                    "-E",
                                    "UTF8",
                                    "--no-sync",
                                    "--auth-local=trust",
                                    "--locale=C",
                                    "--wal-segsize=1",
                                    "--auth-host=scram-sha-256",
                                    "--no-instructions"};
  if (version() >= 15) {
    words.insert(words.end(), {"--locale-provider=icu", "--icu-locale=en-US"});
  }
  const pid_t child = start_program(words, log);
  int status = 0;
  ::waitpid(child, &status, 0);
  if (status != 0) give_up("initdb: " + text_of(log));
}

/// Makes a cluster in `data`, as a copy of one that the first test of a build folder has made.
void copy_cluster(const std::string& data, const std::string& log) {
  const fs::path build = fs::read_symlink("/proc/self/exe").parent_path().parent_path();
  const fs::path model = build / fmt::format("postgres-{}-cluster", version());
  const core::Descriptor lock(
      ::open((model.string() + ".lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600));
  if (!lock.valid() || ::flock(lock.get(), LOCK_EX) != 0) return make_cluster(data, log);
  if (!fs::exists(model)) {
    make_cluster(data, log);
    const fs::path half = model.string() + ".half";
    fs::remove_all(half);
    fs::copy(data, half, fs::copy_options::recursive);
    fs::rename(half, model);
    return;
  }
  std::error_code failed;
  fs::copy(model, data, fs::copy_options::recursive, failed);
  if (failed) {  // it is another user's
    fs::remove_all(data);
    return make_cluster(data, log);
  }
  fs::permissions(data, fs::perms::owner_all);
  give_away(data);
}

uint16_t free_port() {
  const core::Descriptor probe(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  auto* where = reinterpret_cast<sockaddr*>(&address);
  if (::bind(probe.get(), where, size) != 0 || ::getsockname(probe.get(), where, &size) != 0) {
    give_up("there is no free port");
  }
  return ntohs(address.sin_port);
}

}  // namespace

bool postgres_is_there() {
  if (version() != 0) return true;
  const char* ci = std::getenv("CI");
  if (ci != nullptr && std::string(ci) == "true") {
    [] { FAIL() << "PostgreSQL's server is not installed"; }();
  } else {
    [] { GTEST_SKIP() << "PostgreSQL's server is not installed"; }();
  }
  return false;
}

PostgresServer::PostgresServer(bool durable) : durable_(durable) {
  const auto secret = core::random_id();
  if (!secret) give_up(secret.error().message);
  password_ = *secret;
  give_away(folder_.path());
  copy_cluster(folder_.file("data"), folder_.file("initdb.log"));
  for (int i = 0; i < kTries && pid_ < 0; ++i) {
    port_ = free_port();
    start();
  }
  if (pid_ < 0) give_up("PostgreSQL does not start: " + text_of(folder_.file("log")));
  auto db = coordinator::open_postgres({.url = socket_url("postgres", "postgres")});
  if (!db) give_up(db.error().message);
  if (auto made = (*db)->run_script("CREATE ROLE farm LOGIN PASSWORD '" + password_ + "'"); !made) {
    give_up(made.error().message);
  }
}

PostgresServer::~PostgresServer() { stop(); }

PostgresServer& PostgresServer::shared() {
  static PostgresServer server;
  return server;
}

std::string PostgresServer::socket_url(const std::string& user, const std::string& database) const {
  return fmt::format("postgresql:///{}?host={}&port={}&user={}", database, folder_.path().string(),
                     port_, user);
}

std::string PostgresServer::add_database() {
  const std::string name = fmt::format("farm{}", ++databases_);
  auto db = coordinator::open_postgres({.url = socket_url("postgres", "postgres")});
  if (!db) give_up(db.error().message);
  const auto made = (*db)->run_script(fmt::format("CREATE DATABASE {} OWNER farm", name));
  if (!made) give_up(made.error().message);
  return name;
}

std::string PostgresServer::make_database() {
  return fmt::format("postgresql://farm:{}@127.0.0.1:{}/{}", password_, port_, add_database());
}

std::string PostgresServer::make_database_by_socket() { return socket_url("farm", add_database()); }

void PostgresServer::end(int signal) {
  if (pid_ < 0) return;
  ::kill(pid_, signal);
  ::kill(pid_, SIGCONT);
  ::waitpid(pid_, nullptr, 0);
  pid_ = -1;
}

void PostgresServer::stop() { end(SIGINT); }

void PostgresServer::kill() { end(SIGQUIT); }

void PostgresServer::freeze() const { ::kill(pid_, SIGSTOP); }

void PostgresServer::start() {
  const std::string sync = durable_ ? "on" : "off";
  pid_ = start_program({program("postgres"),
                        "-D",
                        folder_.file("data"),
                        "-h",
                        "127.0.0.1",
                        "-p",
                        std::to_string(port_),
                        "-k",
                        folder_.path().string(),
                        "-c",
                        "fsync=" + sync,
                        "-c",
                        "full_page_writes=" + sync,
                        "-c",
                        "shared_buffers=16MB",
                        "-c",
                        "max_wal_size=64MB",
                        "-c",
                        "max_connections=100",
                        "-c",
                        "jit=off"},
                       folder_.file("log"));
  if (comes_up()) return;
  end(SIGKILL);
}

bool PostgresServer::comes_up() {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (std::chrono::steady_clock::now() < end) {
    if (coordinator::open_postgres({.url = socket_url("postgres", "postgres")})) return true;
    siginfo_t info{};
    if (::waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT) != 0 ||
        info.si_pid != 0) {
      return false;
    }
    std::this_thread::sleep_for(kLook);
  }
  return false;
}

}  // namespace hyades::test
