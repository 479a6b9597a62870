#pragma once

#include <cstdint>
#include <string>

namespace hyades::core {

/// Bytes that this process's control groups (containers, systemd's MemoryMax, Slurm's, Kubernetes'
/// limits) leave it: the least limit of its own group and of those around it, as far as it sees
/// them, of version 1 and 2 (cgroups(7), proc_pid_mountinfo(5)). UINT64_MAX where there is none.
/// `root` is put before each path that is read, so that tests can try trees of their own.
uint64_t cgroup_memory_limit(const std::string& root = {});

}  // namespace hyades::core
