#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/support/temp_folder.h"

namespace hyades::test {

/// `hyades coordinator` as a process of its own, on a free port of this machine.
class CoordinatorProcess {
 public:
  /// `more`: options besides.
  explicit CoordinatorProcess(const std::vector<std::string>& more = {});
  ~CoordinatorProcess();
  CoordinatorProcess(const CoordinatorProcess&) = delete;
  CoordinatorProcess& operator=(const CoordinatorProcess&) = delete;

  const std::string& address() const { return address_; }
  /// The most memory that it has had (VmHWM), in MiB.
  uint64_t peak_mib() const;
  /// The memory that it has now (VmRSS), in MiB.
  uint64_t memory_mib() const;
  bool alive() const;
  /// SIGTERM; what it ended with, as waitpid tells. Killed after 20 s.
  int end();

 private:
  uint64_t status_mib(const std::string& name) const;

  TempFolder folder_;
  int pid_ = -1;
  std::string address_;
};

}  // namespace hyades::test
