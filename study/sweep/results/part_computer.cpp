#include "study/sweep/results/part_computer.h"

#include <fmt/core.h>

#include "base/instruction_set.h"
#include "emscape/base/error.h"
#include "playback/frames/open_on_target.h"
#include "study/sweep/results/part_processes.h"

namespace emscape::study {
LoadedStudy::LoadedStudy(const std::string& file, const std::vector<scenario::Edit>& edits, bool tries_values)
    : spec(loadStudy(file, edits, EMSCAPE_VERSION, tries_values)),
      terrain(loadTerrain(*spec.base, spec.area)),
      plan(planStudy(spec, terrain)) {}

StudyFolder LoadedStudy::folder(const std::filesystem::path& path) const {
  return {path, spec, plan, EMSCAPE_VERSION};
}

void checkParts(int parts, std::size_t variants) {
  if (parts >= 1 && static_cast<std::size_t>(parts) <= variants) return;
  throw Error(ErrorCode::usage,
              fmt::format("{} parts of {} variants; 1 to as many as there are variants", parts, variants));
}

PartComputer::PartComputer(const LoadedStudy& loaded, const StudyFolder& folder, const std::string& backend)
    : folder_(folder) {
  playback::openOnTarget(backend, [&](const playback::ComputeTarget& target) {
    files_ = std::make_unique<VariantFiles>(loaded.spec, folder.path(), folder.kept(), target.fieldOptions());
    runner_ = std::make_unique<StudyRunner>(loaded.spec, loaded.plan, loaded.terrain, target.fieldOptions(),
                                            files_.get());
    machine_ = fmt::format("{}, {}", target.device(), instructionSet());
    return 0;
  });
}

void PartComputer::compute(int part, const ProgressSink& progress) {
  if (folder_.hasPart(part)) return;
  const std::unique_ptr<PartJournal> journal = folder_.journal(part);
  runner_->run(
      journal->unfinished(),
      [&](VariantResult result) { journal->add(std::move(result), runner_->warnings(), machine_); },
      progress);
  folder_.writePart(part, *journal);
}

void PartComputer::serve(std::istream& in, const std::function<void(int part)>& isComplete,
                         const ProgressSink& progress) {
  for (int part; in >> part;) {
    compute(part, progress);
    isComplete(part);
  }
}

void computeParts(const LoadedStudy& loaded, const StudyFolder& folder, const std::vector<int>& parts,
                  const std::string& backend, const PartWorkers& workers, const ProgressSink& progress) {
  if (parts.empty()) return;
  for (const int part : parts) folder.requireReplaceable(part);  // before the first is computed
  if (workers.jobs > 1 && parts.size() > 1) {
    computeInProcesses(
        parts, workers.jobs, workers.command, [&](int part) { return folder.journalBytes(part); }, progress);
    return;
  }
  PartComputer computer(loaded, folder, backend);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    computer.compute(parts[i], [&](const std::string& step, double fraction) {
      if (fraction < 1)
        progress(step, (static_cast<double>(i) + fraction) / static_cast<double>(parts.size()));
    });
  }
  progress("variants", 1);
}

}  // namespace emscape::study
