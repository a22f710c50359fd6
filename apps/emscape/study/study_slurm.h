/// Slurm jobs that compute the parts of a study.
#pragma once

#include <string>
#include <vector>

#include "apps/common/command.h"

namespace emscape::app {

struct SlurmOptions {
  std::string script;  ///< file to write; empty: none
  int chunks = 0;      ///< parts; 0: default number
  std::string time = "01:00:00";
  int gpus = 0;
  bool submit = false;
};

/// @return why a text is not a time limit of Slurm; empty if it is one
std::string faultOfSlurmTime(const std::string& time);

/// The script that merges the parts: NAME.merge.sh.
std::string mergeScriptOf(const SlurmOptions& options);

/// Writes the script of a job array with one task per part, and mergeScriptOf(), which merges them; both run
/// in the current folder.
/// @param arguments  of a process that computes parts: study, FILE, -o, DIR, --worker, ...
/// @return the exit status
/// @throws Error (other)
int writeSlurmJobs(const SlurmOptions& options, const std::vector<std::string>& arguments, int parts,
                   const GlobalOptions& global);

}  // namespace emscape::app
