/// Computing parts of a study in several processes.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "emscape/base/progress.h"

namespace emscape::study {

/// Computes parts in `jobs` processes, each of which keeps its fields between parts. A process that is killed
/// by a signal is replaced by one that continues its part.
/// @param command  of the processes: a program's file and its arguments; each reads numbers of parts from
/// standard input and writes those of completed parts to standard output
/// @param finishedBytes  a number that grows with each finished variant of a part
/// @param progress  called several times a second; an exception that it throws ends the processes
/// @throws Error with the code of a failed process, which has printed its message
void computeInProcesses(const std::vector<int>& parts, int jobs, const std::vector<std::string>& command,
                        const std::function<std::uintmax_t(int)>& finishedBytes,
                        const ProgressSink& progress);

/// Number of processors that this process may use: limited by the machine, its control group and
/// SLURM_CPUS_PER_TASK.
int allowedProcessors();

}  // namespace emscape::study
