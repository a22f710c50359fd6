// The march by blocks of threads, as a GPU runs it, thread after thread on the host, and on the GPU: against
// the march in lanes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "propagation/parabolic_equation/march/march_azimuths.h"
#include "propagation/parabolic_equation/march/march_block_input.h"
#include "propagation/parabolic_equation/march/march_block_run.h"
#include "propagation/parabolic_equation/march/march_block_tables.h"
#include "tests/support/errors.h"
#include "tests/support/gpu.h"

namespace emscape::propagation {
namespace {

using testing::HasSubstr;

/// The threads of a block, one after the other between two barriers.
struct HostTeam {
  std::vector<BlockThread> threads;

  template <class Function>
  void each(const Function& f) {
    for (std::size_t t = 0; t < threads.size(); ++t) f(int(t), threads[t]);
  }
  template <class Function>
  void eachInRows(const Function& f) {
    each(f);
  }
  template <class Function>
  void eachFree(const Function& f) {
    each(f);
  }
};

/// Losses of all cells by blocks on the host.
std::vector<float> marchBlocks(const AzimuthMarch& march) {
  BlockInput input = blockInput(march);
  const std::size_t pitch = std::size_t(march.grid.intervals), azimuths = std::size_t(march.azimuths);
  std::vector<float> excess_db(march.cellCount()), sums(2 * azimuths * std::size_t(march.cells.heights));
  std::vector<int> counts(sums.size());
  std::vector<StoredComplex> fields;
  for (std::size_t a = 0; a < azimuths; ++a)
    fields.insert(fields.end(), input.start.begin(), input.start.end());
  for (std::size_t i = 0; i < input.tasks.size(); ++i) {
    MarchBlockTask task = input.tasks[i];
    task.ground_msl_m = input.flat ? nullptr : march.ground_msl_m.data();
    task.segments = input.segments.data();
    task.levels = input.levels.data();
    task.first_segment = input.first_segment.data();
    task.cell_end = input.cell_end.data();
    task.excess_db = excess_db.data();
    task.states = input.states.data();
    task.pitch = pitch;
    task.fields = fields.data();
    task.sums = sums.data();
    task.counts = counts.data();
    withBlockShape<kMaxBlockIntervals>(input.intervals[i], [&](auto shape) {
      using Shape = decltype(shape);
      std::vector<StoredComplex> propagator(16 * Shape::kSpectral), exponents(propagator.size());
      std::vector<std::vector<StoredComplex>> screens(5, std::vector<StoredComplex>(Shape::kIntervals + 1));
      std::vector<PlannedStep> planned(azimuths * std::size_t(task.end_step));
      BlockTables tables;
      task.propagator = tables.propagator = propagator.data();
      task.exponents = tables.exponents = exponents.data();
      if (input.flat && input.steady_air) {
        task.half_screen = tables.half_screen = screens[0].data();
        task.whole_screen = tables.whole_screen = screens[1].data();
        task.half_in_runs = tables.half_in_runs = screens[2].data();
        task.whole_in_runs = tables.whole_in_runs = screens[3].data();
      }
      if (task.mixed) task.weights = tables.weights = screens[4].data();
      for (int e = 0; e < 16 * Shape::kSpectral; ++e) fillTables(task, tables, Shape::kIntervals, e);
      if (!input.flat) {
        for (int a = 0; a < task.azimuths; ++a) planSteps(task, Shape::kIntervals, planned.data(), a);
        task.planned = planned.data();
      }
      BlockMemory memory;
      std::vector<double> shared(memory.place<Shape>(nullptr, task) / sizeof(double) + 1);
      for (int a = 0; a < task.azimuths; ++a) {
        memory.place<Shape>(reinterpret_cast<char*>(shared.data()), task);
        HostTeam team{std::vector<BlockThread>(Shape::kThreads)};
        BlockTransform<Shape, HostTeam>::prepare(team, memory);
        withBlockKind(input.kind, [&](auto kind) {
          BlockMarch<Shape, decltype(kind)::value, HostTeam>(task, a, team, memory).run();
        });
      }
    });
  }
  return excess_db;
}

AzimuthMarch marchOf(double frequency_hz, double height_step_m, int intervals, double range_step_m,
                     int ranges) {
  AzimuthMarch march;
  march.grid.frequency_hz = frequency_hz;
  march.grid.intervals = intervals;
  march.grid.top_m = height_step_m * intervals;
  march.grid.range_step_m = range_step_m;
  setAbsorber(march.grid);
  march.source.height_agl_m = 20;
  march.cells = {5 * range_step_m, ranges, -0.11 * march.grid.top_m, march.grid.top_m / 30, 36};
  march.azimuths = 2;
  march.air = {standardRefractivity()};
  return march;
}

/// Hills, different at each azimuth, and cells that overlap.
void addHills(AzimuthMarch& march, double height_m) {
  march.cells.overlap = true;
  march.cells.mean_height_m = 1.5 * march.cells.height_step_m;
  march.ground_steps = std::size_t(march.cells.ranges) * 5 + 1;
  for (int a = 0; a < march.azimuths; ++a) {
    for (std::size_t i = 0; i < march.ground_steps; ++i) {
      const double x = double(i) * march.grid.range_step_m;
      march.ground_msl_m.push_back(float(height_m * (1 - std::cos(x / (700.0 + 100 * a)))));
    }
  }
}

/// Largest difference where the expected loss is below 60 dB. Holes have to be the same.
double worstDifference(const std::vector<float>& found_db, const std::vector<float>& expected_db) {
  EXPECT_EQ(found_db.size(), expected_db.size());
  double worst = 0;
  for (std::size_t i = 0; i < expected_db.size(); ++i) {
    EXPECT_EQ(std::isnan(found_db[i]), std::isnan(expected_db[i])) << i;
    if (!(expected_db[i] < 60)) continue;
    const double difference = std::fabs(found_db[i] - expected_db[i]);
    worst = std::isnan(difference) ? HUGE_VAL : std::max(worst, difference);
  }
  return worst;
}

std::vector<float> marchLanes(const AzimuthMarch& march) {
  std::vector<float> excess_db(march.cellCount());
  marchAzimuths(march, excess_db.data());
  return excess_db;
}

void setSea(AzimuthMarch& march) {
  march.surface.perfect = false;
  march.surface.polarization = LinearPolarization::vertical;
  march.surface.ground = {70, 5};
}

/// Requirements for every march.
struct Case {
  const char* name;
  AzimuthMarch march;
  double tolerance_db = 0.05;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const int n : {128, 256, 512, 1024, 2048, 4096, 8192}) {
    all.push_back({"sea", marchOf(3e9, 0.5, n, 100, n > 2048 ? 4 : 20)});
  }
  all.push_back({"narrow", marchOf(3e9, 0.5, 512, 100, 20)});
  all.back().march.grid.form = PeForm::narrow;
  all.push_back({"duct", marchOf(10e9, 0.25, 1024, 100, 40)});
  all.back().march.air = {evaporationDuct(14)};
  all.push_back({"changing air", marchOf(3e9, 0.5, 512, 100, 20)});
  all.back().march.air = {RefractivityAlongPath(
      {0, 3e3, 6e3}, {surfaceDuct(40, 10), surfaceDuct(60, 15), standardRefractivity()})};
  all.push_back({"air by azimuth", marchOf(3e9, 0.5, 512, 100, 20)});
  all.back().march.air = {standardRefractivity(), surfaceDuct(60, 15)};
  all.push_back({"vertical sea", marchOf(1e9, 1, 512, 100, 30)});
  setSea(all.back().march);
  all.push_back({"vertical sea in changing air", marchOf(1e9, 1, 512, 100, 20)});
  setSea(all.back().march);
  all.back().march.air = {RefractivityAlongPath({0, 3e3}, {surfaceDuct(40, 10), surfaceDuct(60, 15)})};
  for (const int n : {128, 2048, 4096}) {
    all.push_back({"vertical sea", marchOf(1e9, 1, n, 100, 6)});
    setSea(all.back().march);
  }
  all.push_back({"hills", marchOf(3e9, 0.25, 1024, 50, 40)});
  addHills(all.back().march, 20);
  all.push_back({"hills in a duct", marchOf(3e9, 0.25, 1024, 50, 40)});
  addHills(all.back().march, 10);
  all.back().march.air = {trilinearRefractivity(30, 60, 20)};
  all.push_back({"hills, vertical", marchOf(1e9, 0.5, 512, 50, 40)});
  addHills(all.back().march, 20);
  setSea(all.back().march);
  all.push_back({"cliffs", marchOf(1e9, 0.5, 512, 50, 40)});
  addHills(all.back().march, 10);
  for (std::size_t i = 30; i < 60; ++i) all.back().march.ground_msl_m[i] += 40;
  all.push_back({"cliffs, vertical", all.back().march});
  setSea(all.back().march);
  all.push_back({"halving", marchOf(10e9, 0.2, 1024, 200, 20), 0.1});
  all.back().march.grid.halving = true;
  all.push_back({"halving, vertical", marchOf(10e9, 0.2, 1024, 200, 20), 0.1});
  all.back().march.grid.halving = true;
  setSea(all.back().march);
  return all;
}

TEST(MarchBlock, EqualsMarchInLanes) {
  for (const Case& one : cases()) {
    EXPECT_LT(worstDifference(marchBlocks(one.march), marchLanes(one.march)), one.tolerance_db)
        << one.name << ", " << one.march.grid.intervals;
  }
}

TEST(MarchBlock, RefusesMarchesBeyondGpuLimits) {
  const auto refused = [](const AzimuthMarch& march) {
    return test::errorOf([&] { blockInput(march); }, ErrorCode::bad_input);
  };
  EXPECT_THAT(refused(marchOf(3e9, 0.5, 64, 100, 1)), HasSubstr("64 height steps; expected 128 .. 8192"));
  AzimuthMarch march = marchOf(3e9, 0.5, 128, 100, 1);
  addHills(march, 1);
  march.ground_msl_m[2] = std::nanf("");
  EXPECT_THAT(refused(march), HasSubstr("no terrain 200 m from the antenna"));
}

TEST(CudaMarch, EqualsMarchInLanes) {
  EMSCAPE_NEEDS_GPU();
  for (const Case& one : cases()) {
    std::vector<float> found_db(one.march.cellCount());
    marchAzimuthsOnGpu(one.march, found_db.data());
    EXPECT_LT(worstDifference(found_db, marchLanes(one.march)), one.tolerance_db)
        << one.name << ", " << one.march.grid.intervals;
  }
}

TEST(CudaMarch, RefusesTheNarrowFormOverTerrain) {
  EMSCAPE_NEEDS_GPU();
  AzimuthMarch march = marchOf(3e9, 0.5, 128, 100, 1);
  addHills(march, 1);
  march.grid.form = PeForm::narrow;
  std::vector<float> excess_db(march.cellCount());
  EXPECT_THAT(test::errorOf([&] { marchAzimuthsOnGpu(march, excess_db.data()); }, ErrorCode::bad_input),
              HasSubstr("narrow form over terrain"));
}

}  // namespace
}  // namespace emscape::propagation
