/// Limits of the control groups of the process: of Slurm, systemd and containers.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace emscape {

/// The control groups of a process, of version 1 or 2.
class ControlGroups {
 public:
  /// @param process  lists the groups of a process  @param root  where the hierarchies are mounted
  explicit ControlGroups(std::filesystem::path process = "/proc/self/cgroup",
                         std::filesystem::path root = "/sys/fs/cgroup")
      : process_(std::move(process)), root_(std::move(root)) {}

  /// Smallest remainder of the memory limits of the group and those around it; none without a limit. Page
  /// cache, although it can be dropped, counts as used.
  std::optional<std::size_t> memoryLeft_bytes() const;
  /// Smallest number of processors of the group and those around it; none without a limit.
  std::optional<double> processors() const;

 private:
  /// The folders of the process's group and of those around it, under each root at which they may be mounted.
  std::vector<std::filesystem::path> foldersOf(const std::string& controller) const;

  std::filesystem::path process_, root_;
};

}  // namespace emscape
