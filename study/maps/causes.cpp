#include "study/maps/causes.h"

#include <cmath>
#include <mutex>
#include <optional>

#include "emfield/link/path_decision.h"
#include "emscape/base/error.h"
#include "emscape/base/geodesy/geoid.h"
#include "emscape/base/parallel.h"
#include "emscape/base/work.h"
#include "emscape/emfield/link/path_budget.h"
#include "emscape/scenario/model/snapshot.h"

namespace emscape::study {
namespace {

using emfield::PathCause;

}  // namespace

bool hasCauses(scenario::Quantity quantity) {
  using scenario::Quantity;
  switch (quantity) {
    case Quantity::power_density_dbwm2:
    case Quantity::field_strength_dbuvm:
    case Quantity::mean_power_density_dbwm2:
    case Quantity::received_power_dbm:
    case Quantity::intercept_margin_db:
    case Quantity::snr_db:
    case Quantity::sclnr_db:
    case Quantity::detection_probability:
      return true;
    default:
      return false;
  }
}

std::optional<PathCause> causeAt(const scenario::Snapshot& snapshot, scenario::Quantity quantity,
                                 double threshold, const emfield::PathEnd& end,
                                 const scenario::Terrain* terrain) {
  const std::vector<scenario::Emitter>& emitters = snapshot.scenario->emitters;
  std::optional<emfield::Decision> nearest;
  for (std::size_t e = 0; e < emitters.size(); ++e) {
    if (scenario::needsRadar(quantity) && emitters[e].kind != scenario::EmitterKind::radar) continue;
    try {
      const emfield::Decision decision = emfield::decide(
          emfield::pathBudget(snapshot, static_cast<int>(e), end, emitters[e].propagation.model, terrain),
          quantity, threshold);
      if (!nearest || decision.isNearerThan(*nearest)) nearest = decision;
    } catch (const Error&) {  // its ends have no path, or an end is absent
    }
  }
  if (!nearest) return std::nullopt;
  return nearest->cause;
}

std::vector<float> causesOf(const MapGrid& grid, const CoverageRequest& request,
                            const std::shared_ptr<const scenario::Scenario>& scenario,
                            const scenario::Terrain* terrain, const MapHeight& height, double time_s,
                            const std::vector<PixelAnswer>& answers,
                            const std::function<bool(std::size_t)>& isCovered,
                            const std::function<void(double)>& progress) {
  const scenario::Snapshot snapshot = scenario::snapshotAt(scenario, terrain, time_s);
  const auto causeOfPixel = [&](std::size_t p) {
    if (answers[p] != PixelAnswer::exact && answers[p] != PixelAnswer::bound) return NAN;
    if (isCovered(p)) return static_cast<float>(PathCause::covered);
    const auto [latitude_deg, longitude_deg] = grid.positions[p];
    double height_msl_m = height.metres;
    if (height.reference == emfield::HeightReference::ground && terrain != nullptr)
      height_msl_m += terrain->heightMsl_m(latitude_deg, longitude_deg);
    const emfield::PathEnd end{
        {latitude_deg, longitude_deg, height_msl_m + geoidUndulation_m(latitude_deg, longitude_deg)},
        height_msl_m};
    const std::optional<PathCause> cause =
        causeAt(snapshot, request.quantity, request.threshold, end, terrain);
    return cause ? static_cast<float>(*cause) : NAN;
  };
  std::vector<float> causes(grid.pixels());
  const auto pixels = static_cast<double>(grid.pixels());
  std::mutex mutex;
  double done = 0, told = 0;
  const auto add = [&](int count) {
    constexpr double kInterval = 0.01;
    const std::lock_guard lock(mutex);
    done += count;
    if (done / pixels < told + kInterval) return;
    told = done / pixels;
    progress(told);
  };
  parallelFor(static_cast<int>(grid.pixels()), 16, [&](int begin, int end) {
    for (int p = begin; p < end; ++p) {
      checkpoint();
      causes[p] = causeOfPixel(static_cast<std::size_t>(p));
    }
    add(end - begin);
  });
  return causes;
}

}  // namespace emscape::study
