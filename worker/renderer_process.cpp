#include "worker/renderer_process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/base/own_environment.h"
#include "core/base/posix_file.h"
#include "worker/renderer_talk.h"

namespace hyades::worker {
namespace {

/// Where the child finds its end of the pipe.
constexpr int kChildPipe = 3;

std::string describe_end(int status) {
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    if (signal == SIGKILL) {
      return "was killed by signal 9: most likely this machine ran out of memory";
    }
    return fmt::format("crashed with signal {} ({})", signal, strsignal(signal));
  }
  return fmt::format("ended with status {}", WEXITSTATUS(status));
}

}  // namespace

core::Result<std::unique_ptr<RendererProcess>> RendererProcess::start(
    const RendererOptions& options, Listener& listener) {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    return core::Error{std::string("no socket pair for the renderer: ") + std::strerror(errno)};
  }
  std::vector<std::string> words = {options.program,
                                    "--threads",
                                    std::to_string(options.threads),
                                    "--memory",
                                    std::to_string(options.memory),
                                    "--texture-disk",
                                    std::to_string(options.texture_disk),
                                    "--cache",
                                    options.cache,
                                    "--sandbox",
                                    options.sandbox};
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], kChildPipe);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  std::vector<std::string> environment = core::own_environment();
  pid_t pid = 0;
  const int error = ::posix_spawn(&pid, options.program.c_str(), &actions, nullptr,
                                  arguments.data(), core::for_exec(environment).data());
  posix_spawn_file_actions_destroy(&actions);
  ::close(ends[1]);
  if (error != 0) {
    ::close(ends[0]);
    return core::Error{options.program + ": cannot be started: " + std::strerror(error)};
  }
  return std::unique_ptr<RendererProcess>(new RendererProcess(pid, ends[0], listener));
}

RendererProcess::RendererProcess(pid_t pid, int fd, Listener& listener)
    : listener_(listener),
      pipe_(fd, renderer_limits()),
      pid_(pid),
      reader_([this] { read_loop(); }),
      writer_([this] { write_loop(); }) {}

RendererProcess::~RendererProcess() {
  {
    const core::MutexLock lock(mutex_);
    closing_ = true;
    wake_.notify_all();
  }
  kill_child();
  pipe_.shut_down();
  reader_.join();
  writer_.join();
}

void RendererProcess::kill_child() {
  const core::MutexLock lock(mutex_);
  if (!reaped_) ::kill(pid_, SIGKILL);
}

void RendererProcess::kill(const std::string& reason) {
  const core::MutexLock lock(mutex_);
  kill_locked(reason);
}

void RendererProcess::kill_locked(const std::string& reason) {
  if (reaped_) return;
  killed_ = reason;
  ::kill(pid_, SIGKILL);
}

void RendererProcess::send(pipe::ToRenderer message) {
  const core::MutexLock lock(mutex_);
  if (!killed_.empty()) return;  // nobody will read it
  outgoing_bytes_ += message.ByteSizeLong();
  if (outgoing_bytes_ > kMostUnread) {
    kill_locked("did not read what it was told and was killed");
    return;
  }
  outgoing_.push_back(std::move(message));
  wake_.notify_all();  // the reader may wait, too
}

void RendererProcess::heard() {
  const core::MutexLock lock(mutex_);
  if (unheard_.empty()) return;
  unheard_bytes_ -= unheard_.front();
  unheard_.pop_front();
  wake_.notify_all();
}

void RendererProcess::wait_for_listener(size_t bytes) {
  const core::MutexLock lock(mutex_);
  while (!closing_ && (unheard_.size() >= kMostUnheard || unheard_bytes_ >= kMostUnheardBytes)) {
    wake_.wait(mutex_);
  }
  unheard_.push_back(bytes);
  unheard_bytes_ += bytes;
}

void RendererProcess::read_loop() {
  RendererTalk talk;
  for (;;) {
    pipe::FromRenderer message;
    std::string load;
    const auto more = pipe_.receive(message, load);
    if (more && !*more) break;
    const size_t bytes = load.size();
    const core::Status sound = more ? talk.hear(message, std::move(load)) : more.error();
    if (!sound) {
      kill(sound.error().message + " and was killed");
      break;
    }
    wait_for_listener(bytes);
    listener_.renderer_says(std::move(message));
  }
  kill_child();  // where it has merely closed its end
  siginfo_t info{};
  core::uninterrupted(
      [&] { return ::waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOWAIT); });
  bool wanted = false;
  std::string reason;
  {
    // Under the lock, so that nobody signals a pid that belongs to another process by then.
    const core::MutexLock lock(mutex_);
    int status = 0;
    ::waitpid(pid_, &status, 0);
    reason = killed_.empty() ? describe_end(status) : killed_;
    reaped_ = true;
    wanted = closing_;
    closing_ = true;
    wake_.notify_all();
  }
  if (!wanted) listener_.renderer_ended(reason);
}

void RendererProcess::write_loop() {
  for (;;) {
    pipe::ToRenderer message;
    {
      const core::MutexLock lock(mutex_);
      while (!closing_ && outgoing_.empty()) wake_.wait(mutex_);
      if (closing_) return;
      message = std::move(outgoing_.front());
      outgoing_.pop_front();
      outgoing_bytes_ -= message.ByteSizeLong();
    }
    if (!pipe_.send(message)) return;  // the reader notices why
  }
}

}  // namespace hyades::worker
