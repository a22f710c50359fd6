#include "apps/emscape/study/study_parts.h"

#include <fmt/core.h>

#include "apps/emscape/common/interrupt.h"
#include "apps/emscape/common/target.h"

namespace emscape::app {
namespace {

const char* instructionSet() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f")) return "avx512";
  if (__builtin_cpu_supports("avx2")) return "avx2";
  return "x86-64";
#else
  return "generic";
#endif
}

}  // namespace

PartComputer::PartComputer(const LoadedStudy& loaded, const study::StudyFolder& folder,
                           const GlobalOptions& global)
    : folder_(folder) {
  openOnTarget(global, "float", [&](const ComputeTarget& target) {
    files_ = std::make_unique<study::VariantFiles>(loaded.spec, folder.path(), folder.kept(),
                                                   target.fieldOptions());
    runner_ = std::make_unique<study::StudyRunner>(loaded.spec, loaded.plan, loaded.terrain,
                                                   target.fieldOptions(), files_.get());
    machine_ = fmt::format("{}, {}", target.device(), instructionSet());
    return 0;
  });
}

void PartComputer::compute(int part, const ProgressSink& progress) {
  if (folder_.hasPart(part)) return;
  const std::unique_ptr<study::PartJournal> journal = folder_.journal(part);
  runner_->run(
      journal->unfinished(),
      [&](study::VariantResult result) { journal->add(std::move(result), runner_->warnings(), machine_); },
      [&](const std::string& step, double fraction) {
        stopIfInterrupted();
        if (progress) progress(step, fraction);
      });
  folder_.writePart(part, *journal);
}

void computeParts(PartComputer& computer, const std::vector<int>& parts, const ProgressSink& progress) {
  for (std::size_t i = 0; i < parts.size(); ++i) {
    computer.compute(parts[i], [&](const std::string& step, double fraction) {
      if (fraction < 1)
        progress(step, (static_cast<double>(i) + fraction) / static_cast<double>(parts.size()));
    });
  }
  progress("variants", 1);
}

}  // namespace emscape::app
