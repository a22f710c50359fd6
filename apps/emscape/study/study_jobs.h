/// Computing parts of a study in several processes of this program.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "emscape/base/progress.h"

namespace emscape::app {

/// Computes parts in `jobs` processes, each of which keeps its fields between parts. A process that is killed
/// by a signal is replaced by one that continues its part.
/// @param arguments  of the processes, without the program's name; each reads numbers of parts from standard
/// input and writes those of completed parts to standard output
/// @param finishedBytes  a number that grows with each finished variant of a part
/// @throws Error with the code of a failed process, which has printed its message; playback::Stopped
void computeInProcesses(const std::vector<int>& parts, int jobs, const std::vector<std::string>& arguments,
                        const std::function<std::uintmax_t(int)>& finishedBytes,
                        const ProgressSink& progress);

/// Number of processors that this process may use: limited by the machine, its control group and
/// SLURM_CPUS_PER_TASK.
int allowedProcessors();

}  // namespace emscape::app
