#include "core/base/cgroup.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/temp_folder.h"

namespace hyades::core {
namespace {

/// A machine's files as the kernel shows them to a process in one of its groups.
class CgroupMemory : public testing::Test {
 protected:
  void write(const std::string& path, const std::string& text) {
    const std::filesystem::path file = folder_.path().string() + path;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file) << text << '\n';
  }

  /// ... of which `group` is the line of /proc/self/cgroup and `mounts` that of mountinfo.
  void in_group(const std::string& group, const std::string& mounts) {
    write("/proc/self/cgroup", group);
    write("/proc/self/mountinfo", "23 1 0:22 / / rw - ext4 /dev/vda rw\n" + mounts);
  }

  uint64_t limit() const { return cgroup_memory_limit(folder_.path().string()); }

 private:
  TempFolder folder_;
};

constexpr const char* kSecond = "31 23 0:28 / /sys/fs/cgroup rw - cgroup2 cgroup2 rw,nsdelegate";
constexpr const char* kFirst =
    "30 23 0:27 / /sys/fs/cgroup rw - tmpfs tmpfs rw\n"
    "31 30 0:28 / /sys/fs/cgroup/cpu rw shared:9 - cgroup cgroup rw,cpu,cpuacct\n"
    "32 30 0:29 / /sys/fs/cgroup/memory rw shared:10 - cgroup cgroup rw,memory";

TEST_F(CgroupMemory, IsTheLimitOfAServiceOfSystemd) {
  in_group("0::/system.slice/hyades\\x2dfarm.service", kSecond);
  write("/sys/fs/cgroup/system.slice/memory.max", "max");
  write("/sys/fs/cgroup/system.slice/hyades\\x2dfarm.service/memory.max", "1073741824");
  EXPECT_EQ(limit(), 1u << 30);
}

TEST_F(CgroupMemory, IsTheLeastOfAllGroupsAround) {
  in_group("0::/user.slice/batch/job", kSecond);
  write("/sys/fs/cgroup/user.slice/memory.max", "4096000");
  write("/sys/fs/cgroup/user.slice/batch/memory.max", "8192000");
  write("/sys/fs/cgroup/user.slice/batch/job/memory.max", "max");
  EXPECT_EQ(limit(), 4096000u);
}

TEST_F(CgroupMemory, OfAContainerThatIsTheRootOfWhatItSees) {
  in_group("0::/", kSecond);
  write("/sys/fs/cgroup/memory.max", "2097152");
  EXPECT_EQ(limit(), 2097152u);
}

TEST_F(CgroupMemory, OfTheFirstVersionOnlyItsMemoryCounts) {
  in_group("5:cpuacct,cpu:/a\n4:memory:/slurm/uid_1/job_2", kFirst);
  write("/sys/fs/cgroup/cpu/a/memory.limit_in_bytes", "1");
  write("/sys/fs/cgroup/memory/memory.limit_in_bytes", "9223372036854771712");
  write("/sys/fs/cgroup/memory/slurm/uid_1/job_2/memory.limit_in_bytes", "3145728");
  EXPECT_EQ(limit(), 3145728u);
}

TEST_F(CgroupMemory, OfAContainerThatSeesTheNameOfItsGroupOutside) {
  in_group("4:memory:/docker/abc/inner",
           "32 30 0:29 /docker/abc /mnt/a\\040b ro - cgroup cgroup rw,memory");
  write("/mnt/a b/memory.limit_in_bytes", "5242880");
  write("/mnt/a b/inner/memory.limit_in_bytes", "6291456");
  EXPECT_EQ(limit(), 5242880u);
}

TEST_F(CgroupMemory, IsWithoutBoundWhereNothingLimitsIt) {
  EXPECT_EQ(limit(), UINT64_MAX);  // no /proc at all
  in_group("0::/../other", kSecond);
  write("/sys/fs/cgroup/memory.max", "max");
  EXPECT_EQ(limit(), UINT64_MAX);
}

}  // namespace
}  // namespace hyades::core
