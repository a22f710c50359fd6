#include "apps/emscape/study/study_plan.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "apps/emscape/common/console.h"
#include "apps/emscape/common/interrupt.h"
#include "apps/emscape/common/target.h"
#include "base/stopwatch.h"
#include "emscape/base/error.h"
#include "study/sweep/study_runner.h"

namespace emscape::app {
namespace {

/// Measured times (s) of a variant, by its difference from the preceding one; 0 for classes that do not
/// occur.
struct VariantTimes {
  double first_s = 0;  ///< with nothing kept
  std::array<double, study::kChangeClasses> by_class{};
};

VariantTimes measureTimes(const LoadedStudy& loaded, const GlobalOptions& global) {
  return openOnTarget(global, "float", [&](const ComputeTarget& target) {
    Stopwatch watch;
    study::StudyRunner runner(loaded.spec, loaded.plan, loaded.terrain, target.fieldOptions());
    const std::vector<std::uint32_t>& order = loaded.plan.order;
    const auto run = [&](std::size_t position) {
      stopIfInterrupted();
      runner.run({order[position]}, [](const study::VariantResult&) {});
      return watch.lap_ms() / 1000;
    };
    VariantTimes times;
    times.first_s = run(0);
    constexpr std::size_t kSearched = 100000;
    std::size_t at = 0;
    for (std::size_t c = 0; c < study::kChangeClasses; ++c) {
      for (std::size_t i = 1; i < std::min(order.size(), kSearched); ++i) {
        const auto change = study::changeBetween(loaded.spec, loaded.plan, order[i - 1], order[i]);
        if (static_cast<std::size_t>(change) != c) continue;
        if (at != i - 1) run(i - 1);
        times.by_class[c] = run(at = i);
        break;
      }
    }
    return times;
  });
}

}  // namespace

void checkParts(int parts, std::size_t variants) {
  if (parts >= 1 && static_cast<std::size_t>(parts) <= variants) return;
  throw Error(ErrorCode::usage,
              fmt::format("{} parts of {} variants; 1 to as many as there are variants", parts, variants));
}

int showPlan(const LoadedStudy& loaded, int parts, int jobs, double loading_s, const GlobalOptions& global) {
  const study::StudySpec& spec = loaded.spec;
  const study::VariantSet& variants = spec.variants;
  const VariantTimes times = measureTimes(loaded, global);
  checkParts(parts, variants.count());
  double computing_s = times.first_s;
  for (std::size_t c = 0; c < study::kChangeClasses; ++c) {
    const std::size_t first = c == 0 ? 1 : 0;
    computing_s += static_cast<double>(loaded.plan.changes[c] - first) * times.by_class[c];
  }
  const double expected_s = loading_s + computing_s / jobs;
  const double single_s = static_cast<double>(variants.count()) * (loading_s + times.first_s);
  const double bytes_of_row = 24.0 * static_cast<double>(1 + variants.paths().size() + spec.measures.size());
  const double bytes = 4 * bytes_of_row * static_cast<double>(variants.count()) + 1000.0 * parts;
  Json parameters = Json::array(), changes = Json::object();
  for (std::size_t path = 0; path < variants.paths().size(); ++path) {
    parameters.push_back({{"path", variants.paths()[path]},
                          {"class", toString(loaded.plan.classes[path])},
                          {"settings", variants.factors()[variants.factorOf(path)].count}});
  }
  for (std::size_t c = 0; c < study::kChangeClasses; ++c) {
    changes[toString(static_cast<study::ChangeClass>(c))] = {{"variants", loaded.plan.changes[c]},
                                                             {"seconds_each", times.by_class[c]}};
  }
  if (global.json) {
    printJson({{"study", spec.name},
               {"hash", spec.hash},
               {"variants", variants.count()},
               {"parts", parts},
               {"jobs", jobs},
               {"parameters", parameters},
               {"changes", changes},
               {"expected_s", expected_s},
               {"single_runs_s", single_s},
               {"bytes", bytes}});
    return 0;
  }
  print("Study {}: {} variants of {}, {} measure{}, in {} part{}\n", spec.name, variants.count(),
        spec.base->name, spec.measures.size(), spec.measures.size() == 1 ? "" : "s", parts,
        parts == 1 ? "" : "s");
  print("  {:<56} {:>8}  {}\n", "parameter", "settings", "a change computes again");
  for (const Json& parameter : parameters) {
    print("  {:<56} {:>8}  {}\n", parameter["path"].get<std::string>(),
          parameter["settings"].get<std::size_t>(), parameter["class"].get<std::string>());
  }
  print("  {:<56} {:>8}  {}\n", "variants that change", "number", "ms each");
  for (const auto& [name, change] : changes.items()) {
    const auto number = change["variants"].get<std::size_t>();
    if (number == 0) continue;
    print("  {:<56} {:>8}  {:.1f}\n", name, number,
          1000 * (name == "geometry" && number == 1 ? times.first_s : change["seconds_each"].get<double>()));
  }
  print("  expected: {:.1f} s in {} process{}, {:.1f} MB; as single runs {:.1f} s, {:.1f} times as long\n",
        expected_s, jobs, jobs == 1 ? "" : "es", bytes / 1e6, single_s, single_s / expected_s);
  return 0;
}

}  // namespace emscape::app
