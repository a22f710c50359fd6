#include "emfield/link/path_verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "emfield/link/path_report.h"
#include "emscape/base/units.h"
#include "emscape/emfield/link/path_cause.h"

namespace emscape::emfield {
namespace {

constexpr double kFree_radii = 0.6;  ///< clearance of a free path

/// Whether an obstacle decides and is above the ray or close below it.
bool isNear(const PathObstacle& obstacle) {
  return obstacle.decides && obstacle.clearanceInFresnelRadii() < kFree_radii;
}

std::string distanceText(double distance_m) {
  return distance_m < 1000 ? fmt::format("{:.0f} m", distance_m)
                           : fmt::format("{:.1f} km", distance_m / 1000);
}

std::string thingAt(const PathObstacle& obstacle) {
  constexpr double kSea_m = 0.5;
  const std::string distance = distanceText(obstacle.range_m);
  if (obstacle.is_cover) return fmt::format("{} at {}", coverText(obstacle), distance);
  const char* const thing = obstacle.is_earth_bulge                     ? "the earth's bulge"
                            : std::abs(obstacle.ground_msl_m) <= kSea_m ? "the surface"
                                                                        : "the terrain";
  if (obstacle.cover_m > 0) return fmt::format("{} at {} with {}", thing, distance, coverText(obstacle));
  return fmt::format("{} at {}", thing, distance);
}

/// Whether a model has no obstacles: what is above the ray costs nothing, or only as a smooth earth.
bool ignoresObstacles(propagation::PropagationModel model) {
  return model == propagation::PropagationModel::free_space;
}

/// The path's loss, as a phrase after "and".
std::string costText(double loss_db) {
  if (std::isinf(loss_db)) return "the model gives no field behind it";
  if (std::abs(loss_db) < 0.05) return "the path is as good as free space";
  if (loss_db < 0) return fmt::format("the path gains {:.1f} dB over free space", -loss_db);
  return fmt::format("the path costs {:.1f} dB over free space", loss_db);
}

std::string pathText(const PathBudget& budget) {
  const BudgetTerm* const reflected = budget.find("reflected_ray_db");
  const double loss_db = budget.excess.loss_db - (reflected != nullptr ? reflected->value : 0);
  const auto decisive = std::find_if(budget.obstacles.begin(), budget.obstacles.end(),
                                     [](const PathObstacle& obstacle) { return obstacle.decides; });
  if (decisive == budget.obstacles.end()) return fmt::format("Clear: no obstacle, and {}", costText(loss_db));
  const double radii = decisive->clearanceInFresnelRadii();
  const long others = std::count_if(budget.obstacles.begin(), budget.obstacles.end(),
                                    [](const PathObstacle& obstacle) { return obstacle.clearance_m < 0; }) -
                      1;
  const std::string company = others > 0 ? fmt::format(", {} more above it", others) : "";
  if (radii < 0) {
    return fmt::format("{}: {} is {:.0f} m above the ray ({:.1f} Fresnel radii){}, {} {}",
                       ignoresObstacles(budget.model) ? "Not in sight, which 'free_space' ignores"
                       : loss_db < 0                  ? "Beyond the line of sight"
                                                      : "Blocked",
                       thingAt(*decisive), -decisive->clearance_m, -radii, company,
                       loss_db < 0 || ignoresObstacles(budget.model) ? "yet" : "and", costText(loss_db));
  }
  if (radii < kFree_radii) {
    return fmt::format(
        "Grazing: {} leaves the ray {:.0f} m ({:.1f} Fresnel radii; 0.6 would be free), and {}",
        thingAt(*decisive), decisive->clearance_m, radii, costText(loss_db));
  }
  const std::string nearest = decisive->cover_m > 0 ? coverText(*decisive) : "the nearest ground";
  return fmt::format("Clear: {}, {} away, is {:.0f} m below the ray ({:.1f} Fresnel radii), and {}", nearest,
                     distanceText(decisive->range_m), decisive->clearance_m, radii, costText(loss_db));
}

/// Text for a direction in which the antenna's gain is far below its maximum. For a radar that looks at the
/// target the direction of the scan is ignored. A second reason after an obstacle, an exception after a clear
/// path.
std::string pointingText(const PathBudget& budget) {
  const PathPointing& pointing = budget.pointing;
  const double pattern_db = budget.look_pattern_db.value_or(pointing.pattern_db);
  if (pattern_db > kBeamMisses_db) return "";
  // A loss is one more reason after a loss of the path; after a clear path it is the opposite.
  const bool is_clear = std::none_of(budget.obstacles.begin(), budget.obstacles.end(), isNear);
  const char* const join = is_clear ? "but" : "and";
  if (budget.look_pattern_db) {
    return fmt::format(", {} the scan does not reach there, which costs {:.1f} dB", join, -pattern_db);
  }
  return fmt::format(", {} the antenna points {:.1f} deg away, which costs {:.1f} dB", join,
                     radToDeg(pointing.off_axis_rad), -pattern_db);
}

/// What trees and buildings cost, if that is worth saying.
std::string clutterCostText(const PathBudget& budget) {
  constexpr double kWorthSaying_db = 1;
  if (budget.excess.clutter_db < kWorthSaying_db || std::isinf(budget.excess.loss_db)) return "";
  return fmt::format(", {:.1f} dB of it by trees and buildings", budget.excess.clutter_db);
}

/// The jammers: "'helicopter' and 2 more".
std::string jammersText(const PathJamming& jamming) {
  return "'" + jamming.strongest + "'" +
         (jamming.others > 0 ? fmt::format(" and {} more", jamming.others) : "");
}

/// The cause that comes before the path: jamming that takes the detection away.
std::string jammedText(const PathBudget& budget) {
  const BudgetTerm* probability = budget.find("detection_probability");
  if (probability == nullptr || budget.jamming.strongest.empty()) return "";
  if (probability->value >= kDetected || budget.jamming.unjammed_probability < kDetected) return "";
  return fmt::format(
      "Jammed by {}: J/S {:.1f} dB, without which a target there is detected with probability {:.2f}; ",
      jammersText(budget.jamming), budget.find("jammer_to_signal_db")->value,
      budget.jamming.unjammed_probability);
}

/// The probability of detection, with its causes: jamming and clutter near or above the level of the echo.
std::string detectionText(const PathBudget& budget) {
  constexpr double kWorthSaying_db = -20;  // jamming over the echo, from which it is mentioned
  const BudgetTerm* probability = budget.find("detection_probability");
  if (probability == nullptr) return "";
  const double snr_db = budget.find("snr_db")->value;
  if (!budget.unheard.empty())
    return fmt::format("; a target there is not detected (SNR {:.1f} dB): it is {}", snr_db, budget.unheard);
  if (!std::isfinite(snr_db)) return "; a target there gives no echo";
  std::string ratios = fmt::format("SNR {:.1f} dB", snr_db);
  const BudgetTerm* with_clutter = budget.find("sclnr_db");
  if (with_clutter != nullptr && std::isinf(with_clutter->value))
    ratios += ", none after the filter";
  else if (with_clutter != nullptr && with_clutter->value < snr_db - 0.5)
    ratios += fmt::format(", with clutter {:.1f} dB", with_clutter->value);
  const BudgetTerm* jamming = budget.find("jammer_to_signal_db");
  // Of a radar that looks where its scan is, the one is not in the beam of the other.
  const bool has_two_beams = !budget.look_pattern_db && budget.pointing.pattern_db <= kBeamMisses_db;
  if (jamming != nullptr && jamming->value > kWorthSaying_db)
    ratios += fmt::format("{}, J/S {:.1f} dB by {}{}", has_two_beams ? " where the scan has the beam" : "",
                          jamming->value, jammersText(budget.jamming),
                          has_two_beams ? " with the beam on the target" : "");
  return fmt::format("; a target there is detected with probability {:.2f} ({})", probability->value, ratios);
}

}  // namespace

std::string pathVerdictOf(const PathBudget& budget) {
  if (!budget.active)
    return fmt::format("Silent: '{}' does not radiate at t = {:g} s.", budget.emitter, budget.time_s);
  return pathText(budget) + ".";
}

std::string verdictOf(const PathBudget& budget) {
  if (!budget.active) return pathVerdictOf(budget);
  std::string path = pathText(budget);
  const std::string jammed = jammedText(budget);
  if (!jammed.empty()) path[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(path[0])));
  const std::string decision = decisionText(budget);
  return jammed + path + clutterCostText(budget) + pointingText(budget) + detectionText(budget) + "." +
         (decision.empty() ? "" : " " + decision);
}

}  // namespace emscape::emfield
