#include "base/control_group.h"

#include <algorithm>
#include <fstream>
#include <sstream>

namespace emscape {
namespace fs = std::filesystem;
namespace {

/// Numbers at the beginning of a file; fewer if it is shorter or has other words, such as "max".
std::vector<double> numbersIn(const fs::path& file) {
  std::ifstream in(file);
  std::vector<double> numbers;
  for (double number = 0; in >> number;) numbers.push_back(number);
  return numbers;
}

/// The number in a file; none if it is below 0 or so large that it limits nothing.
std::optional<double> numberIn(const fs::path& file) {
  constexpr double kNoLimit = 1e18;  // version 1 writes the largest number of pages
  const std::vector<double> numbers = numbersIn(file);
  if (numbers.empty() || numbers.front() < 0 || numbers.front() > kNoLimit) return std::nullopt;
  return numbers.front();
}

template <class Number>
void keepLeast(std::optional<Number>& least, Number number) {
  least = std::min(least.value_or(number), number);
}

}  // namespace

std::vector<fs::path> ControlGroups::foldersOf(const std::string& controller) const {
  std::vector<fs::path> folders;
  const auto add = [&](const fs::path& mounted, const std::string& group) {
    // In a container the group's path may be that of the host, and its limits at the root.
    for (fs::path path = fs::path(group).relative_path(); !path.empty(); path = path.parent_path())
      folders.push_back(mounted / path);
    folders.push_back(mounted);
  };
  std::ifstream lines(process_);
  for (std::string line; std::getline(lines, line);) {  // "4:cpu,cpuacct:/group", or "0::/group" in version 2
    const std::size_t first = line.find(':');
    const std::size_t second = first == std::string::npos ? first : line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string names = line.substr(first + 1, second - first - 1), group = line.substr(second + 1);
    std::istringstream each(names);
    bool is_named = false;
    for (std::string name; std::getline(each, name, ',');) is_named = is_named || name == controller;
    if (names.empty()) {
      add(root_, group);
      add(root_ / "unified", group);
    } else if (is_named) {
      add(root_ / names, group);
      add(root_ / controller, group);
    }
  }
  if (folders.empty()) folders.push_back(root_);
  return folders;
}

std::optional<std::size_t> ControlGroups::memoryLeft_bytes() const {
  std::optional<std::size_t> least;
  for (const fs::path& folder : foldersOf("memory")) {
    for (const auto& [limit_file, taken_file] :
         {std::pair("memory.max", "memory.current"),
          std::pair("memory.limit_in_bytes", "memory.usage_in_bytes")}) {
      const std::optional<double> limit = numberIn(folder / limit_file),
                                  taken = numberIn(folder / taken_file);
      if (limit && taken) keepLeast(least, static_cast<std::size_t>(std::max(*limit - *taken, 0.0)));
    }
  }
  return least;
}

std::optional<double> ControlGroups::processors() const {
  std::optional<double> least;
  for (const fs::path& folder : foldersOf("cpu")) {
    const std::vector<double> both = numbersIn(folder / "cpu.max");  // "QUOTA PERIOD" or "max PERIOD"
    if (both.size() == 2 && both[0] > 0 && both[1] > 0) keepLeast(least, both[0] / both[1]);
    const auto quota = numberIn(folder / "cpu.cfs_quota_us"), period = numberIn(folder / "cpu.cfs_period_us");
    if (quota && period && *quota > 0 && *period > 0) keepLeast(least, *quota / *period);
  }
  return least;
}

}  // namespace emscape
