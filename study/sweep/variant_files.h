/// Maps or volumes of each variant of a study.
#pragma once

#include <array>
#include <filesystem>
#include <memory>

#include "emscape/base/enum_names.h"
#include "emscape/emfield/solver/field_solver.h"
#include "emscape/study/maps/coverage.h"
#include "study/sweep/definition/study_file.h"

namespace emscape::study {

using emscape::toString;

/// The files that a study keeps of each variant, besides its measures.
enum class KeptFiles { nothing, maps, volumes };
constexpr auto namesOf(KeptFiles) {
  return std::array{"nothing", "maps", "volumes"};
}

/// The folder of a variant, relative to that of the study: "variants/03_no_jammer", its number, padded to the
/// digits of the last number, and its name with '_' in place of all but letters, digits, '.' and '-'. With
/// more than 1000 variants each thousand has a folder: "variants/02000/02417".
std::filesystem::path folderOfVariant(const StudySpec& study, std::size_t variant);

/// Writes the files of variants, atomically. Files of a variant that is computed again are replaced by equal
/// ones; temporaries that an ended process left in its folder are removed. For one thread.
class VariantFiles {
 public:
  /// @param study    must outlive the object
  /// @param options  backend and memory of the solver of volumes
  VariantFiles(const StudySpec& study, std::filesystem::path folder, KeptFiles kept,
               const emfield::FieldOptions& options);
  ~VariantFiles();

  /// Writes PRODUCT_HEIGHT_TIME.tif if maps are kept; if the measures have several quantities or thresholds,
  /// the names begin with these.
  /// @throws Error (other) naming the file
  void addMap(std::size_t variant, const scenario::Scenario& scenario, const MapGrid& grid,
              const CoverageRequest& request, const CoverageMap& map);

  /// Writes field_TIME.vdb for each of the study's times if volumes are kept: the quantities of the measures
  /// in the variant's region. Radars look at the target, as in maps.
  /// @throws Error (bad_input, device, other) as FieldSolver does, or naming the file
  void addVolumes(std::size_t variant, const std::shared_ptr<const scenario::Scenario>& scenario);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace emscape::study
