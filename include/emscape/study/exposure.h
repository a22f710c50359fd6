/// Exposure: a platform on its track through the field, by time and emitter.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "emscape/base/progress.h"
#include "emscape/emfield/field_solver.h"
#include "emscape/render/image.h"
#include "emscape/scenario/quantities.h"
#include "emscape/scenario/scenario.h"

namespace emscape::study {

struct ExposureRequest {
  int platform = 0;             ///< index into Scenario::platforms
  std::vector<double> times_s;  ///< rising, one or more
  scenario::Quantity quantity = scenario::Quantity::detection_probability;
  double threshold = 0.5;  ///< in the quantity's unit
  /// target: the beam on the platform as nearly as the scan permits, wherever the scan is. scan: as it points
  /// at the time, which takes steps shorter than the beam's passes.
  scenario::RadarLook look = scenario::RadarLook::target;
  /// Index into Scenario::targets: cross section by aspect, fluctuation and radial speed are those of this
  /// target of the platform; none: those that the radars assume.
  std::optional<int> target;
};

/// Whether the value of all emitters together is at or above the threshold; unknown where the path to the
/// platform from any emitter crosses missing terrain.
enum class ExposureState { reached, below, unknown };
const char* toString(ExposureState state);

struct ExposureRow {
  double time_s = 0, latitude_deg = 0, longitude_deg = 0;
  double height_msl_m = 0;
  double height_agl_m = 0;   ///< NaN: over missing terrain
  double value = 0;          ///< of all emitters together; NaN: unknown
  std::vector<double> each;  ///< by emitter of Exposure::emitters; -infinity: it is off; NaN: unknown
  ExposureState state = ExposureState::unknown;
  int best = -1;  ///< place in `each` of the largest value; -1: there is none
  /// Detection by any radar so far: 1 - prod(1 - Pd) over all looks. Of detection_probability with look
  /// target only; else NaN. A look whose value is unknown does not count.
  double cumulative_probability = 0;
};

/// Figures of one emitter over all times, or of all together.
struct ExposureSummary {
  std::string name;                   ///< of the emitter; "together"
  double max = 0;                     ///< the largest value; NaN: there is none
  double max_time_s = 0;              ///< its time
  std::optional<double> first_s;      ///< time at which the threshold is reached for the first time
  double fraction = 0;                ///< 0..1 of the known time; a time stands for the interval up to the
                                      ///< next. NaN: no time is known
  double unknown_fraction = 0;        ///< 0..1 of all the time: the value is unknown
  double longest_gap_s = 0;           ///< known to be below the threshold; ends where it is unknown
  double best_fraction = 0;           ///< of the times at which it has the largest value; of emitters
  double cumulative_probability = 0;  ///< after the last time; NaN as in the rows
};

struct Exposure {
  ExposureRequest request;
  std::string scenario, platform, unit;
  std::string cross_section;       ///< whose cross section radars see, in words; empty: the quantity has none
  std::vector<int> emitters;       ///< indices into Scenario::emitters; those on the platform are left out
  std::vector<std::string> names;  ///< of these
  std::vector<ExposureRow> rows;   ///< one per time
  std::vector<ExposureSummary> each;  ///< one per emitter
  ExposureSummary together;
  std::vector<std::string> warnings;
};

/// Computes the values on the track by the field's own functions: each is that of `emscape profile` at the
/// platform's position. The platform's own radars and transmitters do not count, nor do its jammers as
/// emitters; they jam the radars.
/// @param terrain  of the region and all platforms; null: a smooth earth
/// @param options  backend and memory; the rest is set here
/// @throws Error (usage) for an index quantity, no times, and a target on another platform; as FieldSolver
Exposure computeExposure(const std::shared_ptr<const scenario::Scenario>& scenario,
                         const scenario::TerrainPtr& terrain, const ExposureRequest& request,
                         emfield::FieldOptions options, const ProgressSink& progress = {});

/// Draws the values over time, and the height over ground, into a .png or .svg.
/// @throws Error (other) naming the file
void plotExposure(const Exposure& exposure, render::ImageSize size, const std::string& file);

}  // namespace emscape::study
