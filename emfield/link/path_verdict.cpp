#include "emfield/link/path_verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "emfield/link/path_decision.h"
#include "emfield/link/path_report.h"
#include "emscape/base/units.h"
#include "emscape/emfield/link/path_cause.h"
#include "propagation/registry/model_info.h"

namespace emscape::emfield {
namespace {

std::string distanceText(double distance_m) {
  return distance_m < 1000 ? fmt::format("{:.0f} m", distance_m)
                           : fmt::format("{:.1f} km", distance_m / 1000);
}

std::string thingAt(const PathObstacle& obstacle, const PathProfile& profile) {
  constexpr double kSea_m = 0.5;
  const std::string distance = distanceText(obstacle.range_m);
  if (obstacle.is_cover) return fmt::format("{} at {}", coverText(obstacle), distance);
  const bool is_terrain_above = obstacle.clearance_m + profile.bulge_m(obstacle.post) < 0;
  const char* const thing = obstacle.is_earth_bulge && is_terrain_above
                                ? "the earth's bulge with the terrain on it"
                            : obstacle.is_earth_bulge                   ? "the earth's bulge"
                            : std::abs(obstacle.ground_msl_m) <= kSea_m ? "the surface"
                                                                        : "the terrain";
  if (obstacle.cover_m > 0) return fmt::format("{} at {} with {}", thing, distance, coverText(obstacle));
  return fmt::format("{} at {}", thing, distance);
}

/// Whether an obstacle costs nothing by the model: any in free space, terrain on a smooth surface.
bool isIgnored(const PathObstacle& obstacle, propagation::PropagationModel model) {
  return model == propagation::PropagationModel::free_space ||
         (propagation::modelInfo(model).on_smooth_surface && !obstacle.is_earth_bulge);
}

/// The path's loss, as a phrase after "and".
std::string costText(const PathBudget& budget, double loss_db) {
  const bool is_smooth = propagation::modelInfo(budget.model).on_smooth_surface && budget.profile.has_terrain;
  const char* const where = is_smooth ? ", above a smooth surface without terrain," : "";
  if (std::isinf(loss_db)) return "the model gives no field behind it";
  if (std::abs(loss_db) < 0.05) return fmt::format("the path{} is as good as free space", where);
  if (loss_db < 0) return fmt::format("the path{} gains {:.1f} dB over free space", where, -loss_db);
  if (isAtFloor(budget))
    return fmt::format("the path costs at least {:.1f} dB over free space (the floor of the march)", loss_db);
  return fmt::format("the path{} costs {:.1f} dB over free space", where, loss_db);
}

std::string pathText(const PathBudget& budget) {
  const BudgetTerm* const reflected = budget.find("reflected_ray_db");
  const double loss_db = budget.excess.loss_db - (reflected != nullptr ? reflected->value : 0);
  const auto decisive = std::find_if(budget.obstacles.begin(), budget.obstacles.end(),
                                     [](const PathObstacle& obstacle) { return obstacle.decides; });
  if (decisive == budget.obstacles.end())
    return fmt::format("Clear: no obstacle, and {}", costText(budget, loss_db));
  const double radii = decisive->clearanceInFresnelRadii();
  const long others = std::count_if(budget.obstacles.begin(), budget.obstacles.end(),
                                    [](const PathObstacle& obstacle) { return obstacle.clearance_m < 0; }) -
                      1;
  const std::string company = others > 0 ? fmt::format(", {} more above it", others) : "";
  if (radii < 0) {
    const bool is_ignored = isIgnored(*decisive, budget.model);
    return fmt::format("{}: {} is {:.0f} m above the ray ({:.1f} Fresnel radii){}, {} {}",
                       is_ignored    ? fmt::format("Not in sight, which '{}' ignores", toString(budget.model))
                       : loss_db < 0 ? "Beyond the line of sight"
                                     : "Blocked",
                       thingAt(*decisive, budget.profile), -decisive->clearance_m, -radii, company,
                       loss_db < 0 || (is_ignored && loss_db < 0.05) ? "yet" : "and",
                       costText(budget, loss_db));
  }
  if (radii < kFree_radii) {
    return fmt::format(
        "Grazing: {} leaves the ray {:.0f} m ({:.1f} Fresnel radii; 0.6 would be free), and {}",
        thingAt(*decisive, budget.profile), decisive->clearance_m, radii, costText(budget, loss_db));
  }
  const std::string nearest = decisive->cover_m > 0 ? coverText(*decisive) : "the nearest ground";
  return fmt::format("Clear: {}, {} away, is {:.0f} m below the ray ({:.1f} Fresnel radii), and {}", nearest,
                     distanceText(decisive->range_m), decisive->clearance_m, radii,
                     costText(budget, loss_db));
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
  const std::size_t others = jamming.jammers.size() - 1;
  return "'" + decisiveJammer(jamming).name + "'" + (others > 0 ? fmt::format(" and {} more", others) : "");
}

/// What a side-lobe blanker shuts out: ", blanked 98 % of the pulses of 'a'".
std::string blankedText(const PathJamming& jamming) {
  constexpr double kWorthSaying = 0.01;
  std::string text;
  for (const PathJammer& jammer : jamming.jammers) {
    if (jammer.blanked_part < kWorthSaying) continue;
    text += fmt::format("{} {:.0f} % of the pulses of '{}'", text.empty() ? ", blanked" : ",",
                        100 * jammer.blanked_part, jammer.name);
  }
  return text;
}

/// The cause that comes before the path: jamming that takes the detection away.
std::string jammedText(const PathBudget& budget) {
  const BudgetTerm* probability = budget.find("detection_probability");
  if (probability == nullptr || budget.jamming.jammers.empty()) return "";
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
  const bool has_two_beams =
      !budget.look_pattern_db && !budget.has_fixed_beam && budget.pointing.pattern_db <= kBeamMisses_db;
  if (jamming != nullptr && jamming->value > kWorthSaying_db)
    ratios += fmt::format("{}, J/S {:.1f} dB by {}{}", has_two_beams ? " where the scan has the beam" : "",
                          jamming->value, jammersText(budget.jamming),
                          has_two_beams ? " with the beam on the target" : "") +
              blankedText(budget.jamming);
  return fmt::format("; a target there is detected with probability {:.2f} ({})", probability->value, ratios);
}

}  // namespace

bool isAtFloor(const PathBudget& budget) {
  const std::vector<propagation::ExcessPart>& parts = budget.excess.parts;
  return std::any_of(parts.begin(), parts.end(),
                     [](const propagation::ExcessPart& part) { return part.key == "floor"; });
}

bool isNear(const PathObstacle& obstacle) {
  return obstacle.decides && obstacle.clearanceInFresnelRadii() < kFree_radii;
}

std::string pathVerdictOf(const PathBudget& budget) {
  if (!budget.active)
    return fmt::format("Silent: '{}' does not radiate at t = {:g} s.", budget.emitter, budget.time_s);
  return pathText(budget) + clutterCostText(budget) + ".";
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
