#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "base/math/random.h"
#include "document/edit_path.h"
#include "document/schema_check.h"
#include "document/text_edit.h"
#include "emscape/base/log.h"
#include "emscape/scenario/file/scenario_file.h"
#include "scenario/file/far_outside.h"
#include "scenario/file/schema.h"
#include "scenario/file/source.h"
#include "study/sweep/definition/candidate_sites.h"
#include "study/sweep/definition/sample_points.h"
#include "study/sweep/definition/study_format.h"
#include "study/sweep/definition/study_reading.h"

namespace emscape::study {
namespace {

using document::DocumentNode;
using document::Section;
using Factor = VariantFactor;

/// Number of values of a parameter up to which each is checked in the scenario.
constexpr std::size_t kMaxTried = 200;

/// Twelve digits, so that the end of a decimal range is not "20.000000000000004".
std::string numberText(double value) {
  return fmt::format("{}", std::stod(fmt::format("{:.12g}", value)));
}

/// The values that edits set, by their place in the scenario: a path can be spelled in several ways.
class SetPaths {
 public:
  explicit SetPaths(const scenario::Scenario& base) : base_(base) {}

  void add(const std::string& path) { paths_.emplace(stepsOf(path), path); }
  /// An added path to the same value, to a part of it, or to a value that contains it; empty: none.
  std::string conflictOf(const std::string& path) const {
    document::NodePath steps = stepsOf(path);
    const auto part = paths_.lower_bound(steps);
    if (part != paths_.end() && part->first.size() >= steps.size() &&
        std::equal(steps.begin(), steps.end(), part->first.begin())) {
      return part->second;
    }
    for (; !steps.empty(); steps.pop_back()) {
      const auto whole = paths_.find(steps);
      if (whole != paths_.end()) return whole->second;
    }
    return "";
  }

 private:
  /// A path that leads nowhere is one step; it is a fault already.
  document::NodePath stepsOf(const std::string& path) const {
    try {
      return document::resolvePath(path, base_.source->root, scenario::scenarioSpec()).steps;
    } catch (const Error&) {
      return {path};
    }
  }

  const scenario::Scenario& base_;
  std::map<document::NodePath, std::string> paths_;
};

/// @param by  what is added if both paths are the same
std::string sameValueFault(const std::string& path, const std::string& other, const char* by) {
  return path == other
             ? fmt::format("'{}' is set twice{}", path, by)
             : fmt::format("'{}' and '{}' set the same value, or one a part of the other", other, path);
}

class VariantReader {
 public:
  explicit VariantReader(StudyReading& reading) : reading_(reading) {}

  void read(const Section& root) {
    std::vector<Factor> factors;
    if (root.has("variants")) factors.push_back(readList(root));
    if (root.has("sweep")) readSweep(root, factors);
    if (root.has("samples")) factors.push_back(readSamples(root.section("samples")));
    if (root.has("sites")) {
      if (!factors.empty())
        reading_.fault(root.locationOf("sites"), "'sites' goes without variants, sweep and samples");
      factors.push_back(readSites(root.section("sites")));
    }
    if (factors.empty()) {
      reading_.fault(root.location(), "the study has none of 'variants', 'sweep', 'samples' and 'sites'");
    }
    if (reading_.tries_values) requireSeparate(root, factors);
    document::requireNoProblem(reading_.problems);
    reading_.spec.variants = VariantSet(std::move(factors));
  }

 private:
  /// No value is set by two factors.
  void requireSeparate(const Section& root, const std::vector<Factor>& factors) {
    SetPaths paths(*reading_.spec.base);
    for (const Factor& factor : factors) {
      const bool is_list = factor.kind == Factor::Kind::list;  // its variants are alternatives
      for (const std::string& path : factor.paths) {
        const std::string other = paths.conflictOf(path);
        if (!other.empty()) {
          reading_.fault(locationOf(root, factor),
                         sameValueFault(path, other, " by two of variants, sweep, samples and sites"));
        }
        if (!is_list) paths.add(path);
      }
      for (const std::string& path : factor.paths) {
        if (is_list) paths.add(path);
      }
    }
  }

  /// No value is set by two edits of a variant.
  void requireSeparate(const std::vector<scenario::Edit>& edits, const std::string& variant,
                       const SourceLocation& location) {
    SetPaths paths(*reading_.spec.base);
    for (const scenario::Edit& edit : edits) {
      const std::string other = paths.conflictOf(edit.path);
      if (!other.empty())
        reading_.fault(location,
                       fmt::format("variant '{}': {}", variant, sameValueFault(edit.path, other, "")));
      paths.add(edit.path);
    }
  }

  static SourceLocation locationOf(const Section& root, const Factor& factor) {
    static constexpr const char* kKeys[] = {"variants", "sweep", "samples", "sites"};
    return root.locationOf(kKeys[static_cast<int>(factor.kind)]);
  }

  /// Checks edits in the scenario.
  void tryEdits(const std::vector<scenario::Edit>& edits, const SourceLocation& location) {
    if (!reading_.tries_values) return;
    for (const scenario::Problem& problem : scenario::editScenario(*reading_.spec.base, edits).problems) {
      if (problem.severity == scenario::Severity::error) {
        reading_.fault(location, toString(problem.location) + ": " + problem.message);
        return;
      }
    }
  }

  /// Checks the values of one column of a factor, each separately.
  void tryColumn(const Factor& factor, std::size_t column, const SourceLocation& location) {
    std::set<std::size_t> chosen;
    if (factor.count <= kMaxTried) {
      for (std::size_t i = 0; i < factor.count; ++i) chosen.insert(i);
    } else {
      std::size_t lowest = 0, highest = 0;
      const auto number = [&](std::size_t i) {
        return document::numberOf(factor.value(i, column)).value_or(NAN);
      };
      for (std::size_t i = 0; i < factor.count; ++i) {
        if (number(i) < number(lowest)) lowest = i;
        if (number(i) > number(highest)) highest = i;
      }
      chosen = {0, factor.count - 1, lowest, highest};
    }
    for (const std::size_t i : chosen) {
      tryEdits({{factor.paths[column], factor.value(i, column)}}, location);
      if (reading_.problems.hasErrors()) return;
    }
  }

  Factor readList(const Section& root) {
    Factor factor;
    const std::vector<Section> items = root.sections("variants");
    const DocumentNode* const originals = childOf(reading_.original.get(), "variants");
    std::vector<std::vector<scenario::Edit>> edits(items.size());
    for (std::size_t i = 0; i < items.size(); ++i) {
      factor.names.push_back(reading_.nameOf(items[i]));
      const DocumentNode* const set = childOf(originals->items[i].get(), "set");
      if (set == nullptr) continue;
      for (const document::MapEntry& entry : set->entries) {
        const std::string text =
            entry.value->kind == document::NodeKind::null ? "null" : document::flowText(*entry.value, false);
        edits[i].push_back({entry.key, text});
        tryEdits(edits[i], reading_.at(entry.position));
        if (std::find(factor.paths.begin(), factor.paths.end(), entry.key) == factor.paths.end()) {
          factor.paths.push_back(entry.key);
        }
      }
    }
    factor.count = items.size();
    factor.values.resize(factor.count * factor.paths.size());
    for (std::size_t i = 0; i < factor.count; ++i) {
      if (reading_.tries_values) requireSeparate(edits[i], factor.names[i], items[i].location());
      for (const scenario::Edit& edit : edits[i]) {
        const auto path = std::find(factor.paths.begin(), factor.paths.end(), edit.path);
        factor.values[i * factor.paths.size() + static_cast<std::size_t>(path - factor.paths.begin())] =
            edit.value;
      }
    }
    return factor;
  }

  void readSweep(const Section& root, std::vector<Factor>& factors) {
    const DocumentNode* const originals = childOf(reading_.original.get(), "sweep");
    const std::vector<Section> items = root.sections("sweep");
    for (std::size_t i = 0; i < items.size(); ++i) {
      Factor factor;
      factor.kind = Factor::Kind::sweep;
      factor.paths = {originals->entries[i].key};
      if (items[i].has("values")) {
        factor.values = items[i].texts("values");
      } else {
        const bool is_log = items[i].has("log");
        const Section range = items[i].section(is_log ? "log" : "linear");
        const double from = range.number("from"), to = range.number("to");
        const int count = range.integer("count");
        for (int n = 0; n < count; ++n) {
          const double fraction = static_cast<double>(n) / (count - 1);
          factor.values.push_back(
              numberText(is_log ? from * std::pow(to / from, fraction) : from + (to - from) * fraction));
        }
      }
      factor.count = factor.values.size();
      if (items[i].has("also")) {
        const std::vector<std::string> also = items[i].texts("also");
        factor.paths.insert(factor.paths.end(), also.begin(), also.end());
        std::vector<std::string> repeated;
        for (const std::string& value : factor.values)
          repeated.insert(repeated.end(), factor.paths.size(), value);
        factor.values = std::move(repeated);
      }
      for (std::size_t column = 0; column < factor.paths.size(); ++column)
        tryColumn(factor, column, reading_.at(originals->entries[i].position));
      factors.push_back(std::move(factor));
    }
  }

  Factor readSamples(const Section& samples) {
    const DocumentNode* const originals = childOf(childOf(reading_.original.get(), "samples"), "parameters");
    const std::vector<Section> items = samples.sections("parameters");
    Factor factor;
    factor.kind = Factor::Kind::samples;
    factor.count = static_cast<std::size_t>(samples.integer("count"));
    std::vector<std::size_t> item_of_path;
    for (std::size_t d = 0; d < items.size(); ++d) {
      factor.paths.push_back(originals->entries[d].key);
      const std::vector<std::string> also =
          items[d].has("also") ? items[d].texts("also") : std::vector<std::string>{};
      factor.paths.insert(factor.paths.end(), also.begin(), also.end());
      item_of_path.resize(factor.paths.size(), d);
    }
    const auto seed = static_cast<std::uint64_t>(samples.integer("seed"));
    const int count = samples.integer("count"), dimensions = static_cast<int>(items.size());
    const SamplePoints points = samples.text("method") == "sobol" ? sobolPoints(count, dimensions, seed)
                                                                  : latinHypercube(count, dimensions, seed);
    for (int i = 0; i < count; ++i) {
      for (int d = 0; d < dimensions; ++d) {
        const std::string value = fmt::format("{}", drawn(items[d], points.at(i, d)));
        const auto copies = std::count(item_of_path.begin(), item_of_path.end(), static_cast<std::size_t>(d));
        factor.values.insert(factor.values.end(), static_cast<std::size_t>(copies), value);
      }
    }
    for (std::size_t path = 0; path < factor.paths.size(); ++path)
      tryColumn(factor, path, reading_.at(originals->entries[item_of_path[path]].position));
    return factor;
  }

  /// The quantile of a distribution at a probability.
  static double drawn(const Section& distribution, double probability) {
    if (distribution.has("uniform")) {
      const Section uniform = distribution.section("uniform");
      return uniform.number("from") + (uniform.number("to") - uniform.number("from")) * probability;
    }
    if (distribution.has("normal")) {
      const Section normal = distribution.section("normal");
      return normal.number("mean") + normal.number("deviation") * normalQuantile(probability);
    }
    const Section lognormal = distribution.section("lognormal");
    return lognormal.number("median") *
           std::pow(10, lognormal.number("deviation_db") * normalQuantile(probability) / 10);
  }

  Factor readSites(const Section& sites) {
    Factor factor;
    factor.kind = Factor::Kind::sites;
    for (const scenario::Platform& platform : reading_.spec.base->platforms) {
      if (platform.name == sites.text("platform") && platform.moves())
        reading_.fault(sites.locationOf("platform"),
                       fmt::format("platform '{}' has a track: sites are for a platform with a position",
                                   platform.name));
    }
    const std::string platform = "platforms." + scenario::pathStep(sites.text("platform")) + ".position.";
    factor.paths = {platform + "latitude_deg", platform + "longitude_deg"};
    std::vector<CandidateSite> candidates;
    if (sites.has("candidates")) {
      const std::string file = reading_.resolve(sites.text("candidates"));
      reading_.reportAt(sites.locationOf("candidates"), [&] {
        candidates = readCandidates(file);
        reading_.addVectors(file);
      });
    } else {
      reading_.reportAt(sites.locationOf("grid_m"),
                        [&] { candidates = candidatesOver(reading_.spec.area, sites.number("grid_m")); });
    }
    std::vector<GeodeticPosition> positions;
    for (const CandidateSite& site : candidates)
      positions.push_back({site.latitude_deg, site.longitude_deg, 0});
    if (const std::string text = scenario::farOutsideText(reading_.spec.base->region, positions);
        !text.empty())
      logWarning(fmt::format("candidate sites: {}", text));
    const std::vector<std::string> heights = heightKeysOf(candidates, platform);
    for (const std::string& key : heights) factor.paths.push_back(platform + key);
    for (const CandidateSite& site : candidates) {
      factor.names.push_back(site.name);
      factor.values.push_back(fmt::format("{}", site.latitude_deg));
      factor.values.push_back(fmt::format("{}", site.longitude_deg));
      for (const std::string& key : heights) {
        const bool is_own = site.height && key == site.height->key();
        factor.values.push_back(!site.height ? ""
                                : is_own     ? fmt::format("{}", site.height->height_m)
                                             : "null");
      }
    }
    factor.count = candidates.size();
    SiteSearch search;
    search.choose = sites.integer("choose");
    if (search.choose > static_cast<int>(candidates.size()) && !candidates.empty()) {
      reading_.fault(sites.locationOf("choose"),
                     fmt::format("'choose' is {}, outside the allowed range 1 to {} candidates",
                                 search.choose, candidates.size()));
    }
    if (sites.has("maximise")) {
      const auto found =
          std::find_if(reading_.spec.measures.begin(), reading_.spec.measures.end(),
                       [&](const StudyMeasure& measure) { return measure.name == sites.text("maximise"); });
      if (found == reading_.spec.measures.end()) {
        reading_.fault(sites.locationOf("maximise"),
                       fmt::format("there is no measure '{}'", sites.text("maximise")));
        return factor;
      }
      search.measure = static_cast<std::size_t>(found - reading_.spec.measures.begin());
    }
    const StudyMeasure::Figure figure = reading_.spec.measures[search.measure].figure;
    if (figure != StudyMeasure::Figure::km2 && figure != StudyMeasure::Figure::percent) {
      reading_.fault(sites.location(), fmt::format("sites are chosen by an area; measure '{}' is not an area",
                                                   reading_.spec.measures[search.measure].name));
    } else if (reading_.spec.times_s.size() > 1) {
      reading_.fault(sites.location(), "sites are chosen for one instant: give the study one of 'times'");
    }
    if (!candidates.empty() && !reading_.problems.hasErrors())
      tryEdits(editsOf(factor, 0), sites.locationOf("platform"));
    reading_.spec.sites = search;
    return factor;
  }

  /// Keys of heights that the candidates set: their own, and that of the platform, which theirs replace.
  /// Empty if no candidate has a height.
  /// @param position  path of the platform's position, with the dot
  std::vector<std::string> heightKeysOf(const std::vector<CandidateSite>& candidates,
                                        const std::string& position) const {
    std::set<std::string> keys;
    for (const CandidateSite& site : candidates) {
      if (site.height) keys.insert(site.height->key());
    }
    if (keys.empty()) return {};
    for (const char* const key : scenario::kHeightKeys) {
      if (document::resolvePath(position + key, reading_.spec.base->source->root, scenario::scenarioSpec())
              .exists)
        keys.insert(key);
    }
    return {keys.begin(), keys.end()};
  }

  static std::vector<scenario::Edit> editsOf(const Factor& factor, std::size_t setting) {
    std::vector<scenario::Edit> edits;
    for (std::size_t path = 0; path < factor.paths.size(); ++path) {
      edits.push_back({factor.paths[path], factor.value(setting, path)});
    }
    return edits;
  }

  StudyReading& reading_;
};

}  // namespace

void readVariants(StudyReading& reading, const Section& root) {
  VariantReader(reading).read(root);
}

}  // namespace emscape::study
