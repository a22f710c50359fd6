/// emscape study: measures of many variants of a scenario.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <iostream>
#include <memory>

#include "apps/common/console.h"
#include "apps/common/interrupt.h"
#include "apps/emscape/study/study_slurm.h"
#include "apps/emscape/subcommands.h"
#include "base/files/folder_lock.h"
#include "base/stopwatch.h"
#include "base/threads.h"
#include "emscape/base/log.h"
#include "emscape/base/parallel.h"
#include "report/maps/output_files.h"
#include "report/maps/study_results.h"
#include "report/warnings.h"
#include "study/sweep/results/part_processes.h"

namespace emscape::app {
namespace {

struct StudyCommand {
  std::string study;
  std::vector<scenario::Edit> edits;
  std::string folder;
  bool plan = false;
  std::string kept;
  int jobs = 1;
  std::string part;
  bool resume = false;
  bool merge = false;
  bool partial = false;
  bool worker = false;
  SlurmOptions slurm;
};

struct PartNumber {
  int part = 0, parts = 0;
};

/// @throws Error (usage)
PartNumber parsePart(const std::string& text) {
  PartNumber number;
  const char* const end = text.data() + text.size();
  const auto part = std::from_chars(text.data(), end, number.part);
  const bool has_slash = part.ec == std::errc() && part.ptr != end && *part.ptr == '/';
  const auto parts = has_slash ? std::from_chars(part.ptr + 1, end, number.parts) : part;
  if (!has_slash || parts.ec != std::errc() || parts.ptr != end || number.part < 1 ||
      number.part > number.parts || number.parts > study::kMaxParts) {
    throw Error(ErrorCode::usage, fmt::format("--part '{}' must be I/N, with I from 1 to N and N up to {}",
                                              text, study::kMaxParts));
  }
  return number;
}

void checkAllThere(const study::StudyFolder& folder, const std::vector<int>& missing) {
  if (missing.empty()) return;
  constexpr std::size_t kNamed = 12;
  const auto named = missing.begin() + static_cast<std::ptrdiff_t>(std::min(missing.size(), kNamed));
  throw Error(
      ErrorCode::bad_input,
      fmt::format("{}: {} of {} parts are missing: {}{}; --resume computes them, --partial merges the others",
                  folder.path().string(), missing.size(), folder.parts(),
                  fmt::join(missing.begin(), named, ", "), missing.size() > kNamed ? ", ..." : ""));
}

int merge(const study::LoadedStudy& loaded, const study::StudyFolder& folder, bool partial,
          const GlobalOptions& global) {
  if (!partial) checkAllThere(folder, folder.missingParts());
  const report::StudyReport report = report::mergeParts(loaded, folder);
  report::logWarnings(report.warnings, {loaded.spec.base});
  if (global.json) {
    printJson(report::toJson(report));
  } else {
    printResult(report::studyText(report));
  }
  return 0;
}

/// Computes the parts whose numbers are read from standard input.
int work(const study::LoadedStudy& loaded, const study::StudyFolder& folder, const GlobalOptions& global) {
  const auto isComplete = [](int part) {
    print("{}\n", part);
    finishResult();
  };
  study::PartComputer(loaded, folder, global.backend)
      .serve(std::cin, isComplete, [](const std::string&, double) { stopIfInterrupted(); });
  return 0;
}

/// The scripts of --slurm; none if it was not given.
std::vector<report::NamedFile> scriptsOf(const SlurmOptions& slurm) {
  if (slurm.script.empty()) return {};
  return report::outputsOf("--slurm", {slurm.script, mergeScriptOf(slurm)});
}

/// The files that --keep names; empty if it was not given.
std::optional<study::KeptFiles> keptFiles(const StudyCommand& command) {
  if (command.kept.empty()) return std::nullopt;
  return command.kept == "maps" ? study::KeptFiles::maps : study::KeptFiles::volumes;
}

/// @return the arguments of a process that computes parts
std::vector<std::string> workerArguments(const StudyCommand& command, const GlobalOptions& global,
                                         int threads) {
  std::vector<std::string> arguments{
      "study",     command.study,  "-o",      command.folder, "--worker",
      "--backend", global.backend, "--quiet", "--threads",    fmt::format("{}", threads)};
  if (global.devices != 1) arguments.insert(arguments.end(), {"--devices", devicesText(global.devices)});
  for (const scenario::Edit& edit : command.edits) {
    arguments.emplace_back("--set");
    arguments.push_back(toString(edit));
  }
  return arguments;
}

int runPlan(const study::LoadedStudy& loaded, const StudyCommand& command, double loading_s,
            const GlobalOptions& global) {
  const int parts =
      command.slurm.chunks > 0 ? command.slurm.chunks : study::usualParts(loaded.spec.variants.count());
  const report::PlanReport plan = report::planReport(loaded, parts, command.jobs, loading_s, global.backend,
                                                     [](const std::string&, double) { stopIfInterrupted(); });
  if (global.json) {
    printJson(report::toJson(plan));
  } else {
    printResult(report::planText(plan));
  }
  return 0;
}

int runPart(const study::LoadedStudy& loaded, study::StudyFolder& folder, const StudyCommand& command,
            const GlobalOptions& global) {
  const PartNumber number = parsePart(command.part);
  study::checkParts(number.parts, loaded.spec.variants.count());
  folder.begin(number.parts, keptFiles(command));
  study::PartComputer(loaded, folder, global.backend).compute(number.part, stoppingProgress(global));
  if (global.json) printJson({{"part", number.part}, {"parts", number.parts}});
  return 0;
}

int runStudy(const StudyCommand& command, const GlobalOptions& global) {
  Stopwatch watch;
  const int wanted = global.threads > 0 ? global.threads : study::allowedProcessors();
  const int threads = sparesThreads() ? 1 : wanted;
  setThreadLimit(threads);
  if (command.worker) {
    ignoreFurtherSignals();
    setLogSink([](LogLevel, const std::string&) {});  // the parent process logs
  }
  if (!command.plan && command.folder.empty()) {
    throw Error(ErrorCode::usage, "--output is required, except with --plan");
  }
  const study::LoadedStudy loaded(command.study, command.edits, !command.worker);
  if (command.plan) return runPlan(loaded, command, watch.lap_ms() / 1000, global);
  const std::vector<report::NamedFile> scripts = scriptsOf(command.slurm);
  report::checkStudyFolder(command.folder, loaded.spec, "--output", scripts);
  for (const report::NamedFile& script : scripts) report::requireFolders({script.file});
  study::StudyFolder folder = loaded.folder(command.folder);
  const std::optional<int> planned = folder.partsOfManifest();
  const std::size_t variants = loaded.spec.variants.count();
  if (!command.part.empty()) return runPart(loaded, folder, command, global);
  const int parts =
      command.slurm.chunks > 0 ? command.slurm.chunks : planned.value_or(study::usualParts(variants));
  study::checkParts(parts, variants);
  if (command.merge && !planned && command.slurm.script.empty()) {
    throw Error(ErrorCode::bad_input, command.folder + ": has no manifest.json: no part was computed");
  }
  folder.begin(parts, keptFiles(command));
  if (!command.slurm.script.empty()) {
    return writeSlurmJobs(command.slurm, workerArguments(command, global, 0), parts, global);
  }
  if (command.worker) return work(loaded, folder, global);
  const FolderLock lock(folder.path(), ".study.lock");
  if (command.merge) return merge(loaded, folder, command.partial, global);

  const std::vector<int> missing = folder.missingParts();
  if (!command.resume && static_cast<int>(missing.size()) < parts) {
    throw Error(ErrorCode::usage, fmt::format("{} holds {} of {} parts of this study; {}", command.folder,
                                              static_cast<std::size_t>(parts) - missing.size(), parts,
                                              missing.empty() ? "--merge writes their results again"
                                                              : "--resume computes the others"));
  }
  logInfo(fmt::format("{} variants of {} in {} parts, {} of them to compute", variants,
                      loaded.spec.base->name, parts, missing.size()));
  study::PartWorkers workers{command.jobs, {"/proc/self/exe"}};
  const std::vector<std::string> arguments =
      workerArguments(command, global, std::max(1, threads / command.jobs));
  workers.command.insert(workers.command.end(), arguments.begin(), arguments.end());
  study::computeParts(loaded, folder, missing, global.backend, workers, stoppingProgress(global));
  return merge(loaded, folder, false, global);
}

/// The process that started a worker reports that both were stopped.
int runReported(const StudyCommand& command, const GlobalOptions& global) {
  try {
    return runStudy(command, global);
  } catch (const Stopped&) {
    if (!command.worker) throw;
    return 128 + caughtSignal();
  }
}

}  // namespace

void addStudy(CLI::App& app, const GlobalOptions& global, Action& action) {
  CLI::App* command = app.add_subcommand(
      "study", "Variants, sweeps, samples and sites of a scenario, each measured on its maps of coverage");
  command->fallthrough();
  command->footer(R"(
The study's file says which variants of a scenario there are and what is measured of each; docs/what-if.md describes it. Variants
are computed in the order in which most of the field can be kept: a change of a power needs no terrain profile.

DIR/results.csv and DIR/results.nc hold the measures of every variant, DIR/report.html tables and plots. The study is cut into
parts (DIR/parts), each written when it is complete. Finished variants of a part are kept as they come: --resume computes what
is missing, after an interruption, a kill or a full disk. With --keep, DIR/variants has the maps or volumes of each variant.

Machines that share DIR compute a study together: each computes the parts that a scheduler assigns to it by --part I/N, in any
order, and --merge joins them. The results are identical, byte by byte.

Examples:
  emscape study scenarios/study/jammer_power.yaml --plan
  emscape study scenarios/study/jammer_power.yaml -o out --jobs 2
  emscape study scenarios/study/jammer_power.yaml -o out --keep maps
  emscape study scenarios/study/jammer_power.yaml -o out --part 3/7
  emscape study scenarios/study/jammer_power.yaml -o out --merge
  emscape study scenarios/study/jammer_power.yaml -o out --slurm job.sh --chunks 40 --time 00:20:00)");
  auto options = std::make_shared<StudyCommand>();
  command->add_option("STUDY", options->study, "Study (YAML or JSON)")->required();
  addSetOption(*command, options->edits);
  command->add_option("-o,--output", options->folder, "Folder of the results");
  CLI::Option* plan = command->add_flag("--plan", options->plan,
                                        "Print the number of variants, what each changes, and the time "
                                        "needed; compute one of each kind, write nothing");
  command
      ->add_option("--keep", options->kept,
                   "Keep the maps of each variant (GeoTIFF) or its volumes (.vdb), in DIR/variants")
      ->check(CLI::IsMember({"maps", "volumes"}))
      ->default_str("");
  CLI::Option* jobs = command->add_option("--jobs", options->jobs, "Processes that compute at the same time")
                          ->check(CLI::Range(1, 1024));
  CLI::Option* part =
      command->add_option("--part", options->part, "I/N: compute what is missing of part I of N");
  CLI::Option* resume = command->add_flag("--resume", options->resume, "Compute the parts that are missing");
  CLI::Option* merge = command->add_flag("--merge", options->merge, "Join the parts; all must exist");
  command->add_flag("--partial", options->partial, "With --merge: join the parts that exist")->needs(merge);
  CLI::Option* slurm =
      command->add_option("--slurm", options->slurm.script,
                          "Write the job script of a Slurm array, and one that merges the parts");
  command->add_option("--chunks", options->slurm.chunks, "Number of parts; default: 16 variants in each")
      ->check(CLI::Range(1, study::kMaxParts))
      ->default_str("");
  command->add_option("--time", options->slurm.time, "With --slurm: time limit of a part, HH:MM:SS")
      ->check(faultOfSlurmTime)
      ->needs(slurm);
  command->add_option("--gpus", options->slurm.gpus, "With --slurm: number of GPUs of a part")
      ->check(CLI::Range(0, 64))
      ->needs(slurm);
  command->add_flag("--submit", options->slurm.submit, "With --slurm: submit both jobs")->needs(slurm);
  command->add_flag("--worker", options->worker)->group("");
  for (CLI::Option* option : {part, resume, merge, slurm}) option->excludes(plan);
  for (CLI::Option* option : {resume, merge, slurm, jobs}) option->excludes(part);
  command->callback(
      [options, &global, &action] { action = [options, &global] { return runReported(*options, global); }; });
}

}  // namespace emscape::app
