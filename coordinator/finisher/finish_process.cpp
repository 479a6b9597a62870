#include "coordinator/finisher/finish_process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <system_error>
#include <thread>

#include <fmt/format.h>

#include "core/base/io_reason.h"
#include "core/base/own_environment.h"
#include "core/base/posix_file.h"
#include "core/job/made_file.h"

namespace hyades::coordinator {
namespace {

constexpr std::chrono::minutes kLongest{10};  ///< of one frame
/// The program ends a video without progress itself; others may take days.
constexpr std::chrono::hours kLongestVideo{24 * 365};
constexpr std::chrono::seconds kGrace{3};  ///< from SIGTERM to SIGKILL
constexpr uint64_t kLongestComplaint = 1000;
constexpr const char* kSaid = "said.txt";

/// The end of what the process has said. It may have done with the file whatever it wanted.
std::string complaint(const std::string& folder) {
  const auto file = core::MadeFile::find(folder, kSaid);
  if (!file) return {};
  std::string said(std::min<uint64_t>(file->size(), kLongestComplaint), '\0');
  if (!file->read(file->size() - said.size(), std::as_writable_bytes(std::span(said)))) return {};
  while (!said.empty() && said.back() == '\n') said.pop_back();
  return said;
}

core::Status run(const std::string& program, std::string word, const std::string& folder,
                 std::chrono::steady_clock::duration longest, const std::atomic<bool>& stop) {
  const std::string said = folder + "/" + kSaid;
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  // Nothing of what the coordinator, or who has started it, has open: its log, say.
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDERR_FILENO, said.c_str(), O_WRONLY | O_CREAT, 0600);
  posix_spawn_file_actions_addclosefrom_np(&files, STDERR_FILENO + 1);
  std::string name = program;
  std::string where = folder;
  char* argv[] = {name.data(), word.data(), where.data(), nullptr};
  pid_t child = 0;
  // Signals that this process keeps for a thread of its own are to reach that one.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
  std::vector<std::string> variables = core::own_environment();
  const int failed = posix_spawn(&child, program.c_str(), &files, &attributes, argv,
                                 core::for_exec(variables).data());
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  if (failed != 0) {
    return core::Error{program + " could not be started: " + std::strerror(failed)};
  }
  const auto deadline = std::chrono::steady_clock::now() + longest;
  std::optional<std::chrono::steady_clock::time_point> asked;
  int status = 0;
  for (auto nap = std::chrono::microseconds(500);;) {
    const pid_t ended = core::uninterrupted([&] { return waitpid(child, &status, WNOHANG); });
    if (ended < 0) {
      return core::Error{"nobody knows how the finisher has ended: " + core::io_reason(errno)};
    }
    if (ended == child) break;
    const auto now = std::chrono::steady_clock::now();
    if (!asked && (stop || now > deadline)) {
      kill(child, SIGTERM);
      asked = now;
    } else if (asked && now > *asked + kGrace) {
      kill(child, SIGKILL);
    }
    std::this_thread::sleep_for(nap);
    nap = std::min(2 * nap, std::chrono::microseconds(20'000));
  }
  if (asked) return core::Error{stop ? "the coordinator stops" : "finishing took too long"};
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL) {
    return core::Error{
        "the finisher was killed: mostly the system does so where memory is short, as a film that "
        "is finished is in memory twice (a smaller --film-memory leaves more)"};
  }
  if (WIFSIGNALED(status)) {
    return core::Error{fmt::format("the finisher was ended by signal {}", WTERMSIG(status))};
  }
  if (WEXITSTATUS(status) != 0) {
    const std::string why = complaint(folder);
    return core::Error{why.empty() ? fmt::format("the finisher failed ({})", WEXITSTATUS(status))
                                   : why};
  }
  return {};
}

/// Which of the files that are expected among the outputs `make` has made, in a folder that is
/// there meanwhile.
core::Result<std::vector<FinishedFile>> in_folder(const std::string& folder,
                                                  const std::string& outputs,
                                                  const std::vector<std::string>& expected,
                                                  const std::function<core::Status()>& make) {
  std::error_code failed;
  std::filesystem::remove_all(folder, failed);
  std::filesystem::create_directories(folder, failed);
  if (failed) return core::Error{folder + ": cannot be made: " + failed.message()};
  const core::Status done = make();
  core::Result<std::vector<FinishedFile>> files = core::Error{};
  if (done) files = read_finish_result(folder, outputs, expected);
  std::filesystem::remove_all(folder, failed);
  if (!done) return done.error();
  return files;
}

}  // namespace

core::Result<std::vector<FinishedFile>> run_finisher(const std::string& program,
                                                     const std::string& folder,
                                                     const FinishTask& task, const core::Film& film,
                                                     const std::atomic<bool>& stop) {
  return in_folder(folder, task.folder, files_of(task), [&] {
    core::Status done = write_finish_task(folder, task, film);
    return done ? run(program, "finish", folder, kLongest, stop) : done;
  });
}

core::Result<std::vector<FinishedFile>> run_video_maker(const std::string& program,
                                                        const std::string& folder,
                                                        const VideoTask& task,
                                                        const std::atomic<bool>& stop) {
  return in_folder(folder, task.frames.folder, files_of(task), [&] {
    core::Status done = write_video_task(folder, task);
    return done ? run(program, "video", folder, kLongestVideo, stop) : done;
  });
}

}  // namespace hyades::coordinator
