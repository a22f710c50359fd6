/// Parts of a study computed by several processes of this program.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "emscape/base/progress.h"

namespace emscape::app {

/// Computes parts in `jobs` processes, each of which keeps its fields from part to part. A process that a
/// signal ends is replaced by one that goes on with its part.
/// @param arguments  of the processes, without the program's name; each reads the numbers of parts from its
/// standard input and writes those that are complete to its standard output
/// @param finishedBytes  a number that grows with each finished variant of a part
/// @throws Error with the code of a process that failed, which has printed its message; playback::Stopped
void computeInProcesses(const std::vector<int>& parts, int jobs, const std::vector<std::string>& arguments,
                        const std::function<std::uintmax_t(int)>& finishedBytes,
                        const ProgressSink& progress);

/// The processors that this process may use: of the machine, of its control group, and SLURM_CPUS_PER_TASK.
int allowedProcessors();

}  // namespace emscape::app
