#include "study/sweep/study_runner.h"

#include <fmt/format.h>

#include <algorithm>

#include "emscape/base/error.h"
#include "emscape/scenario/file/scenario_file.h"
#include "study/maps/terrain_cache.h"
#include "study/sweep/definition/polygon_mask.h"
#include "study/sweep/measure.h"

namespace emscape::study {
namespace {

using ScenarioPtr = std::shared_ptr<const scenario::Scenario>;

/// Limit of the memory of variants that are computed together.
constexpr std::size_t kMaxKeptBytes = std::size_t{512} << 20;
constexpr std::size_t kKeptBytesPerValue = 48;

/// Measures of one quantity and threshold.
struct MeasureGroup {
  std::vector<std::size_t> measures;
  CoverageRequest request;
};

/// Measures of one quantity, from one field.
struct QuantityGroup {
  std::vector<MeasureGroup> thresholds;
  std::unique_ptr<CoverageSolver> solver;
};

bool sameHeight(const MapHeight& a, const MapHeight& b) {
  return a.reference == b.reference && a.metres == b.metres;
}

}  // namespace

struct StudyRunner::Impl {
  const StudySpec& study;
  const StudyPlan& plan;
  MapGrid grid;
  std::vector<QuantityGroup> groups;
  std::vector<std::vector<std::uint8_t>> pixels;  ///< of each measure; empty: all
  std::set<std::string> warnings;
  TerrainCache terrain;
  VariantFiles* files = nullptr;
  std::size_t together = 1;  ///< variants that are computed at the same time

  MeasureGroup& groupOf(const StudyMeasure& measure) {
    const auto quantity = std::find_if(groups.begin(), groups.end(), [&](const QuantityGroup& known) {
      return known.thresholds.front().request.quantity == measure.quantity;
    });
    std::vector<MeasureGroup>& thresholds =
        (quantity != groups.end() ? *quantity : groups.emplace_back()).thresholds;
    const auto group = std::find_if(thresholds.begin(), thresholds.end(), [&](const MeasureGroup& known) {
      return known.request.threshold == measure.threshold;
    });
    if (group != thresholds.end()) return *group;
    CoverageRequest& request = thresholds.emplace_back().request;
    request.quantity = measure.quantity;
    request.threshold = measure.threshold;
    request.times_s = study.times_s;
    return thresholds.back();
  }

  void addGroups(const emfield::FieldOptions& options) {
    for (std::size_t m = 0; m < study.measures.size(); ++m) {
      const StudyMeasure& measure = study.measures[m];
      MeasureGroup& group = groupOf(measure);
      group.measures.push_back(m);
      CoverageRequest& request = group.request;
      if (std::count(request.products.begin(), request.products.end(), measure.product) == 0) {
        request.products.push_back(measure.product);
      }
      if (std::none_of(request.heights.begin(), request.heights.end(),
                       [&](const MapHeight& height) { return sameHeight(height, measure.height); })) {
        request.heights.push_back(measure.height);
      }
      pixels.push_back(measure.over.empty() ? std::vector<std::uint8_t>{} : pixelsWithin(measure.over, grid));
    }
    std::size_t kept_bytes = 1;
    for (QuantityGroup& group : groups) {
      std::vector<CoverageRequest> requests;
      for (const MeasureGroup& threshold : group.thresholds) {
        requests.push_back(threshold.request);
        kept_bytes += grid.pixels() * threshold.request.heights.size() * kKeptBytesPerValue;
      }
      group.solver = std::make_unique<CoverageSolver>(grid, std::move(requests), options);
    }
    if (study.times_s.size() > 1) together = std::max<std::size_t>(1, kMaxKeptBytes / kept_bytes);
  }

  std::string nameOf(std::size_t variant) const {
    const std::string name = study.variants.name(variant);
    return fmt::format("variant {}{}", variant, name.empty() ? "" : " '" + name + "'");
  }

  ScenarioPtr scenarioOf(std::size_t variant) const {
    const scenario::ParseResult edited = scenario::editScenario(*study.base, study.variants.edits(variant));
    if (edited.scenario) return edited.scenario;
    for (const scenario::Problem& problem : edited.problems) {
      if (problem.severity == scenario::Severity::error) {
        throw Error(ErrorCode::bad_input, {study.file, 0, 0},
                    fmt::format("{}: {}: {}", nameOf(variant), toString(problem.location), problem.message));
      }
    }
    throw Error(ErrorCode::bad_input, {study.file, 0, 0}, nameOf(variant) + " is not a scenario");
  }

  /// Variants of the terrain that is kept. Those of one geometry are computed faster.
  void computeTogether(const std::vector<std::size_t>& variants, const std::vector<ScenarioPtr>& scenarios,
                       const std::function<void(VariantResult)>& take) {
    warnings.clear();
    std::vector<VariantResult> results(variants.size());
    std::vector<std::vector<MeasureOverTime>> measured(variants.size(),
                                                       std::vector<MeasureOverTime>(study.measures.size()));
    for (std::size_t v = 0; v < variants.size(); ++v) results[v].variant = variants[v];
    for (QuantityGroup& of_quantity : groups) {
      const auto add = [&](std::size_t v, std::size_t threshold, const CoverageMap& map) {
        const MeasureGroup& group = of_quantity.thresholds[threshold];
        if (files != nullptr) files->addMap(variants[v], *scenarios[v], grid, group.request, map);
        for (const std::size_t m : group.measures) {
          const StudyMeasure& measure = study.measures[m];
          if (map.product != measure.product || (map.height && !sameHeight(*map.height, measure.height))) {
            continue;
          }
          measured[v][m].add(measure, map, grid, pixels[m]);
          if (study.sites && study.sites->measure == m) {
            results[v].pixels = pixelsOfClass(map, measure, pixels[m]);
          }
        }
      };
      try {
        for (const std::vector<std::string>& of_variant :
             of_quantity.solver->compute(scenarios, terrain.of(scenarios.front()), add)) {
          warnings.insert(of_variant.begin(), of_variant.end());
        }
      } catch (const Error& error) {
        const std::string to = variants.size() > 1 ? " to " + nameOf(variants.back()) : "";
        throw Error(error.code(), {study.file, 0, 0},
                    fmt::format("{}{}: {}", nameOf(variants.front()), to, error.what()));
      }
    }
    for (std::size_t v = 0; v < variants.size(); ++v) {
      if (files != nullptr) files->addVolumes(variants[v], scenarios[v]);
      for (std::size_t m = 0; m < study.measures.size(); ++m) {
        results[v].values.push_back(measured[v][m].value(study.measures[m]));
      }
      take(std::move(results[v]));
    }
  }

  std::vector<std::uint8_t> pixelsOfClass(const CoverageMap& map, const StudyMeasure& measure,
                                          const std::vector<std::uint8_t>& counted) const {
    std::vector<std::uint8_t> of_class(map.values.size());
    const auto area_class = static_cast<float>(info(measure.product).area_class);
    for (std::size_t p = 0; p < of_class.size(); ++p) {
      of_class[p] = map.values[p] == area_class && (counted.empty() || counted[p] != 0) ? 1 : 0;
    }
    return of_class;
  }
};

StudyRunner::StudyRunner(const StudySpec& study, const StudyPlan& plan, scenario::TerrainPtr terrain,
                         emfield::FieldOptions options, VariantFiles* files)
    : impl_(new Impl{
          study, plan, mapGridOf(study), {}, {}, {}, {study.area, study.base, std::move(terrain)}, files}) {
  options.move_tolerance_m = 0;  // results must not depend on previous computations
  impl_->addGroups(options);
}

StudyRunner::~StudyRunner() = default;

const MapGrid& StudyRunner::grid() const {
  return impl_->grid;
}

const std::set<std::string>& StudyRunner::warnings() const {
  return impl_->warnings;
}

void StudyRunner::run(const std::vector<std::size_t>& variants,
                      const std::function<void(VariantResult)>& take, const ProgressSink& progress) {
  std::vector<std::size_t> pending;
  std::vector<ScenarioPtr> scenarios;
  const auto compute = [&] {
    if (pending.empty()) return;
    impl_->computeTogether(pending, scenarios, take);
    pending.clear();
    scenarios.clear();
  };
  for (std::size_t i = 0; i < variants.size(); ++i) {
    if (progress) progress("variants", static_cast<double>(i) / static_cast<double>(variants.size()));
    ScenarioPtr scenario = impl_->scenarioOf(variants[i]);
    const bool is_alike =
        !pending.empty() && pending.size() < impl_->together &&
        changeBetween(impl_->study, impl_->plan, pending.back(), variants[i]) != ChangeClass::geometry &&
        impl_->terrain.fits(*scenario);
    if (!is_alike) compute();
    if (pending.empty()) impl_->terrain.of(scenario);  // the next ones are compared with it
    pending.push_back(variants[i]);
    scenarios.push_back(std::move(scenario));
  }
  compute();
  if (progress) progress("variants", 1);
}

}  // namespace emscape::study
