#include "cli/temporary_folder.h"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <filesystem>
#include <system_error>
#include <utility>

namespace hyades::cli {
namespace {

namespace fs = std::filesystem;

/// Seconds for which what still runs may write into it, where the process did not end in order.
constexpr int kTries = 3;

[[noreturn]] void remove_when_closed(const std::string& path, int alive) {
  // Signals of the terminal are for the process, and whoever reads its output waits for its end.
  ::setsid();
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_IGN);
  ::dup2(alive, STDIN_FILENO);
  ::dup2(::open("/dev/null", O_RDWR | O_CLOEXEC), STDOUT_FILENO);
  ::dup2(STDOUT_FILENO, STDERR_FILENO);
  ::close_range(STDERR_FILENO + 1, ~0U, 0);
  (void)::chdir("/");
  char none = 0;
  ssize_t told = 0;
  while ((told = ::read(STDIN_FILENO, &none, 1)) < 0 && errno == EINTR) continue;
  std::error_code ignored;
  fs::remove_all(path, ignored);
  for (int i = 0; told == 0 && i < kTries; ++i) {
    ::sleep(1);
    fs::remove_all(path, ignored);
  }
  ::_exit(0);
}

}  // namespace

core::Result<std::unique_ptr<TemporaryFolder>> TemporaryFolder::make(const std::string& prefix) {
  std::error_code failed;
  std::string name = (fs::temp_directory_path(failed) / (prefix + "XXXXXX")).string();
  if (failed || ::mkdtemp(name.data()) == nullptr) {
    return core::Error{"no temporary folder could be made: expected TMPDIR to name one"};
  }
  const std::string path = fs::absolute(name, failed).string();
  std::array<int, 2> pipe{};
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0) {
    fs::remove(path, failed);
    return core::Error{"no pipe could be made: " + std::system_category().message(errno)};
  }
  core::Descriptor read(pipe[0]);
  core::Descriptor alive(pipe[1]);
  const pid_t remover = ::fork();
  if (remover == 0) {
    alive.close();
    remove_when_closed(path, read.get());
  }
  // Without one it goes with this object alone.
  return std::unique_ptr<TemporaryFolder>(new TemporaryFolder(path, std::move(alive), remover));
}

TemporaryFolder::TemporaryFolder(std::string path, core::Descriptor alive, pid_t remover)
    : path_(std::move(path)), alive_(std::move(alive)), remover_(remover) {}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
  (void)!::write(alive_.get(), "", 1);  // it ends in order
  alive_.close();
  if (remover_ > 0) ::waitpid(remover_, nullptr, 0);
}

}  // namespace hyades::cli
