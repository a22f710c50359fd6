/// Computes the variants of a study.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "emscape/base/progress.h"
#include "study/sweep/study_plan.h"
#include "study/sweep/variant_files.h"

namespace emscape::study {

/// Measures of a variant.
struct VariantResult {
  std::size_t variant = 0;
  std::vector<double> values;  ///< of the study's measures; NaN if no pixel has a value
  /// For a search for sites: per pixel, 1 if the measure to maximise has its area class; else empty.
  std::vector<std::uint8_t> pixels;
};

/// Computes variants one after another and keeps the fields between them. Results do not depend on the
/// variants computed before. For one thread.
class StudyRunner {
 public:
  /// @param terrain  as of loadTerrain() with the study's scenario and area; null: none
  /// @param options  backend and memory; the rest is set here
  /// @param files    writes the kept files of each variant, before take() is called; null: none
  StudyRunner(const StudySpec& study, const StudyPlan& plan, scenario::TerrainPtr terrain,
              emfield::FieldOptions options, VariantFiles* files = nullptr);
  ~StudyRunner();

  /// The pixels of the maps.
  const MapGrid& grid() const;

  /// @param variants  in the plan's order
  /// @param take      called for each, in that order
  /// @throws Error as CoverageSolver::compute(); with the variant's number and name in the message
  void run(const std::vector<std::size_t>& variants, const std::function<void(VariantResult)>& take,
           const ProgressSink& progress = {});

  /// Warnings of the variants that were computed together with the last one, each once, without counts; those
  /// of the scenario's check and of the edits among them.
  const std::set<std::string>& warnings() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace emscape::study
