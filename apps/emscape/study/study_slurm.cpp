#include "apps/emscape/study/study_slurm.h"

#include <fmt/core.h>
#include <sys/stat.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <regex>

#include "apps/common/console.h"
#include "base/files/whole_file.h"
#include "base/text/readable_text.h"
#include "base/text/shell_word.h"
#include "emscape/base/error.h"

namespace emscape::app {
namespace {

namespace fs = std::filesystem;

/// Tasks of the array that may run at the same time.
constexpr int kTasksAtOnce = 20;

void writeScript(const fs::path& file, const std::string& text) {
  writeWhole(file, [&](std::ostream& out) { out << text; });
  fs::permissions(file, fs::perms::owner_exec | fs::perms::group_exec | fs::perms::others_exec,
                  fs::perm_options::add);
}

/// Submits a job; returns the number that sbatch prints.
std::string submit(const std::string& command) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::string answer;
  std::array<char, 256> bytes{};
  while (pipe != nullptr && std::fgets(bytes.data(), bytes.size(), pipe.get()) != nullptr)
    answer += bytes.data();
  const std::string number = answer.substr(0, answer.find_first_not_of("0123456789"));  // of "NUMBER;CLUSTER"
  if (number.empty()) {
    throw Error(ErrorCode::other, fmt::format("'{}' gave no job: {}", command, answer));
  }
  return number;
}

}  // namespace

std::string faultOfSlurmTime(const std::string& time) {
  static const std::regex kTime("([0-9]+-)?[0-9]{1,2}(:[0-9]{2}){0,2}");
  if (time.size() <= 20 && std::regex_match(time, kTime)) return "";
  return fmt::format("'{}' is not a time limit; write HH:MM:SS or DAYS-HH:MM", readableText(time));
}

std::string mergeScriptOf(const SlurmOptions& options) {
  return options.script + ".merge.sh";
}

int writeSlurmJobs(const SlurmOptions& options, const std::vector<std::string>& arguments, int parts,
                   const GlobalOptions& global) {
  std::string command = "emscape";
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (arguments[i] == "--worker") continue;
    if (arguments[i] == "--threads") {  // the allocation's number is used
      ++i;
      continue;
    }
    command += " " + shellWord(arguments[i]);
  }
  // A name that begins with '-' would be an option of sbatch.
  const auto asArgument = [](const fs::path& file) {
    return shellWord(file.string().rfind('-', 0) == 0 ? "./" + file.string() : file.string());
  };
  const fs::path script = options.script, merge = mergeScriptOf(options);
  const std::string array = fmt::format("--array=1-{}%{}", parts, kTasksAtOnce);
  const std::string gpus = options.gpus > 0 ? fmt::format("#SBATCH --gpus-per-task={}\n", options.gpus) : "";
  writeScript(
      script,
      fmt::format("#!/bin/sh\n"
                  "# Computes part $SLURM_ARRAY_TASK_ID of {0}. EMSCAPE_DIR: the folder of the program, if "
                  "it is not on the PATH.\n"
                  "#SBATCH --job-name=emscape-study\n#SBATCH {1}\n#SBATCH --time={2}\n"
                  "#SBATCH --ntasks=1\n#SBATCH --requeue\n{3}"
                  "PATH=\"${{EMSCAPE_DIR:+$EMSCAPE_DIR:}}$PATH\"\n"
                  "exec {4} --part \"$SLURM_ARRAY_TASK_ID/{0}\"\n",
                  parts, array, options.time, gpus, command));
  writeScript(merge, fmt::format("#!/bin/sh\n#SBATCH --job-name=emscape-merge\n#SBATCH --time={}\n"
                                 "#SBATCH --ntasks=1\nPATH=\"${{EMSCAPE_DIR:+$EMSCAPE_DIR:}}$PATH\"\n"
                                 "exec {} --merge\n",
                                 options.time, command));
  if (options.submit) {
    const std::string job = submit("sbatch --parsable " + asArgument(script));
    const std::string merging =
        submit(fmt::format("sbatch --parsable --dependency=afterok:{} {}", job, asArgument(merge)));
    if (global.json) {
      printJson({{"script", script.string()}, {"parts", parts}, {"job", job}, {"merge_job", merging}});
    } else {
      print("submitted: job {} of {} parts, and job {} that merges them\n", job, parts, merging);
    }
    return 0;
  }
  if (global.json) {
    printJson({{"script", script.string()}, {"merge_script", merge.string()}, {"parts", parts}});
    return 0;
  }
  print(
      "Wrote {0} and {1}. To submit {2} parts and their merging:\n"
      "  job=$(sbatch --parsable {3})\n  sbatch --dependency=afterok:$job {4}\n",
      script.string(), merge.string(), parts, asArgument(script), asArgument(merge));
  return 0;
}

}  // namespace emscape::app
