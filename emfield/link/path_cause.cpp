#include "emscape/emfield/link/path_cause.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "emfield/link/path_decision.h"
#include "emfield/link/path_verdict.h"
#include "emscape/base/units.h"

namespace emscape::emfield {
namespace {

using scenario::Quantity;

std::optional<double> termOf(const PathBudget& budget, const std::string& key) {
  const BudgetTerm* const term = budget.find(key);
  if (term == nullptr) return std::nullopt;
  return term->value;
}

/// What a signal would gain (dB) without one of the losses of its path.
struct LossCause {
  PathCause cause;
  double gain_db;
};

std::array<LossCause, 3> lossesOf(const PathBudget& budget, double ways) {
  double air_db = 0;
  for (const propagation::ExcessPart& part : budget.excess.parts) {
    if (part.key == "gases" || part.key == "gases_in_model" || part.key == "rain") air_db += part.loss_db;
  }
  const double clutter_db = std::max(budget.excess.clutter_db, 0.0);
  const double pattern_db = budget.look_pattern_db.value_or(budget.pointing.pattern_db);
  return {{{PathCause::clutter, ways * clutter_db},
           {PathCause::terrain, ways * std::max(budget.excess.loss_db - clutter_db - air_db, 0.0)},
           {PathCause::pointing, ways * std::max(-pattern_db, 0.0)}}};
}

/// The echo over clutter, noise and jamming (dB), from that over clutter and noise.
double underJammingDb(const PathBudget& budget, double in_clutter_db) {
  const std::optional<double> jamming_to_echo_db = termOf(budget, "jammer_to_signal_db");
  if (!jamming_to_echo_db) return in_clutter_db;
  const double response_db = termOf(budget, "filter_response_db").value_or(0);
  return -ratioToDb(dbToRatio(-in_clutter_db) + dbToRatio(*jamming_to_echo_db - response_db));
}

Decision ofLosses(const PathBudget& budget, double ways, double missing_db) {
  const auto losses = lossesOf(budget, ways);
  double all_db = 0;
  for (const LossCause& loss : losses) all_db += loss.gain_db;
  if (!(all_db >= missing_db)) return {PathCause::noise, missing_db, all_db};
  const auto largest =
      std::max_element(losses.begin(), losses.end(),
                       [](const LossCause& a, const LossCause& b) { return a.gain_db < b.gain_db; });
  return {largest->cause, missing_db, largest->gain_db};
}

/// Jamming that would hide the echo even without the loss that decides; empty: none.
std::string jammedToo(const PathBudget& budget, const Decision& decision) {
  const std::optional<double> to_echo_db = termOf(budget, "jammer_to_signal_db"),
                              snr_db = termOf(budget, "snr_db"),
                              needed_db = termOf(budget, "required_snr_db");
  if (!to_echo_db || !snr_db || !needed_db || budget.jamming.strongest.empty()) return "";
  // Of a radar that looks where its scan is, the ratio is that of the beam on the target already.
  const bool is_on_target = decision.cause == PathCause::pointing && !budget.look_pattern_db;
  const double without_db = *to_echo_db - (is_on_target ? 0 : decision.gain_db);
  const double response_db = termOf(budget, "filter_response_db").value_or(0);
  const double echo_db =
      -ratioToDb(dbToRatio(-(*snr_db + decision.gain_db)) + dbToRatio(without_db - response_db));
  if (echo_db >= *needed_db) return "";
  return fmt::format(" Jamming by '{}' decides then: J/S {:.1f} dB.", budget.jamming.strongest, without_db);
}

}  // namespace

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
  const double in_clutter_db = termOf(budget, "sclnr_db").value_or(*snr_db);
  if (is_detection && !budget.unheard.empty() && underJammingDb(budget, in_clutter_db) >= needed_db)
    return {PathCause::range};
  const bool is_jammed = !budget.jamming.strongest.empty() && scenario::needsJammer(quantity);
  if (is_jammed && (is_detection ? budget.jamming.unjammed_probability >= threshold : *snr_db >= needed_db))
    return {PathCause::jamming};
  const double missing_db = needed_db - *snr_db;
  if (missing_db <= 0 && in_clutter_db < *snr_db) {
    const double filtered_db = *snr_db + termOf(budget, "filter_response_db").value_or(0);
    return {PathCause::clutter, needed_db - in_clutter_db, 0, filtered_db < needed_db};
  }
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
    case PathCause::range:
      return "The radar's range limit decides.";
    case PathCause::jamming:
      return fmt::format("Jamming by '{}' decides.", budget.jamming.strongest);
    case PathCause::noise:
      return fmt::format(
          "Noise decides: the {} is {:.1f} dB too weak, {:.1f} dB even in free space on the "
          "beam's axis.",
          what, decision.missing_db, decision.missing_db - decision.gain_db);
    case PathCause::clutter:
      if (decision.by_filter)
        return "The filter against clutter decides: it removes the echo of a target of this radial speed.";
      if (decision.gain_db == 0) return "Clutter decides: echoes of land, sea or rain hide the target.";
      [[fallthrough]];
    default:
      break;
  }
  const char* const name = decision.cause == PathCause::terrain   ? "Terrain"
                           : decision.cause == PathCause::clutter ? "Ground cover"
                                                                  : "Pointing";
  if (std::isinf(decision.gain_db)) return fmt::format("{} decides.", name);
  return fmt::format("{} decides: without it the {} is {:.1f} dB stronger; {:.1f} dB are missing.{}", name,
                     what, decision.gain_db, decision.missing_db,
                     is_radar && decision.gain_db >= decision.missing_db ? jammedToo(budget, decision) : "");
}

}  // namespace emscape::emfield
