#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include "emscape/base/work.h"
#include "emscape/emfield/solver/field_solver.h"
#include "emscape/scenario/file/scenario_file.h"
#include "emscape/scenario/model/snapshot.h"
#include "tests/support/files.h"
#include "tests/support/sanitizers.h"

namespace emscape::emfield::test {
namespace {

using Clock = std::chrono::steady_clock;
using ScenarioPtr = std::shared_ptr<const scenario::Scenario>;

double since_ms(Clock::time_point time) {
  return std::chrono::duration<double, std::milli>(Clock::now() - time).count();
}

/// scenarios/jacksboro.yaml with one emitter's model.
ScenarioPtr withModel(const std::string& model, const std::string& dims) {
  auto scenario = std::make_shared<scenario::Scenario>(
      *scenario::loadScenario(emscape::test::shippedScenario("jacksboro.yaml"), {{"region.dims", dims}}));
  scenario->set({{"emitters.search radar.propagation", model}});
  return scenario;
}

/// Time (ms) from stop() to the end of an update that is stopped after some time; 0 if it has ended before.
double abandon_ms(FieldSolver& solver, const scenario::Snapshot& snapshot, double after_ms) {
  Work work;
  std::atomic<bool> has_ended{false};
  Clock::time_point stopped_at;
  double took_ms = 0;
  std::thread thread([&] {
    const WorkScope scope(&work);
    try {
      solver.update(snapshot);
    } catch (const Stopped&) {
      took_ms = since_ms(stopped_at);
    }
    has_ended = true;
  });
  for (const Clock::time_point begin = Clock::now(); since_ms(begin) < after_ms && !has_ended;)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  stopped_at = Clock::now();
  work.stop();
  thread.join();
  return took_ms;
}

std::vector<std::string> modelNames() {
  const auto names = namesOf(propagation::PropagationModel());
  return {names.begin(), names.end()};
}

class AbandonedField : public testing::TestWithParam<std::string> {};

/// The bound of docs/viewer.md, on a large field. The best of some tries, because other programs may run.
TEST_P(AbandonedField, EndsWithinATenthOfASecond) {
  constexpr double kBound_ms = 100;
  constexpr int kTries = emscape::test::kIsSanitized ? 1 : 6;
  const ScenarioPtr scenario = withModel(GetParam(), "[400, 400, 100]");
  const scenario::TerrainPtr terrain = scenario::loadTerrain(*scenario);
  const scenario::Snapshot snapshot = scenario::snapshotAt(scenario, terrain.get(), 0);
  for (const double after_ms : {20.0, 150.0, 500.0}) {
    double best_ms = kBound_ms;
    for (int n = 0; n < kTries && best_ms >= kBound_ms; ++n) {
      FieldSolver solver(scenario, terrain);
      best_ms = std::min(best_ms, abandon_ms(solver, snapshot, after_ms));
    }
    RecordProperty("abandoned_ms_after_" + std::to_string(static_cast<int>(after_ms)),
                   std::to_string(best_ms));
    if (!emscape::test::kIsSanitized) {
      EXPECT_LT(best_ms, kBound_ms) << "stopped after " << after_ms << " ms";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Models, AbandonedField, testing::ValuesIn(modelNames()),
                         [](const auto& model) { return model.param; });

TEST(AbandonedField, LeavesASolverThatComputesTheSameFields) {
  const ScenarioPtr before = withModel("horizon", "[60, 60, 30]");
  const ScenarioPtr edited =
      withModel(emscape::test::kIsSanitized ? "diffraction" : "parabolic_equation", "[60, 60, 30]");
  const scenario::TerrainPtr terrain = scenario::loadTerrain(*before);
  const auto valuesOf = [](const FieldSolver& solver) { return solver.volumes().front().host()->values; };
  const std::vector<double> moments_ms =
      emscape::test::kIsSanitized ? std::vector{20.0} : std::vector{0.0, 20.0};
  for (const double after_ms : moments_ms) {
    FieldSolver solver(before, terrain), fresh(before, terrain);
    solver.update(scenario::snapshotAt(before, terrain.get(), 0));
    const auto old_values = valuesOf(solver);
    abandon_ms(solver, scenario::snapshotAt(edited, terrain.get(), 0), after_ms);
    const FieldChanged undone = solver.update(scenario::snapshotAt(before, terrain.get(), 0));
    EXPECT_EQ(valuesOf(solver), old_values) << after_ms;
    EXPECT_LE(undone.moved.size(), 1U) << "the geometry of the other emitters stays";
    solver.update(scenario::snapshotAt(edited, terrain.get(), 2.3));
    fresh.update(scenario::snapshotAt(edited, terrain.get(), 2.3));
    EXPECT_EQ(valuesOf(solver), valuesOf(fresh)) << after_ms;
  }
}

TEST(AbandonedField, LeavesNoUnfinishedPowersInTheCaches) {
  const ScenarioPtr scenario = withModel("horizon", "[150, 150, 60]");
  const scenario::TerrainPtr terrain = scenario::loadTerrain(*scenario);
  const auto at = [&](double time_s) { return scenario::snapshotAt(scenario, terrain.get(), time_s); };
  const auto valuesOf = [](const FieldSolver& solver) { return solver.volumes().front().host()->values; };
  FieldSolver fresh(scenario, terrain);
  fresh.update(at(9));
  const std::vector<double> moments_ms =
      emscape::test::kIsSanitized ? std::vector{1.0, 8.0} : std::vector{0.0, 1.0, 2.0, 4.0, 8.0, 16.0};
  for (const double after_ms : moments_ms) {
    FieldSolver solver(scenario, terrain);
    for (const double time_s : {0.0, 1.0, 2.0}) abandon_ms(solver, at(time_s), after_ms);
    solver.update(at(9));
    EXPECT_EQ(valuesOf(solver), valuesOf(fresh)) << after_ms;
    solver.update(at(0));
    solver.update(at(9));
    EXPECT_EQ(valuesOf(solver), valuesOf(fresh)) << after_ms;
  }
}

TEST(Work, ReportsItsPartsAndIsStoppedAtATime) {
  Work work;
  const WorkScope scope(&work);
  work.begin("a field");
  EXPECT_EQ(work.progress().fraction, -1);
  {
    const WorkPart first("first", 0, 0.5);
    reportDone(0.5);
    EXPECT_EQ(work.progress().part, "first");
    EXPECT_DOUBLE_EQ(work.progress().fraction, 0.25);
    const WorkPart inner("", 0.5, 1);
    reportDone(0.5);
    EXPECT_DOUBLE_EQ(work.progress().fraction, 0.375);
    reportDone(0.1);
    EXPECT_DOUBLE_EQ(work.progress().fraction, 0.375) << "never less";
  }
  EXPECT_DOUBLE_EQ(work.progress().fraction, 0.5);
  EXPECT_EQ(work.progress().part, "");
  work.stopAt(Clock::now() + std::chrono::hours(1));
  EXPECT_NO_THROW(checkpoint());
  work.stopAt(Clock::now());
  EXPECT_THROW(checkpoint(), Stopped);
  work.begin("another");
  EXPECT_NO_THROW(checkpoint());
  StopFlag flag{true};
  Work flagged(&flag);
  EXPECT_TRUE(flagged.isStopped());
}

}  // namespace
}  // namespace emscape::emfield::test
