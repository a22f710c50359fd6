/// Exposure of a platform to the field along its track, by time and emitter.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "emscape/base/enum_names.h"
#include "emscape/base/progress.h"
#include "emscape/emfield/link/path_cause.h"
#include "emscape/emfield/solver/field_solver.h"
#include "emscape/render/picture/image.h"
#include "emscape/scenario/model/quantities.h"
#include "emscape/scenario/model/scenario.h"

namespace emscape::study {

using emscape::toString;

struct ExposureRequest {
  int platform = 0;             ///< index into Scenario::platforms
  std::vector<double> times_s;  ///< ascending, one or more
  scenario::Quantity quantity = scenario::Quantity::detection_probability;
  double threshold = 0.5;  ///< in the quantity's unit
  /// target: the beam points at the platform as nearly as the scan permits. scan: the beam points as scanned
  /// at that time; this needs time steps shorter than the beam's passes.
  scenario::RadarAim look = scenario::RadarAim::target;
  /// Index into Scenario::targets: the platform's target that gives cross section by aspect, fluctuation and
  /// radial speed; none: those that the radars assume.
  std::optional<int> target;
};

/// Whether the value of all emitters together is at or above the threshold; unknown if the path from some
/// emitters to the platform crosses missing terrain and the others do not reach it; absent before and after
/// the platform's track.
enum class ExposureState { reached, below, unknown, absent };
constexpr auto namesOf(ExposureState) {
  return std::array{"reached", "below", "unknown", "absent"};
}

struct ExposureRow {
  double time_s = 0;
  double latitude_deg = 0, longitude_deg = 0, height_msl_m = 0;  ///< NaN: absent
  double height_agl_m = 0;                                       ///< NaN: over missing terrain, or absent
  double value = 0;          ///< of all emitters together, or of those with a known path if they reach the
                             ///< threshold; NaN: unknown or absent
  std::vector<double> each;  ///< one per Exposure::emitters; -infinity: off; NaN: unknown or absent
  ExposureState state = ExposureState::unknown;
  int best = -1;  ///< index into `each` of the largest value; -1: none
  /// What decides that a value is below the threshold; none for other states, and where it is not computed:
  /// for quantities that the budget of a path lacks, and with emitters of parabolic_equation.
  std::optional<emfield::PathCause> decides;
  /// Probability of detection by any radar so far: 1 - prod(1 - Pd) over all looks with a known value. NaN
  /// unless the quantity is detection_probability and the look is target.
  double cumulative_probability = 0;
};

/// Statistics over all times at which the platform is present, of one emitter or of all together.
struct ExposureSummary {
  std::string name;                   ///< of the emitter; "together"
  double max = 0;                     ///< maximum value; NaN: none
  double max_time_s = 0;              ///< its time
  std::optional<double> first_s;      ///< first time at which the threshold is reached
  double fraction = 0;                ///< 0..1: reached, of the time with known values; each time represents
                                      ///< the interval to the next one. NaN: all unknown
  double unknown_fraction = 0;        ///< 0..1: unknown, of the whole time
  double longest_gap_s = 0;           ///< longest interval below the threshold; unknown values end it
  double best_fraction = 0;           ///< 0..1: the emitter has the largest value; emitters only
  double cumulative_probability = 0;  ///< after the last time; NaN as in the rows
  std::optional<double> cumulative_first_s;  ///< first time at which it reaches the threshold
};

struct Exposure {
  ExposureRequest request;
  std::string scenario, platform, unit;
  std::string title;                  ///< name of the scenario with the number of edits
  std::string cross_section;          ///< source of the cross section, in words; empty: the quantity has none
  std::vector<int> emitters;          ///< indices into Scenario::emitters; without those on the platform
  std::vector<std::string> names;     ///< of these
  std::vector<ExposureRow> rows;      ///< one per time
  std::vector<ExposureSummary> each;  ///< one per emitter
  std::string clutter;                ///< trees and buildings in the losses, in words
  ExposureSummary together;
  std::vector<std::string> warnings;
};

/// The first target that a platform carries; none: it carries none.
std::optional<int> targetOn(const scenario::Scenario& scenario, int platform);

/// Computes the values along the track with the field's functions: each equals that of `emscape profile` at
/// the platform's position. The platform's radars and transmitters are left out; its jammers are left out as
/// emitters, but jam the radars.
/// @param terrain  over the region and all platforms; null: a smooth earth
/// @param options  backend and memory; other members are overwritten
/// @throws Error (usage) for an index quantity, no times, a target on another platform, and a platform that
/// is absent at all times; as FieldSolver
Exposure computeExposure(const std::shared_ptr<const scenario::Scenario>& scenario,
                         const scenario::TerrainPtr& terrain, const ExposureRequest& request,
                         emfield::FieldOptions options, const ProgressSink& progress = {});

/// Plots the values and the height above ground over time, as .png or .svg.
/// @throws Error (other) naming the file
void plotExposure(const Exposure& exposure, render::ImageSize size, const std::string& file);

}  // namespace emscape::study
