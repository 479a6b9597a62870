#include "core/base/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <system_error>
#include <utility>

#include "core/base/posix_file.h"

namespace hyades::core {
namespace {

constexpr int kAskEvery = 20;  // milliseconds
constexpr size_t kLongestComplaint = 1000;

}  // namespace

std::optional<std::string> find_program(const std::string& name) {
  const char* folders = std::getenv("PATH");
  std::istringstream list(folders != nullptr ? folders : "/usr/local/bin:/usr/bin:/bin");
  for (std::string folder; std::getline(list, folder, ':');) {
    const std::string path = (folder.empty() ? "." : folder) + "/" + name;
    std::error_code none;
    if (std::filesystem::is_regular_file(path, none) && ::access(path.c_str(), X_OK) == 0) {
      return path;
    }
  }
  return std::nullopt;
}

Result<ChildProcess> ChildProcess::start(const std::string& path,
                                         const std::vector<std::string>& arguments,
                                         const std::string& name) {
  ChildProcess child;
  child.name_ = name.empty() ? std::filesystem::path(path).filename().string() : name;
  const auto failure = [&](int why) {
    return Error{child.name_ + " could not be started: " + std::strerror(why)};
  };
  // A socket, as writing to one whose other end is gone can do without a signal.
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) return failure(errno);
  child.input_ = Descriptor(ends[0]);
  const Descriptor its_input(ends[1]);
  if (::pipe2(ends, O_CLOEXEC) != 0) return failure(errno);
  child.said_pipe_ = Descriptor(ends[0]);
  ::fcntl(child.said_pipe_.get(), F_SETFL, O_NONBLOCK);
  const Descriptor its_output(ends[1]);

  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, its_input.get(), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&files, its_output.get(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&files, its_output.get(), STDERR_FILENO);
  std::vector<std::string> words = {path};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const int failed =
      ::posix_spawn(&child.pid_, path.c_str(), &files, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  if (failed != 0) {
    child.pid_ = -1;
    return failure(failed);
  }
  return child;
}

ChildProcess::ChildProcess(ChildProcess&& other) noexcept
    : name_(std::move(other.name_)),
      pid_(std::exchange(other.pid_, -1)),
      input_(std::move(other.input_)),
      said_pipe_(std::move(other.said_pipe_)),
      said_(std::move(other.said_)),
      fed_(other.fed_) {}

ChildProcess::~ChildProcess() {
  if (pid_ < 0) return;
  ::kill(pid_, SIGKILL);
  uninterrupted([this] { return ::waitpid(pid_, nullptr, 0); });
}

/// Keeps the end of what the child says.
void ChildProcess::listen() {
  std::array<char, 4096> piece;
  for (;;) {
    const ssize_t got = ::read(said_pipe_.get(), piece.data(), piece.size());
    if (got == 0) said_pipe_.close();
    if (got <= 0) break;
    said_.append(piece.data(), static_cast<size_t>(got));
    if (said_.size() > 2 * kLongestComplaint) said_.erase(0, said_.size() - kLongestComplaint);
  }
}

/// Until the input is ready for `events` (if any), the child says something, or a moment has
/// passed.
Status ChildProcess::wait(const MayGoOn& may_go_on, short events) {
  std::array<pollfd, 2> ready = {{{said_pipe_.get(), POLLIN, 0}, {input_.get(), events, 0}}};
  (void)::poll(ready.data(), ready.size(), kAskEvery);  // leaves out descriptors that are -1
  listen();
  return may_go_on();
}

Result<bool> ChildProcess::feed(std::span<const std::byte> bytes, const MayGoOn& may_go_on) {
  while (!bytes.empty()) {
    const ssize_t sent =
        ::send(input_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent >= 0) {
      bytes = bytes.subspan(static_cast<size_t>(sent));
      fed_ += static_cast<size_t>(sent);
    } else if (errno == EAGAIN) {
      if (auto going = wait(may_go_on, POLLOUT); !going) return going.error();
    } else if (errno != EINTR) {
      return false;
    }
  }
  return true;
}

Status ChildProcess::finish(const MayGoOn& may_go_on) {
  input_.close();
  int status = 0;
  for (;;) {
    const pid_t ended = ::waitpid(pid_, &status, WNOHANG);
    if (ended == pid_) break;
    if (ended < 0 && errno != EINTR) return Error{name_ + ": " + std::strerror(errno)};
    if (auto going = wait(may_go_on, 0); !going) return going;
  }
  pid_ = -1;
  listen();
  while (!said_.empty() && said_.back() == '\n') said_.pop_back();
  if (said_.size() > kLongestComplaint) said_.erase(0, said_.size() - kLongestComplaint);
  const std::string why = said_.empty() ? "" : ": " + said_;
  if (WIFSIGNALED(status)) {
    return Error{fmt::format("{} was ended by signal {}{}", name_, WTERMSIG(status), why)};
  }
  if (WEXITSTATUS(status) != 0) {
    return Error{fmt::format("{} failed ({}){}", name_, WEXITSTATUS(status), why)};
  }
  return {};
}

}  // namespace hyades::core
