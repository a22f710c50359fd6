#include "study/sweep/study_plan.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "emscape/base/error.h"
#include "emscape/emfield/solver/field_solver.h"
#include "emscape/scenario/file/scenario_file.h"
#include "emscape/scenario/model/snapshot.h"

namespace emscape::study {
namespace {

using ScenarioPtr = std::shared_ptr<const scenario::Scenario>;

/// A field at one position, used to determine what edits invalidate.
class ChangeProbe {
 public:
  ChangeProbe(const StudySpec& study, scenario::TerrainPtr terrain)
      : study_(study), terrain_(std::move(terrain)) {
    auto surface = std::make_shared<emfield::Surface>();
    surface->width = surface->height = 1;
    surface->positions = {{(study.area.box.south_deg + study.area.box.north_deg) / 2,
                           (study.area.box.west_deg + study.area.box.east_deg) / 2}};
    surface->heights_m = {100};
    options_.surface = surface;
    options_.allow_missing_terrain = true;
    std::set<std::string> quantities;
    for (const StudyMeasure& measure : study.measures) {
      quantities.insert(scenario::info(measure.quantity).name);
    }
    options_.quantities.assign(quantities.begin(), quantities.end());
    base_ = withOutput(*study.base);
    const std::vector<double>& times_s = study.times_s;
    times_s_ = {times_s.front(), times_s[times_s.size() / 2], times_s.back()};
  }

  ChangeClass classOf(const scenario::Edit& edit) const {
    const scenario::ParseResult edited = scenario::editScenario(*study_.base, {edit});
    // If the edit is possible only together with others, it may change anything.
    if (!edited.scenario) return ChangeClass::geometry;
    const ScenarioPtr variant = withOutput(*edited.scenario);
    ChangeClass strongest = ChangeClass::product;
    try {
      emfield::FieldSolver solver(base_, terrain_, options_);
      for (const double time_s : times_s_) {
        const scenario::Snapshot before = scenario::snapshotAt(base_, terrain_.get(), time_s);
        const scenario::Snapshot after = scenario::snapshotAt(variant, terrain_.get(), time_s);
        solver.update(before);
        const emfield::FieldChanged changed = solver.update(after);
        if (changed.grid || !changed.moved.empty()) return ChangeClass::geometry;
        if (!changed.turned.empty()) {
          strongest = std::min(strongest, isTurned(before, after) ? ChangeClass::beam : ChangeClass::power);
        }
      }
    } catch (const Error&) {  // other terrain; faults of values are reported when the variant is computed
      return ChangeClass::geometry;
    }
    return strongest;
  }

 private:
  ScenarioPtr withOutput(const scenario::Scenario& scenario) const {
    auto changed = std::make_shared<scenario::Scenario>(scenario);
    changed->output.radar_look = scenario::RadarAim::target;
    changed->output.combine = scenario::CombineMode::sum;
    return changed;
  }

  static bool samePose(const scenario::BeamPose& a, const scenario::BeamPose& b) {
    return a.forward == b.forward && a.right == b.right && a.up == b.up && a.steer_u == b.steer_u &&
           a.steer_v == b.steer_v;
  }

  /// Edited antennas are new objects; unchanged antennas stay the same objects.
  static bool isTurned(const scenario::Snapshot& before, const scenario::Snapshot& after) {
    for (std::size_t e = 0; e < before.emitters.size(); ++e) {
      if (before.scenario->emitters[e].antenna != after.scenario->emitters[e].antenna ||
          !samePose(before.emitters[e].beam, after.emitters[e].beam) ||
          !samePose(before.emitters[e].mount, after.emitters[e].mount)) {
        return true;
      }
    }
    return false;
  }

  const StudySpec& study_;
  scenario::TerrainPtr terrain_;
  emfield::FieldOptions options_;
  ScenarioPtr base_;
  std::vector<double> times_s_;
};

}  // namespace

StudyPlan planStudy(const StudySpec& study, const scenario::TerrainPtr& terrain) {
  const VariantSet& variants = study.variants;
  const ChangeProbe probe(study, terrain);
  StudyPlan plan;
  std::vector<std::vector<std::uint32_t>> ranks;  // [path][setting]: equal values have equal ranks
  for (std::size_t path = 0, column = 0; path < variants.paths().size(); ++path) {
    column = path > 0 && variants.factorOf(path) == variants.factorOf(path - 1) ? column + 1 : 0;
    const VariantFactor& factor = variants.factors()[variants.factorOf(path)];
    std::map<std::string, std::uint32_t> known;
    std::vector<const std::string*> set_values;  // different ones
    ranks.emplace_back();
    for (std::size_t setting = 0; setting < factor.count; ++setting) {
      const std::string& value = factor.value(setting, column);
      const auto [rank, is_new] = known.emplace(value, static_cast<std::uint32_t>(known.size()));
      ranks.back().push_back(rank->second);
      if (is_new && !value.empty()) set_values.push_back(&value);
    }
    ChangeClass strongest = ChangeClass::product;
    const std::size_t values = set_values.size();
    for (const std::size_t tried : std::set<std::size_t>{0, values / 2, values - 1}) {
      if (tried >= values) continue;
      strongest = std::min(strongest, probe.classOf({variants.paths()[path], *set_values[tried]}));
    }
    plan.classes.push_back(strongest);
  }

  std::vector<std::size_t> by_class(ranks.size());
  std::iota(by_class.begin(), by_class.end(), std::size_t{0});
  std::stable_sort(by_class.begin(), by_class.end(),
                   [&](std::size_t a, std::size_t b) { return plan.classes[a] < plan.classes[b]; });
  plan.order.resize(variants.count());
  std::iota(plan.order.begin(), plan.order.end(), 0u);
  std::sort(plan.order.begin(), plan.order.end(), [&](std::uint32_t a, std::uint32_t b) {
    for (const std::size_t path : by_class) {
      const std::size_t factor = variants.factorOf(path);
      const std::uint32_t rank_a = ranks[path][variants.setting(a, factor)],
                          rank_b = ranks[path][variants.setting(b, factor)];
      if (rank_a != rank_b) return rank_a < rank_b;
    }
    return a < b;
  });
  for (std::size_t i = 0; i < plan.order.size(); ++i) {
    const ChangeClass change =
        i == 0 ? ChangeClass::geometry : changeBetween(study, plan, plan.order[i - 1], plan.order[i]);
    ++plan.changes[static_cast<std::size_t>(change)];
  }
  return plan;
}

ChangeClass changeBetween(const StudySpec& study, const StudyPlan& plan, std::size_t from, std::size_t to) {
  ChangeClass strongest = ChangeClass::product;
  for (std::size_t path = 0; path < plan.classes.size(); ++path) {
    if (plan.classes[path] < strongest &&
        study.variants.value(from, path) != study.variants.value(to, path)) {
      strongest = plan.classes[path];
    }
  }
  return strongest;
}

PartRange rangeOfPart(std::size_t variants, int part, int parts) {
  const auto n = static_cast<std::size_t>(part), of = static_cast<std::size_t>(parts);
  return {variants * (n - 1) / of, variants * n / of};
}

int usualParts(std::size_t variants) {
  constexpr std::size_t kVariantsPerPart = 16, kMaxUsual = 500;
  return static_cast<int>(
      std::clamp<std::size_t>(variants / kVariantsPerPart, std::min<std::size_t>(variants, 8), kMaxUsual));
}

}  // namespace emscape::study
