#pragma once

#include <sys/types.h>

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "tests/worker/process/fake_coordinator.h"

namespace hyades::worker {

/// The job's document.
extern const char* const kYaml;

std::string read_file(const std::string& path);

/// A job of one frame, what a coordinator needs of it, and its film as this process renders it.
struct Made {
  FakeCoordinator::Job job;
  std::string digest;
};

Made make_job(uint32_t batches_per_unit = 4);

/// A worker's processes, ended with the object.
class WorkerProcess {
 public:
  /// `more`: further words of its command line.
  WorkerProcess(const std::string& address, const std::string& folder,
                std::vector<std::string> more = {});
  ~WorkerProcess();
  WorkerProcess(const WorkerProcess&) = delete;
  WorkerProcess& operator=(const WorkerProcess&) = delete;

  void signal(int number) const;

  /// The exit status, within `limit`; nothing where it runs on, -N where signal N ended it.
  std::optional<int> wait(std::chrono::seconds limit);

  pid_t pid() const { return pid_; }
  /// The process that renders; 0 where there is none.
  pid_t renderer() const;
  std::string log() const { return read_file(log_); }

 private:
  pid_t pid_ = 0;
  std::string log_;
};

/// All units came, undamaged, and are the bits of one machine.
void expect_whole(const FakeCoordinator& coordinator, const Made& made);

}  // namespace hyades::worker
