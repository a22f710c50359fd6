#include "study/report/coverage_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "base/text/quantity_text.h"
#include "emscape/render/annotate/legend.h"
#include "emscape/scenario/model/snapshot.h"

namespace emscape::study {
namespace {

/// Smallest and largest of the values of several times.
struct Spread {
  double min = INFINITY, max = -INFINITY;

  void add(double value) {
    min = std::min(min, value);
    max = std::max(max, value);
  }
  bool isAny() const { return min <= max; }
};

std::string spreadText(const Spread& spread, int decimals) {
  const std::string min = fmt::format("{:.{}f}", spread.min, decimals),
                    max = fmt::format("{:.{}f}", spread.max, decimals);
  return min == max ? min : min + " to " + max;
}

/// Share and area: "62.0 % of the area (521 km²)".
struct Covered {
  Spread percent, km2;

  void add(double area_m2, double of_m2) {
    percent.add(of_m2 > 0 ? 100 * area_m2 / of_m2 : 0);
    km2.add(area_m2 / 1e6);
  }
  std::string text(const char* of) const {
    return fmt::format("{} %{} ({} km²)", spreadText(percent, 1), of, spreadText(km2, km2.max < 10 ? 2 : 0));
  }
};

/// The emitters of a kind that are active at one of the study's times.
std::vector<const scenario::Emitter*> activeEmitters(const MapStudy& study, scenario::EmitterKind kind) {
  const auto& scenario = study.scenarios.front();
  std::set<std::size_t> active;
  for (const double time_s : study.times_s) {
    const scenario::Snapshot snapshot = scenario::snapshotAt(scenario, study.terrain.get(), time_s);
    for (std::size_t e = 0; e < snapshot.emitters.size(); ++e) {
      if (snapshot.emitters[e].active && scenario->emitters[e].kind == kind) active.insert(e);
    }
  }
  std::vector<const scenario::Emitter*> emitters;
  for (const std::size_t e : active) emitters.push_back(&scenario->emitters[e]);
  return emitters;
}

std::vector<std::string> namesOf(const std::vector<const scenario::Emitter*>& emitters) {
  std::vector<std::string> names;
  for (const scenario::Emitter* emitter : emitters) names.push_back(emitter->name);
  return names;
}

/// "a target of 5 m²"; the radars may be defined for different targets.
std::string targetText(const std::vector<const scenario::Emitter*>& radars) {
  Spread rcs_m2;
  for (const scenario::Emitter* radar : radars) rcs_m2.add(radar->receiver.target_rcs_m2);
  if (!rcs_m2.isAny()) return "a target";
  return rcs_m2.min == rcs_m2.max ? fmt::format("a target of {:g} m²", rcs_m2.min)
                                  : fmt::format("their targets of {:g} to {:g} m²", rcs_m2.min, rcs_m2.max);
}

/// What a covered pixel means: "'search radar' detects a target of 5 m² with a probability of at least 0.5".
std::string meaningOf(const MapStudy& study) {
  if (study.quantity == scenario::Quantity::detection_probability) {
    const auto radars = activeEmitters(study, scenario::EmitterKind::radar);
    const std::string who =
        radars.empty() ? "no radar" : namesText(namesOf(radars), "or", "one of the {} radars");
    return fmt::format("{} detects {} with a probability of at least {:g}", who, targetText(radars),
                       study.threshold);
  }
  return fmt::format("{} is at least {}", titleOf(study.quantity),
                     render::displayText(quantityText(study.threshold, scenario::info(study.quantity).unit)));
}

std::string timesText(const MapStudy& study) {
  const std::vector<double>& times_s = study.times_s;
  return times_s.size() == 1
             ? fmt::format("t = {:g} s", times_s.front())
             : fmt::format("{} times from {:g} to {:g} s", times_s.size(), times_s.front(), times_s.back());
}

/// Records of a product at a height and a time each.
template <class Visit>
void forRecords(const std::vector<MapRecord>& records, const char* product, const std::string& height,
                const Visit& visit) {
  for (const MapRecord& record : records) {
    const bool is_it = record.map.name == product && record.map.time_s && record.map.height &&
                       nameOf(*record.map.height) == height;
    if (is_it) visit(record.summary);
  }
}

}  // namespace

std::string namesText(const std::vector<std::string>& names, const std::string& conjunction,
                      const std::string& many) {
  constexpr std::size_t kMaxNames = 3;
  if (names.size() > kMaxNames) return fmt::format(fmt::runtime(many), names.size());
  std::string text;
  for (std::size_t n = 0; n < names.size(); ++n) {
    const std::string before = n == 0 ? "" : n + 1 == names.size() ? " " + conjunction + " " : ", ";
    text += before + "'" + names[n] + "'";
  }
  return text;
}

std::vector<std::string> coverageSummary(const MapStudy& study, const std::vector<MapRecord>& records) {
  std::vector<std::string> sentences;
  const double area_m2 =
      std::accumulate(study.grid->areas_m2.begin(), study.grid->areas_m2.end(), 0.0,
                      [](double sum, float pixel_m2) { return sum + static_cast<double>(pixel_m2); });
  const std::string meaning = meaningOf(study);
  const std::vector<std::string> jammers = namesOf(activeEmitters(study, scenario::EmitterKind::jammer));
  Spread known;
  for (const MapHeight& height : study.heights) {
    Covered covered, jammed;
    const std::string name = nameOf(height);
    forRecords(records, "covered", name, [&](const MapSummary& summary) {
      covered.add(summary.class_area_m2, summary.known_area_m2);
      known.add(summary.known_area_m2);
    });
    const bool has_covered = covered.percent.isAny();
    forRecords(records, "burn_through", name, [&](const MapSummary& summary) {
      if (!has_covered) covered.add(summary.class_area_m2, summary.known_area_m2);
      jammed.add(summary.label_areas_m2[1], summary.known_area_m2);
      known.add(summary.known_area_m2);
    });
    if (!jammed.percent.isAny()) {
      forRecords(records, "jam_loss", name, [&](const MapSummary& summary) {
        jammed.add(summary.class_area_m2, summary.known_area_m2);
        known.add(summary.known_area_m2);
      });
    }
    const std::string where = fmt::format("At {}, {}: ", describe(height), timesText(study));
    std::string sentence;
    if (covered.percent.isAny())
      sentence = fmt::format("{}{} on {}.", where, meaning, covered.text(" of the area"));
    if (jammed.percent.isAny()) {
      const std::string who =
          jammers.empty() ? "Jamming" : "Jamming by " + namesText(jammers, "and", "{} jammers");
      const std::string what =
          jammed.km2.max > 0 ? fmt::format(" takes it away from {}{}.", sentence.empty() ? "" : "another ",
                                           jammed.text(sentence.empty() ? " of the area" : ""))
                             : std::string(" takes nothing away.");
      sentence += sentence.empty() ? where + meaning + ". " + who + what : " " + who + what;
    }
    if (!sentence.empty()) sentences.push_back(sentence);
  }
  Covered reached;
  Spread least_m;
  for (const MapRecord& record : records) {
    if (record.map.name != "min_height") continue;
    reached.add(record.summary.class_area_m2, record.summary.known_area_m2);
    known.add(record.summary.known_area_m2);
    if (std::isfinite(record.summary.min)) least_m.add(record.summary.min);
    if (std::isfinite(record.summary.max)) least_m.add(record.summary.max);
  }
  if (least_m.isAny()) {
    sentences.push_back(
        fmt::format("On {} {} from some height on, up to 10 km above ground: that height is {} m.",
                    reached.text(" of the area"),
                    study.quantity == scenario::Quantity::detection_probability ? "a target is detected"
                                                                                : "the threshold is reached",
                    spreadText(least_m, 0)));
    if (sentences.size() == 1)
      sentences.insert(sentences.begin(), "Maps of the heights from which on " + meaning + ".");
  }
  constexpr double kWorthSaying = 5e-4;
  if (known.isAny() && area_m2 > 0 && known.min < (1 - kWorthSaying) * area_m2) {
    sentences.push_back(
        fmt::format("Shares are of the pixels with a known answer, {} of {:.1f} km², {} % of the area: the "
                    "others are below the "
                    "ground, or elevation data are missing there or on a path that decides.",
                    spreadText({known.min / 1e6, known.max / 1e6}, 1), area_m2 / 1e6,
                    spreadText({100 * known.min / area_m2, 100 * known.max / area_m2}, 1)));
  } else if (known.isAny()) {
    sentences.push_back(
        fmt::format("The area is {:.0f} km²; the answer is known in all its pixels.", area_m2 / 1e6));
  }
  for (std::string& sentence : sentences) {
    if (sentence.front() >= 'a' && sentence.front() <= 'z')
      sentence.front() = static_cast<char>(sentence.front() - 'a' + 'A');
  }
  return sentences;
}

}  // namespace emscape::study
