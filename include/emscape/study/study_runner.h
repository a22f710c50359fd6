/// Computes the variants of a study.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "emscape/base/progress.h"
#include "emscape/study/study_plan.h"
#include "emscape/study/variant_files.h"

namespace emscape::study {

/// What a variant is measured at.
struct VariantResult {
  std::size_t variant = 0;
  std::vector<double> values;  ///< of the study's measures; NaN: none, where no pixel has a value
  /// Of a search for sites: of each pixel, 1 where the measure to maximise has its area class; else empty.
  std::vector<std::uint8_t> pixels;
};

/// Computes variants one after another with fields that stay between them. Results do not depend on which
/// variants were computed before. One thread calls it.
class StudyRunner {
 public:
  /// @param terrain  as of loadTerrain() with the study's scenario and area; null: none
  /// @param options  backend and memory; the rest is set here
  /// @param files    what is kept of each variant, written before it is taken; null: nothing
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

  /// Warnings so far, each once, without how often.
  const std::set<std::string>& warnings() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace emscape::study
