#include "apps/bench/model_timings.h"

#include <time.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "apps/bench/itm_cases.h"
#include "apps/common/interrupt.h"
#include "emscape/base/units.h"
#include "propagation/air/gases.h"
#include "propagation/air/rain.h"
#include "propagation/diffraction/excess.h"
#include "propagation/itm/itm.h"
#include "propagation/p1812/excess.h"
#include "propagation/p452/excess.h"
#include "propagation/p528/p528.h"
#include "propagation/two_ray/two_ray.h"

namespace emscape::app {
namespace {

using namespace propagation;

constexpr double kEffectiveEarth_m = 6371000 * 4.0 / 3;
constexpr double kProfileLength_m = 60e3;
constexpr double kFrequencies_hz[] = {1e8, 1e9, 1e10};

/// CPU time of the calling thread, independent of other load on the machine.
double cpuTime_s() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// CPU time (s) of the fastest run. The results are summed, so that the compiler cannot remove the
/// computation.
template <class Run>
double fastest_s(int repeats, Run run) {
  double fastest = HUGE_VAL;
  volatile double sum = 0;
  for (int i = 0; i < repeats; ++i) {
    stopIfInterrupted();
    const double begin = cpuTime_s();
    sum = sum + static_cast<double>(run());
    fastest = std::min(fastest, cpuTime_s() - begin);
  }
  return fastest;
}

/// @param evaluate  called with 0..count - 1, returns a number
template <class Evaluate>
double perSecond(int repeats, int count, Evaluate evaluate) {
  const double time_s = fastest_s(repeats, [&] {
    double sum = 0;
    for (int i = 0; i < count; ++i) sum += static_cast<double>(evaluate(i));
    return sum;
  });
  return count / time_s;
}

/// Hills of several sizes, 600 m from the lowest to the highest.
struct Hills {
  std::vector<double> range_m;
  std::vector<float> height_msl_m;

  Hills(int posts, double phase) {
    for (int i = 0; i < posts; ++i) {
      const double x = kProfileLength_m * i / (posts - 1);
      range_m.push_back(x);
      double height = 400;
      for (int k = 0; k < 6; ++k)
        height += 160 / (k + 1.0) * std::sin(phase * (k + 1) + x / 9000 * std::pow(2.2, k));
      height_msl_m.push_back(static_cast<float>(height));
    }
  }
  TerrainProfile profile() const {
    return {range_m.data(), height_msl_m.data(), static_cast<int>(range_m.size())};
  }
};

ColumnTiming timeColumns(int repeats, int posts_per_column, double top_msl_m) {
  ColumnTiming timing;
  timing.posts = kColumnCount * posts_per_column + 1;
  timing.top_msl_m = top_msl_m;
  std::vector<float> heights;
  for (int j = 0; j < kColumnHeights; ++j)
    heights.push_back(static_cast<float>(top_msl_m * (j + 1) / kColumnHeights));
  std::vector<float> by_path(std::size_t{kColumnCount} * kColumnHeights), by_column(by_path.size());
  std::vector<double> memory(ExcessScratch::bytes(timing.posts, kColumnHeights) / sizeof(double) + 1);
  const ExcessScratch scratch = ExcessScratch::in(memory.data(), timing.posts, kColumnHeights);
  for (const double frequency_hz : kFrequencies_hz) {
    const Hills hills(timing.posts, std::log(frequency_hz));
    DiffractionParameters parameters;
    parameters.frequency_hz = frequency_hz;
    parameters.effective_earth_radius_m = kEffectiveEarth_m;
    const auto model = diffractionModel<float>(parameters);
    const float tx_msl_m = hills.height_msl_m[0] + 20;
    const auto pathTo = [&](int column) { return hills.profile().upTo((column + 1) * posts_per_column); };
    timing.paths_ms += 1e3 * fastest_s(repeats, [&] {
                         for (int c = 0; c < kColumnCount; ++c) {
                           for (int j = 0; j < kColumnHeights; ++j) {
                             by_path[static_cast<std::size_t>(c * kColumnHeights + j)] =
                                 deltaBullington(model, pathTo(c), tx_msl_m, heights[j]).loss_db;
                           }
                         }
                         return by_path.back();
                       });
    timing.columns_ms += 1e3 * fastest_s(repeats, [&] {
                           const DiffractionExcess excess{model, tx_msl_m};
                           for (int c = 0; c < kColumnCount; ++c) {
                             const TerrainProfile path = pathTo(c);
                             excess({path.range_m[path.count - 1], 0, path.height_msl_m[path.count - 1], path,
                                     heights.data(), kColumnHeights},
                                    scratch, &by_column[static_cast<std::size_t>(c * kColumnHeights)]);
                           }
                           return by_column.back();
                         });
    for (std::size_t i = 0; i < by_path.size(); ++i) {
      timing.max_difference_db =
          std::max(timing.max_difference_db, static_cast<double>(std::abs(by_path[i] - by_column[i])));
    }
  }
  timing.paths_ms /= std::size(kFrequencies_hz);
  timing.columns_ms /= std::size(kFrequencies_hz);
  return timing;
}

/// Adds a timing in double and one in float, compared with it.
template <class PerSecond>
void addBothKinds(std::vector<ModelTiming>& timings, const std::string& model, const std::string& what,
                  PerSecond perSecondOf) {
  timings.push_back({model, what + ", double", perSecondOf(double{}), 0, ""});
  const double in_double = timings.back().evaluations_per_s;
  timings.push_back({model, what + ", float", perSecondOf(float{}), 0, "double"});
  timings.back().ratio = timings.back().evaluations_per_s / in_double;
}

void timeItm(int repeats, std::vector<ModelTiming>& timings) {
  constexpr int kCases = 200, kEvaluations = 20000;
  const bench::ItmCases cases = bench::makeItmCases(kCases, kItmPosts - 1);
  addBothKinds(timings, "itm", "point to point, 300 posts", [&](auto real) {
    using Real = decltype(real);
    return perSecond(repeats, kEvaluations, [&](int i) {
      const auto which = static_cast<std::size_t>(i % kCases);
      const ItmProfile<float> profile{cases.profile(which), cases.intervals, 90.0 + i % 7};
      return itmPointToPoint(profile, bench::linkAs<Real>(cases.links[which]), ItmQuantiles<Real>()).loss_db;
    });
  });
}

void timeTwoRay(int repeats, std::vector<ModelTiming>& timings) {
  TwoRayParameters parameters;
  parameters.frequency_hz = 3e9;
  parameters.effective_earth_radius_m = kEffectiveEarth_m;
  parameters.ground = groundConstants(GroundKind::sea, parameters.frequency_hz);
  parameters.roughness_m = 0.3;
  addBothKinds(timings, "two_ray", "a point over the sea, to beyond the horizon", [&](auto real) {
    using Real = decltype(real);
    const auto model = twoRayModel<Real>(parameters);
    return perSecond(repeats, 100000, [&](int i) {
      return twoRayExcessDb(model, Real(500 + i), Real(20), Real(10 + i % 300));
    });
  });
}

void timeP528(int repeats, std::vector<ModelTiming>& timings) {
  constexpr double kFrequency_hz = 1.2e9;
  const auto atmosphere = std::make_shared<const P528Atmosphere>(kFrequency_hz);
  timings.push_back(
      {"p528", "a curve of one pair of heights",
       perSecond(
           repeats, 100,
           [&](int i) { return P528Curve(atmosphere, kFrequency_hz, 15, 1000 + 100.0 * i).horizon_m(); }),
       0, ""});
  const P528Curve curve(atmosphere, kFrequency_hz, 15, 10000);
  timings.push_back({"p528", "a point of a curve, to 800 km",
                     perSecond(repeats, 800, [&](int i) { return curve.at(1000.0 * i, 50).loss_db; }), 0,
                     ""});
}

/// Times a column of 100 heights up to 6 km at the end of the hills.
template <class Excess>
void timeClearAirColumn(const char* name, int repeats, const Excess& excess,
                        std::vector<ModelTiming>& timings) {
  constexpr int kPosts = 300;
  const Hills hills(kPosts, 1);
  std::vector<double> memory(ExcessScratch::bytes(kPosts, kColumnHeights) / sizeof(double) + 1);
  const ExcessScratch scratch = ExcessScratch::in(memory.data(), kPosts, kColumnHeights);
  for (int k = 0; k < kColumnHeights; ++k)
    scratch.height_msl_m[k] = 6000.0f * static_cast<float>(k + 1) / kColumnHeights;
  ExcessColumn column;
  column.range_m = kProfileLength_m;
  column.ground_msl_m = hills.height_msl_m.back();
  column.profile = hills.profile();
  column.height_msl_m = scratch.height_msl_m;
  column.count = kColumnHeights;
  const double columns_per_s = perSecond(repeats, 200, [&](int i) {
    Excess of_column = excess;
    of_column.tx_msl_m = hills.height_msl_m.front() + 15 + static_cast<float>(i % 20);
    of_column(column, scratch, scratch.excess_db);
    return scratch.excess_db[i % kColumnHeights];
  });
  timings.push_back({name, "a point of a column, 100 heights to 6 km, 300 posts, float",
                     columns_per_s * kColumnHeights, 0, ""});
}

void timeClearAir(int repeats, std::vector<ModelTiming>& timings) {
  P452Parameters parameters;
  parameters.clear_air.frequency_hz = 1e9;
  parameters.clear_air.time_percent = 10;
  parameters.clear_air.latitude_deg = 45;
  P1812Excess p1812;
  p1812.model.clear_air = clearAirModel<float>(parameters.clear_air);
  timeClearAirColumn("p1812", repeats, p1812, timings);
  P452Excess p452;
  p452.model = p452Model<float>(parameters);
  timeClearAirColumn("p452", repeats, p452, timings);
}

void timeAtmosphere(int repeats, std::vector<ModelTiming>& timings) {
  const AirState air = standardAtmosphere(0);
  timings.push_back(
      {"gases", "specific attenuation, line by line",
       perSecond(repeats, 2000, [&](int i) { return gasAttenuation(1e9 + 1e8 * i, air).total_db_per_km(); }),
       0, ""});
  const RainCoefficients<double> rain = rainCoefficients(1e10, 0, 0);
  timings.push_back(
      {"rain", "coefficients of a frequency",
       perSecond(repeats, 20000, [&](int i) { return rainCoefficients(1e9 + 1e6 * i, 0.1, 0).k; }), 0, ""});
  timings.push_back(
      {"rain", "specific attenuation of a rate",
       perSecond(repeats, 100000, [&](int i) { return rain.specificAttenuation_db_per_km(1 + 1e-3 * i); }), 0,
       ""});
}

void timeDiffraction(int repeats, std::vector<ModelTiming>& timings) {
  const ColumnTiming columns = timeColumns(repeats, 1, 6000);
  constexpr double kPoints = double{kColumnCount} * kColumnHeights;
  timings.push_back(
      {"diffraction", "path by path, 2 to 200 posts, float", kPoints / columns.paths_ms * 1e3, 0, ""});
  timings.push_back({"diffraction", "a point of a column, 100 heights to 6 km, float",
                     kPoints / columns.columns_ms * 1e3, columns.ratio(), "path by path"});
}

}  // namespace

std::vector<ModelTiming> timeModels(int repeats) {
  std::vector<ModelTiming> timings;
  timeDiffraction(repeats, timings);
  timeItm(repeats, timings);
  timeTwoRay(repeats, timings);
  timeP528(repeats, timings);
  timeClearAir(repeats, timings);
  timeAtmosphere(repeats, timings);
  return timings;
}

std::vector<ColumnTiming> timeColumns(int repeats) {
  std::vector<ColumnTiming> timings;
  for (const int posts_per_column : {1, 4}) {
    for (const double top_msl_m : {2000.0, 6000.0, 10000.0}) {
      timings.push_back(timeColumns(repeats, posts_per_column, top_msl_m));
    }
  }
  return timings;
}

}  // namespace emscape::app
