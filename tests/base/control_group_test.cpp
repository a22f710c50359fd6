// Limits of control groups, from copies of what the system shows.
#include "base/control_group.h"

#include <gtest/gtest.h>

#include "tests/support/files.h"
#include "tests/support/temporary_folder.h"

namespace emscape {
namespace {

namespace fs = std::filesystem;

/// Folders as below /sys/fs/cgroup.
class ControlGroup : public testing::Test {
 protected:
  void put(const std::string& name, const std::string& text) {
    fs::create_directories((folder_.path() / "groups" / name).parent_path());
    test::writeFile(folder_.path() / "groups" / name, text);
  }
  ControlGroups groups(const std::string& of_process) {
    test::writeFile(folder_.path() / "process", of_process);
    return ControlGroups(folder_.path() / "process", folder_.path() / "groups");
  }

 private:
  const test::TemporaryFolder folder_;
};

TEST_F(ControlGroup, Version2LimitsByTheSmallestRemainderOfTheGroupAndThoseAroundIt) {
  put("slurm/job/memory.max", "max\n");
  put("slurm/job/memory.current", "100\n");
  put("slurm/memory.max", "1000\n");
  put("slurm/memory.current", "300\n");
  put("memory.max", "5000\n");
  put("memory.current", "400\n");
  put("slurm/job/cpu.max", "150000 100000\n");
  put("slurm/cpu.max", "max 100000\n");
  EXPECT_EQ(groups("0::/slurm/job\n").memoryLeft_bytes(), 700u);
  EXPECT_EQ(groups("0::/slurm/job\n").processors(), 1.5);
  EXPECT_EQ(groups("0::/\n").memoryLeft_bytes(), 4600u);
  EXPECT_EQ(groups("0::/\n").processors(), std::nullopt);
}

TEST_F(ControlGroup, Version1HasAHierarchyPerController) {
  put("memory/job/memory.limit_in_bytes", "2000\n");
  put("memory/job/memory.usage_in_bytes", "2500\n");
  put("memory/memory.limit_in_bytes", "9223372036854771712\n");
  put("memory/memory.usage_in_bytes", "3000\n");
  put("cpu,cpuacct/job/cpu.cfs_quota_us", "300000\n");
  put("cpu,cpuacct/job/cpu.cfs_period_us", "100000\n");
  put("cpu,cpuacct/cpu.cfs_quota_us", "-1\n");
  put("cpu,cpuacct/cpu.cfs_period_us", "100000\n");
  const std::string of_process = "4:cpu,cpuacct:/job\n3:memory:/job\n1:name=systemd:/other\n";
  EXPECT_EQ(groups(of_process).memoryLeft_bytes(), 0u);
  EXPECT_EQ(groups(of_process).processors(), 3);
  EXPECT_EQ(groups("3:memory:/\n").memoryLeft_bytes(), std::nullopt);
}

TEST_F(ControlGroup, AreWithoutLimitWhereNothingIsMounted) {
  EXPECT_EQ(groups("0::/user.slice\n").memoryLeft_bytes(), std::nullopt);
  EXPECT_EQ(groups("").processors(), std::nullopt);
}

}  // namespace
}  // namespace emscape
