#include "emscape/emfield/link/path_cause.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "emfield/link/path_decision.h"
#include "emfield/link/path_verdict.h"
#include "emscape/base/units.h"
#include "propagation/registry/model_info.h"

namespace emscape::emfield {
namespace {

using scenario::Quantity;

std::optional<double> termOf(const PathBudget& budget, const std::string& key) {
  const BudgetTerm* const term = budget.find(key);
  if (term == nullptr) return std::nullopt;
  return term->value;
}

/// The echo over clutter and noise (dB) as detection counts the clutter.
/// @param filtered_db  over noise alone, after the filter
double inCountedClutterDb(const PathBudget& budget, double filtered_db) {
  const double to_both_db = termOf(budget, "sclnr_db").value_or(filtered_db);
  const double loss_db = termOf(budget, "clutter_correlation_loss_db").value_or(0);
  if (loss_db == 0 || !(to_both_db < filtered_db)) return to_both_db;
  const double noise = dbToRatio(-filtered_db), clutter = dbToRatio(-to_both_db) - noise;
  return -ratioToDb(noise + dbToRatio(loss_db) * clutter);
}

Decision ofLosses(const PathBudget& budget, double ways, double missing_db) {
  const auto losses =
      lossesOf(budget.excess, budget.look_pattern_db.value_or(budget.pointing.pattern_db), ways);
  double all_db = 0;
  for (const LossCause& loss : losses) all_db += loss.gain_db;
  if (!(all_db >= missing_db)) return {PathCause::noise, missing_db, all_db};
  const auto largest =
      std::max_element(losses.begin(), losses.end(),
                       [](const LossCause& a, const LossCause& b) { return a.gain_db < b.gain_db; });
  return {largest->cause, missing_db, largest->gain_db};
}

/// Jamming that would hide the echo even without what decides; empty: none.
std::string jammedToo(const PathBudget& budget, const Decision& decision) {
  const PathJamming& jamming = budget.jamming;
  if (!jamming.without_clutter || jamming.jammers.empty()) return "";
  const PathJamming::WithoutClutterAnd& without = *jamming.without_clutter;
  const double probability = decision.cause == PathCause::terrain    ? without.terrain
                             : decision.cause == PathCause::pointing ? without.pointing
                             : decision.gain_db > 0                  ? without.ground_cover
                                                                     : without.nothing;
  const double filtered_db = termOf(budget, "snr_db").value_or(0) + decision.gain_db +
                             termOf(budget, "filter_response_db").value_or(0);
  if (probability >= kDetected || filtered_db < termOf(budget, "required_snr_db").value_or(0)) return "";
  const PathJammer& jammer = decisiveJammer(jamming);
  // Of a radar that looks where its scan is, the ratio is that of the beam on the target already.
  const bool is_on_target =
      decision.cause == PathCause::pointing && !budget.look_pattern_db && !budget.has_fixed_beam;
  return fmt::format(" Jamming by '{}' decides then: J/S {:.1f} dB.", jammer.name,
                     jammer.to_signal_db - (is_on_target ? 0 : decision.gain_db));
}

/// What is missing (dB) with the noise of the jammers; empty where it adds nothing.
std::string missingWithJamming(const PathBudget& budget, const Decision& decision) {
  const std::optional<double>& missing_db = budget.jamming.missing_db;
  constexpr double kLeast_db = 0.05;  // told with one decimal
  if (!missing_db || *missing_db < decision.missing_db + kLeast_db) return "";
  return fmt::format(" With jamming {:.1f} dB are missing.", *missing_db);
}

/// A limit of range that would hide the echo even without what decides; empty: none.
std::string rangeToo(const PathBudget& budget) {
  return budget.unheard.empty() ? "" : " The radar's range limit decides then.";
}

/// The jammer that decides, and whether the others suffice.
std::string jammingText(const PathJamming& jamming) {
  const PathJammer& jammer = decisiveJammer(jamming);
  const std::size_t others = jamming.jammers.size() - 1;
  const char* const also = " without it as well";
  return fmt::format("Jamming by '{}' decides{}.", jammer.name,
                     others == 0 || jammer.probability_without >= kDetected ? ""
                     : others == 1 ? fmt::format("; the other jammer prevents detection{}", also)
                                   : fmt::format("; the {} other jammers prevent detection{}", others, also));
}

/// What a path's loss beyond that of free space comes from.
std::string nameOfLoss(const PathBudget& budget) {
  const std::vector<PathObstacle>& obstacles = budget.obstacles;
  const bool is_obstructed = obstacles.empty() || std::any_of(obstacles.begin(), obstacles.end(), isNear);
  return is_obstructed && budget.profile.has_terrain &&
                 !propagation::modelInfo(budget.model).on_smooth_surface
             ? "Terrain"
             : fmt::format("The loss by '{}'", toString(budget.model));
}

}  // namespace

std::array<LossCause, 3> lossesOf(const PathExcess& excess, double pattern_db, double ways) {
  double air_db = 0;
  for (const propagation::ExcessPart& part : excess.parts) {
    if (part.key == "gases" || part.key == "gases_in_model" || part.key == "rain") air_db += part.loss_db;
  }
  const double clutter_db = std::max(excess.clutter_db, 0.0);
  return {{{PathCause::clutter, ways * clutter_db},
           {PathCause::terrain, ways * std::max(excess.loss_db - clutter_db - air_db, 0.0)},
           {PathCause::pointing, ways * std::max(-pattern_db, 0.0)}}};
}

const PathJammer& decisiveJammer(const PathJamming& jamming) {
  return *std::max_element(
      jamming.jammers.begin(), jamming.jammers.end(),
      [](const PathJammer& a, const PathJammer& b) { return a.probability_without < b.probability_without; });
}

Decision decide(const PathBudget& budget, Quantity quantity, double threshold) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const std::optional<double> value = termOf(budget, scenario::info(quantity).name);
  if (!budget.active) return {PathCause::silent, kInfinity};
  if (value && *value >= threshold) return {PathCause::covered, -kInfinity};
  const std::optional<double> snr_db = termOf(budget, "snr_db");
  if (!scenario::needsRadar(quantity) || !snr_db)
    return ofLosses(budget, 1, value ? threshold - *value : kInfinity);
  const bool is_detection = quantity == Quantity::detection_probability;
  const double needed_db = is_detection ? termOf(budget, "required_snr_db").value_or(0) : threshold;
  if (is_detection && budget.probability_in_any_range >= threshold) return {PathCause::range};
  const bool is_jammed = !budget.jamming.jammers.empty() && scenario::needsJammer(quantity);
  if (is_jammed && (is_detection ? budget.jamming.unjammed_probability >= threshold : *snr_db >= needed_db))
    return {PathCause::jamming};
  if (is_jammed && is_detection && budget.jamming.unjammed_in_any_range >= threshold)
    return {PathCause::range};
  const double missing_db = needed_db - *snr_db;
  const double filtered_db = *snr_db + termOf(budget, "filter_response_db").value_or(0);
  const double in_clutter_db =
      is_detection ? inCountedClutterDb(budget, filtered_db) : termOf(budget, "sclnr_db").value_or(*snr_db);
  constexpr double kLeast_db = 1e-6;  // clutter far below the noise takes as much by rounding
  if (missing_db <= 0 && in_clutter_db < *snr_db - kLeast_db)
    return {PathCause::clutter, needed_db - in_clutter_db, 0, filtered_db < needed_db};
  return ofLosses(budget, 2, missing_db);
}

PathCause causeOf(const PathBudget& budget, Quantity quantity, double threshold) {
  return decide(budget, quantity, threshold).cause;
}

std::string decisionText(const PathBudget& budget) {
  const bool is_radar = budget.find("detection_probability") != nullptr;
  if (!is_radar && budget.find("intercept_margin_db") == nullptr) return "";
  const Decision decision = is_radar ? decide(budget, Quantity::detection_probability, kDetected)
                                     : decide(budget, Quantity::intercept_margin_db, 0);
  const char* const what = is_radar ? "echo" : "signal";
  switch (decision.cause) {
    case PathCause::covered:
    case PathCause::silent:
      return "";
    case PathCause::range: {
      const bool is_jammed_too =
          budget.probability_in_any_range < kDetected && !budget.jamming.jammers.empty();
      return std::string("The radar's range limit decides.") +
             (is_jammed_too
                  ? fmt::format(" Jamming by '{}' decides then.", decisiveJammer(budget.jamming).name)
                  : "");
    }
    case PathCause::jamming:
      return jammingText(budget.jamming);
    case PathCause::noise:
      return fmt::format(
                 "Noise decides: the {} is {:.1f} dB too weak, {:.1f} dB even in free space on the "
                 "beam's axis.",
                 what, decision.missing_db, decision.missing_db - decision.gain_db) +
             missingWithJamming(budget, decision);
    case PathCause::clutter:
      if (decision.by_filter)
        return "The filter against clutter decides: it removes the echo of a target of this radial speed.";
      if (decision.gain_db == 0)
        return "Clutter decides: echoes of land, sea or rain hide the target." + rangeToo(budget) +
               jammedToo(budget, decision);
      [[fallthrough]];
    default:
      break;
  }
  const std::string name = decision.cause == PathCause::terrain   ? nameOfLoss(budget)
                           : decision.cause == PathCause::clutter ? "Ground cover"
                                                                  : "Pointing";
  if (std::isinf(decision.gain_db)) return fmt::format("{} decides.", name);
  const char* const or_more = isAtFloor(budget) ? "at least " : "";
  return fmt::format("{} decides: without it the {} is {}{:.1f} dB stronger; {}{:.1f} dB are missing.{}{}",
                     name, what, decision.cause == PathCause::terrain ? or_more : "", decision.gain_db,
                     or_more, decision.missing_db, missingWithJamming(budget, decision),
                     is_radar && decision.gain_db >= decision.missing_db
                         ? rangeToo(budget) + jammedToo(budget, decision)
                         : "");
}

}  // namespace emscape::emfield
