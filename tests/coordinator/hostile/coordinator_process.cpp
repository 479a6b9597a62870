#include "tests/coordinator/hostile/coordinator_process.h"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <thread>

namespace hyades::test {
namespace {

constexpr std::chrono::milliseconds kLook{20};
constexpr int kLooks = 1000;

}  // namespace

CoordinatorProcess::CoordinatorProcess(const std::vector<std::string>& more) {
  const std::string data = folder_.file("data");
  std::vector<std::string> words = {
      "hyades-coordinator", "coordinator", "--http", "off", "--data", data,
      "--listen",           "127.0.0.1:0"};
  words.insert(words.end(), more.begin(), more.end());
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_ = ::fork();
  if (pid_ == 0) {
    ::execv(HYADES_COORDINATOR, arguments.data());
    ::_exit(127);
  }
  for (int i = 0; i < kLooks && address_.empty(); ++i) {
    std::this_thread::sleep_for(kLook);
    std::ifstream(data + "/address") >> address_;
  }
}

CoordinatorProcess::~CoordinatorProcess() { end(); }

uint64_t CoordinatorProcess::peak_mib() const { return status_mib("VmHWM:"); }

uint64_t CoordinatorProcess::memory_mib() const { return status_mib("VmRSS:"); }

uint64_t CoordinatorProcess::status_mib(const std::string& name) const {
  std::ifstream status("/proc/" + std::to_string(pid_) + "/status");
  for (std::string word; status >> word;) {
    uint64_t kib = 0;
    if (word == name && status >> kib) return kib / 1024;
  }
  return UINT64_MAX;
}

bool CoordinatorProcess::alive() const {
  siginfo_t info{};
  return ::waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
         info.si_pid == 0;
}

int CoordinatorProcess::end() {
  if (pid_ <= 0) return -1;
  int status = 0;
  ::kill(pid_, SIGTERM);
  for (int i = 0; i < kLooks; ++i) {
    if (::waitpid(pid_, &status, WNOHANG) == pid_) {
      pid_ = -1;
      return status;
    }
    std::this_thread::sleep_for(kLook);
  }
  ::kill(pid_, SIGKILL);
  ::waitpid(pid_, &status, 0);
  pid_ = -1;
  return status;
}

}  // namespace hyades::test
