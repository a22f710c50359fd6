#include "apps/emscape/study/study_parts.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <thread>
#include <vector>

#include "apps/emscape/common/interrupt.h"
#include "apps/emscape/common/target.h"
#include "emscape/base/log.h"

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

/// The part that a process should try next: the one after its last, so that it computes successive parts;
/// otherwise the first part of the longest range on which no process works, or its middle if another process
/// is approaching it.
/// @param missing  ascending  @param is_free  for each: no process works on it
/// @return index into missing; -1: none is free
std::ptrdiff_t nextPart(const std::vector<int>& missing, const std::vector<bool>& is_free, int last) {
  std::size_t longest = 0, length = 0;
  for (std::size_t begin = 0; begin < missing.size();) {
    std::size_t end = begin;
    while (end < missing.size() && is_free[end] &&
           missing[end] == missing[begin] + static_cast<int>(end - begin)) {
      if (missing[end] == last + 1) return static_cast<std::ptrdiff_t>(end);
      ++end;
    }
    if (end - begin > length) {
      longest = begin;
      length = end - begin;
    }
    begin = std::max(end, begin + 1);
  }
  if (length == 0) return -1;
  const bool comes_another =
      longest > 0 && !is_free[longest - 1] && missing[longest - 1] + 1 == missing[longest];
  return static_cast<std::ptrdiff_t>(longest + (comes_another ? length / 2 : 0));
}

/// Waits between two checks for parts whose process has ended.
void waitAMoment() {
  for (int n = 0; n < 10; ++n) {
    stopIfInterrupted();
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
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

void computeAnyParts(PartComputer& computer, const study::StudyFolder& folder, const ProgressSink& progress) {
  std::vector<int> missing = folder.missingParts();
  const auto parts = static_cast<double>(folder.parts());
  int last = 0;
  bool is_waiting = false;
  while (!missing.empty()) {
    std::vector<bool> is_free;
    for (const int part : missing) is_free.push_back(!folder.isClaimed(part));
    const std::ptrdiff_t next = nextPart(missing, is_free, last);
    if (next < 0 && !is_waiting) {
      logInfo(fmt::format("{} parts are computed by other processes; waiting for them", missing.size()));
    }
    is_waiting = next < 0;
    if (is_waiting) {
      waitAMoment();
    } else if (const auto claim = folder.tryClaim(missing[static_cast<std::size_t>(next)])) {
      last = missing[static_cast<std::size_t>(next)];
      const double done = parts - static_cast<double>(missing.size());
      computer.compute(last, [&](const std::string& step, double fraction) {
        if (fraction < 1) progress(step, (done + fraction) / parts);
      });
    }
    missing.erase(
        std::remove_if(missing.begin(), missing.end(), [&](int part) { return folder.hasPart(part); }),
        missing.end());
  }
  progress("variants", 1);
}

}  // namespace emscape::app
