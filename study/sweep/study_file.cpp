#include "emscape/study/study_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "base/whole_file.h"
#include "document/schema_check.h"
#include "document/text_edit.h"
#include "document/text_file.h"
#include "emscape/base/error.h"
#include "emscape/scenario/scenario_file.h"
#include "study/sweep/candidate_sites.h"
#include "study/sweep/sample_points.h"
#include "study/sweep/study_format.h"

namespace emscape::study {
namespace {

namespace fs = std::filesystem;
using document::DocumentNode;
using document::DocumentNodePtr;
using document::ProblemList;
using document::Section;
using Factor = VariantFactor;

constexpr std::uintmax_t kMaxStudyBytes = std::uintmax_t{64} << 20;
/// Values of a parameter up to which each is tried in the scenario.
constexpr std::size_t kMaxTried = 200;

/// "20.000000000000004" would be an honest end of a range of decimals; twelve digits are what was meant.
std::string numberText(double value) {
  return fmt::format("{}", std::stod(fmt::format("{:.12g}", value)));
}

class StudyReader {
 public:
  StudyReader(const std::string& file, const std::vector<scenario::Edit>& edits) : file_(file) {
    bytes_ = readWholeText(file, kMaxStudyBytes);
    original_ = document::readDocument(file, document::checkedUtf8(file, bytes_), problems_);
    if (!original_) {
      document::requireNoProblem(problems_);
      throw Error(ErrorCode::bad_input, {file, 0, 0}, "the file is empty");
    }
    root_ = checkable(*original_);
    document::checkObject(file, *root_, studyFormat(), problems_);
    document::requireNoProblem(problems_);
    spec_.file = file;
    const Section root(file_, root_.get(), studyFormat());
    spec_.base = scenario::loadScenario(resolve(root.text("scenario")), edits);
    readMaps(root);
    readMeasures(root);
    readVariants(root);
    document::requireNoProblem(problems_);
  }

  StudySpec take(const std::string& version) {
    document::ContentHash hash;
    hash.add(version);
    hash.add(bytes_);
    hash.add(spec_.base->hash);
    if (spec_.base->terrain) {
      files_.insert(files_.end(), spec_.base->terrain->files.begin(), spec_.base->terrain->files.end());
    }
    for (const std::string& name : files_) hash.add(fmt::format("{:08x}", digestOf(name).crc32));
    spec_.hash = hash.hex();
    return std::move(spec_);
  }

 private:
  std::string resolve(const std::string& name) const {
    return (fs::path(file_).parent_path() / name).lexically_normal().string();
  }

  void fault(const SourceLocation& location, const std::string& message) {
    problems_.addError(location, message);
  }
  SourceLocation at(const document::TextPosition& position) const {
    return {file_, position.line, position.column};
  }

  /// Calls a function; its error gets a location of the study.
  template <class Read>
  void reportAt(const SourceLocation& location, const Read& read) {
    try {
      read();
    } catch (const Error& error) {
      fault(location, error.what());
    }
  }

  void readMaps(const Section& root) {
    spec_.name = root.has("name") ? root.text("name") : fs::path(file_).stem().string();
    reportAt(root.locationOf("times"),
             [&] { spec_.times_s = scenario::parseTimes(root.text("times"), spec_.base->clock); });
    spec_.area = areaOf(spec_.base->region);
    if (root.has("area")) {
      reportAt(root.locationOf("area"), [&] { spec_.area = parseArea(root.text("area")); });
    }
    const scenario::Region& region = spec_.base->region;
    spec_.cell_m = root.has("cell_m") ? root.number("cell_m")
                                      : std::max(1.0, std::round(region.size_m.x / region.dims.x));
    spec_.crs = root.text("crs");
  }

  void readMeasures(const Section& root) {
    for (const Section& item : root.sections("measures")) {
      StudyMeasure measure;
      measure.name = item.text("name");
      measure.product = productNamed(item.text("product"));
      const ProductInfo& product = info(measure.product);
      reportAt(item.locationOf("height"), [&] {
        const std::vector<MapHeight> heights = parseHeights(item.text("height"));
        if (heights.size() != 1) throw Error(ErrorCode::usage, "a measure has one height");
        measure.height = heights.front();
      });
      const Section& with_quantity = item.has("quantity") ? item : root;
      reportAt(with_quantity.locationOf("quantity"),
               [&] { measure.quantity = scenario::quantityFromName(with_quantity.text("quantity")); });
      const std::optional<double> given =
          item.has("threshold") ? item.optionalNumber("threshold") : root.optionalNumber("threshold");
      const std::optional<double> usual = defaultThreshold(measure.quantity);
      if (!given && !usual && measure.product != Product::value) {
        fault(item.location(), fmt::format("measure '{}' needs a threshold: quantity '{}' has no usual one",
                                           measure.name, scenario::info(measure.quantity).name));
      }
      measure.threshold = given.value_or(usual.value_or(0));
      if (product.over_time && spec_.times_s.size() < 2) {
        fault(item.location(),
              fmt::format("product '{}' is over time: give the study 'times' with two times or more",
                          product.name));
      }
      readFigure(item, measure);
      if (item.text("over") != "region") {
        measure.over = resolve(item.text("over"));
        if (!fs::is_regular_file(measure.over)) {
          fault(item.locationOf("over"), measure.over + ": no such file; polygons, or 'region'");
        } else {
          files_.push_back(measure.over);
        }
      }
      spec_.measures.push_back(std::move(measure));
    }
  }

  void readFigure(const Section& item, StudyMeasure& measure) {
    using Figure = StudyMeasure::Figure;
    const bool has_area = info(measure.product).area_class >= 0;
    const std::string unit = item.text("unit");
    const bool is_area = unit == "km2" || unit == "percent" || (unit.empty() && has_area);
    if (item.has("statistic") && (unit == "km2" || unit == "percent")) {
      fault(item.locationOf("statistic"),
            fmt::format("'statistic' goes with values, not with areas in {}", unit));
    } else if (item.has("statistic") || !is_area) {
      measure.figure =
          item.has("statistic")
              ? static_cast<Figure>(static_cast<int>(Figure::mean) + item.choiceIndex("statistic"))
              : Figure::mean;
      if (!unit.empty() && unit != unitOf(measure)) {
        fault(item.locationOf("unit"), fmt::format("product '{}' is in '{}', not {}",
                                                   info(measure.product).name, unitOf(measure), unit));
      }
    } else {
      measure.figure = unit == "percent" ? Figure::percent : Figure::km2;
      if (!has_area) {
        fault(item.locationOf("unit"),
              fmt::format("product '{}' has no area; its unit is '{}', with statistic mean, min or max",
                          info(measure.product).name, info(measure.product).unit));
      }
    }
  }

  /// Tries edits in the scenario.
  void tryEdits(const std::vector<scenario::Edit>& edits, const SourceLocation& location) {
    for (const scenario::Problem& problem : scenario::editScenario(*spec_.base, edits).problems) {
      if (problem.severity == scenario::Severity::error) {
        fault(location, toString(problem.location) + ": " + problem.message);
        return;
      }
    }
  }

  /// Tries the values of one column of a factor, each by itself.
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
      if (problems_.hasErrors()) return;
    }
  }

  void readVariants(const Section& root) {
    std::vector<Factor> factors;
    if (root.has("variants")) factors.push_back(readList(root));
    if (root.has("sweep")) readSweep(root, factors);
    if (root.has("samples")) factors.push_back(readSamples(root.section("samples")));
    if (root.has("sites")) {
      if (!factors.empty())
        fault(root.locationOf("sites"), "'sites' goes without variants, sweep and samples");
      factors.push_back(readSites(root.section("sites")));
    }
    if (factors.empty()) {
      fault(root.location(), "the study has none of 'variants', 'sweep', 'samples' and 'sites'");
    }
    std::set<std::string> paths;
    for (const Factor& factor : factors) {
      for (const std::string& path : factor.paths) {
        if (!paths.insert(path).second) {
          fault(root.location(),
                fmt::format("'{}' is set twice: by two of variants, sweep and samples", path));
        }
      }
    }
    document::requireNoProblem(problems_);
    spec_.variants = VariantSet(std::move(factors));
  }

  Factor readList(const Section& root) {
    Factor factor;
    const std::vector<Section> items = root.sections("variants");
    const DocumentNode* const originals = childOf(original_.get(), "variants");
    std::vector<std::vector<scenario::Edit>> edits(items.size());
    for (std::size_t i = 0; i < items.size(); ++i) {
      factor.names.push_back(items[i].text("name"));
      const DocumentNode* const set = childOf(originals->items[i].get(), "set");
      if (set == nullptr) continue;
      for (const document::MapEntry& entry : set->entries) {
        const std::string text =
            entry.value->kind == document::NodeKind::null ? "null" : document::flowText(*entry.value, false);
        edits[i].push_back({entry.key, text});
        tryEdits(edits[i], at(entry.position));
        if (std::find(factor.paths.begin(), factor.paths.end(), entry.key) == factor.paths.end()) {
          factor.paths.push_back(entry.key);
        }
      }
    }
    factor.count = items.size();
    factor.values.resize(factor.count * factor.paths.size());
    for (std::size_t i = 0; i < factor.count; ++i) {
      for (const scenario::Edit& edit : edits[i]) {
        const auto path = std::find(factor.paths.begin(), factor.paths.end(), edit.path);
        std::string& value =
            factor.values[i * factor.paths.size() + static_cast<std::size_t>(path - factor.paths.begin())];
        if (!value.empty()) {
          fault(items[i].location(), fmt::format("variant '{}' sets '{}' twice", factor.names[i], edit.path));
        }
        value = edit.value;
      }
    }
    return factor;
  }

  void readSweep(const Section& root, std::vector<Factor>& factors) {
    const DocumentNode* const originals = childOf(original_.get(), "sweep");
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
      tryColumn(factor, 0, at(originals->entries[i].position));
      factors.push_back(std::move(factor));
    }
  }

  Factor readSamples(const Section& samples) {
    const DocumentNode* const originals = childOf(childOf(original_.get(), "samples"), "parameters");
    const std::vector<Section> items = samples.sections("parameters");
    Factor factor;
    factor.kind = Factor::Kind::samples;
    factor.count = static_cast<std::size_t>(samples.integer("count"));
    for (const document::MapEntry& entry : originals->entries) factor.paths.push_back(entry.key);
    const auto seed = static_cast<std::uint64_t>(samples.integer("seed"));
    const int count = samples.integer("count"), dimensions = static_cast<int>(items.size());
    const SamplePoints points = samples.text("method") == "sobol" ? sobolPoints(count, dimensions, seed)
                                                                  : latinHypercube(count, dimensions, seed);
    for (int i = 0; i < count; ++i) {
      for (int d = 0; d < dimensions; ++d) {
        factor.values.push_back(fmt::format("{}", drawn(items[d], points.at(i, d))));
      }
    }
    for (std::size_t d = 0; d < items.size(); ++d) tryColumn(factor, d, at(originals->entries[d].position));
    return factor;
  }

  /// The value of a distribution below which it lies with a probability.
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
    const std::string platform = "platforms." + scenario::pathStep(sites.text("platform")) + ".position.";
    factor.paths = {platform + "latitude_deg", platform + "longitude_deg"};
    std::vector<CandidateSite> candidates;
    if (sites.has("candidates")) {
      const std::string file = resolve(sites.text("candidates"));
      reportAt(sites.locationOf("candidates"), [&] { candidates = readCandidates(file); });
      if (!candidates.empty()) files_.push_back(file);
    } else {
      reportAt(sites.locationOf("grid_m"),
               [&] { candidates = candidatesOver(spec_.area, sites.number("grid_m")); });
    }
    for (const CandidateSite& site : candidates) {
      factor.names.push_back(site.name);
      factor.values.push_back(fmt::format("{}", site.latitude_deg));
      factor.values.push_back(fmt::format("{}", site.longitude_deg));
    }
    factor.count = candidates.size();
    SiteSearch search;
    search.choose = sites.integer("choose");
    if (search.choose > static_cast<int>(candidates.size()) && !candidates.empty()) {
      fault(sites.locationOf("choose"), fmt::format("'choose' is {}, outside the allowed 1 to {} candidates",
                                                    search.choose, candidates.size()));
    }
    if (sites.has("maximise")) {
      const auto found =
          std::find_if(spec_.measures.begin(), spec_.measures.end(),
                       [&](const StudyMeasure& measure) { return measure.name == sites.text("maximise"); });
      if (found == spec_.measures.end()) {
        fault(sites.locationOf("maximise"), fmt::format("there is no measure '{}'", sites.text("maximise")));
        return factor;
      }
      search.measure = static_cast<std::size_t>(found - spec_.measures.begin());
    }
    const StudyMeasure::Figure figure = spec_.measures[search.measure].figure;
    if (figure != StudyMeasure::Figure::km2 && figure != StudyMeasure::Figure::percent) {
      fault(sites.location(), fmt::format("sites are chosen by an area; measure '{}' is none",
                                          spec_.measures[search.measure].name));
    } else if (spec_.times_s.size() > 1) {
      fault(sites.location(), "sites are chosen for one instant: give the study one of 'times'");
    }
    if (!candidates.empty()) tryEdits(editsOf(factor, 0), sites.locationOf("platform"));
    spec_.sites = search;
    return factor;
  }

  static std::vector<scenario::Edit> editsOf(const Factor& factor, std::size_t setting) {
    std::vector<scenario::Edit> edits;
    for (std::size_t path = 0; path < factor.paths.size(); ++path) {
      edits.push_back({factor.paths[path], factor.value(setting, path)});
    }
    return edits;
  }

  std::string file_, bytes_;
  ProblemList problems_;
  DocumentNodePtr original_, root_;
  std::vector<std::string> files_;  ///< named by the study, besides the scenario
  StudySpec spec_;
};

}  // namespace

std::string unitOf(const StudyMeasure& measure) {
  switch (measure.figure) {
    case StudyMeasure::Figure::km2:
      return "km2";
    case StudyMeasure::Figure::percent:
      return "percent";
    default:
      break;
  }
  const char* const unit = info(measure.product).unit;
  return unit != nullptr ? unit : scenario::info(measure.quantity).unit;
}

StudySpec loadStudy(const std::string& file, const std::vector<scenario::Edit>& edits,
                    const std::string& version) {
  return StudyReader(file, edits).take(version);
}

}  // namespace emscape::study
