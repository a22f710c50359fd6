// What an edit of one value recomputes, and what it keeps.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "tests/emfield/edited_battlefield.h"
#include "tests/support/errors.h"

namespace emscape::emfield {
namespace {

using namespace emscape::emfield::testing;
using scenario::CombineMode;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Solves a scenario and then an edited one.
class EditedOnce : public ::testing::Test {
 protected:
  void SetUp() override {
    Random random(7);
    scenario_ = battlefield(random, FrameKind::altitude, {PropagationModel::horizon});
    solver_ = std::make_unique<FieldSolver>(scenario_, nullptr, FieldOptions{});
    solver_->update(scenario::snapshotAt(scenario_, nullptr, 0));
  }
  FieldChanged after(const std::function<void(Scenario&)>& edit) {
    auto edited = std::make_shared<Scenario>(*scenario_);
    edit(*edited);
    const FieldChanged changed = solver_->update(scenario::snapshotAt(edited, nullptr, 0));
    scenario_ = edited;
    return changed;
  }
  std::shared_ptr<Scenario> scenario_;
  std::unique_ptr<FieldSolver> solver_;
};

TEST_F(EditedOnce, PowerRepeatsOnlyCombinationOfThatEmitter) {
  const FieldChanged changed = after([](Scenario& s) { s.emitters[3].power_w *= 2; });
  EXPECT_TRUE(changed.any);
  EXPECT_FALSE(changed.grid);
  EXPECT_FALSE(changed.channels);
  EXPECT_THAT(changed.moved, IsEmpty());
  EXPECT_THAT(changed.turned, ElementsAre(3));
  EXPECT_THAT(changed.volumes, ElementsAre(0));
}

TEST_F(EditedOnce, ModelRepeatsOnlyGeometryOfThatEmitter) {
  const FieldChanged changed =
      after([](Scenario& s) { s.emitters[3].propagation.model = PropagationModel::two_ray; });
  EXPECT_THAT(changed.moved, ElementsAre(3));
  EXPECT_THAT(changed.turned, IsEmpty());
}

TEST_F(EditedOnce, FloorRepeatsOnlyTheProduct) {
  const FieldChanged changed = after([](Scenario& s) { s.output.floor = -80; });
  EXPECT_THAT(changed.moved, IsEmpty());
  EXPECT_THAT(changed.turned, IsEmpty());
  EXPECT_THAT(changed.volumes, ElementsAre(0));
  EXPECT_EQ(solver_->stageTimes().combine_ms, 0);
}

TEST_F(EditedOnce, QuantitiesKeepTheGeometry) {
  const FieldChanged changed = after([](Scenario& s) { s.output.quantities = {"snr_db", "emitter_count"}; });
  EXPECT_TRUE(changed.channels);
  EXPECT_FALSE(changed.grid);
  EXPECT_THAT(changed.moved, IsEmpty());
  EXPECT_THAT(changed.volumes, ElementsAre(0, 1));
}

TEST_F(EditedOnce, OtherQuantitiesOfTheOptionsKeepTheGeometry) {
  const scenario::Snapshot snapshot = scenario::snapshotAt(scenario_, nullptr, 0);
  EXPECT_THROW(solver_->setQuantities({"nonsense"}, scenario_), Error);
  EXPECT_FALSE(solver_->update(snapshot).any);
  solver_->setQuantities({"snr_db", "emitter_count"}, scenario_);
  EXPECT_EQ(solver_->channels().size(), 1U) << "until the next update";
  EXPECT_THAT(solver_->update(snapshot).moved, IsEmpty());
  FieldOptions options;
  options.quantities = {"snr_db", "emitter_count"};
  FieldSolver fresh(scenario_, nullptr, options);
  fresh.update(snapshot);
  expectEqualSolvers(*solver_, fresh);
  EXPECT_FALSE(solver_->update(snapshot).any);
}

TEST_F(EditedOnce, RegionRepeatsEverything) {
  EXPECT_TRUE(after([](Scenario& s) { s.region.dims = {9, 9, 4}; }).grid);
  EXPECT_EQ(solver_->grid().dims.x, 9);
  EXPECT_EQ(solver_->volumes().front().grid().dims.z, 4);
}

TEST_F(EditedOnce, AddedAndRemovedEmittersKeepTheGeometryOfTheOthers) {
  const FieldChanged added = after([](Scenario& s) {
    Random random(9);
    addEmitter(s, somewhere(random), plainEmitter("new", 0));
    std::swap(s.emitters[1], s.emitters.back());
  });
  EXPECT_THAT(added.moved, ElementsAre(1));
  const FieldChanged removed = after([](Scenario& s) { s.emitters.erase(s.emitters.begin()); });
  EXPECT_THAT(removed.moved, IsEmpty());
  const FieldChanged changed = after([](Scenario& s) {
    s.emitters.pop_back();
    s.emitters[2].frequency_hz *= 2;
  });
  EXPECT_THAT(changed.moved, ElementsAre(2));
  SolvedField fresh(scenario_);
  expectEqualSolvers(*solver_, fresh);
}

TEST_F(EditedOnce, ARefusedEmitterLeavesTheGeometryOfTheOthers) {
  auto refused = std::make_shared<Scenario>(*scenario_);
  refused->emitters.pop_back();
  refused->emitters[3].propagation.model = PropagationModel::p528;
  refused->emitters[3].propagation.p528.time_percent = 200;
  EXPECT_THROW(solver_->update(scenario::snapshotAt(refused, nullptr, 0)), Error);
  EXPECT_THAT(after([](Scenario& s) { s.emitters[3].power_w *= 2; }).moved, IsEmpty());
  SolvedField fresh(scenario_);
  expectEqualSolvers(*solver_, fresh);
}

TEST_F(EditedOnce, ValueWithoutEffectComputesNoVolume) {
  const auto before = solver_->volumes().front().dense();
  const FieldChanged changed = after([](Scenario& s) {
    s.hash = "another";
    s.receivers.front().gain_dbi = 9;
    s.emitters[3].receiver.noise_figure_db = 7;
    s.emitters[0].waveform = scenario::Waveform{1000, 1e-6, {}};
    s.placed_receivers.emplace_back();
    s.placed_receivers.back().platform = 0;
    s.placed_receivers.back().antenna = scenario::makeIsotropic();
    s.targets.emplace_back();
    s.targets.back().platform = 1;
  });
  EXPECT_FALSE(changed.any);
  EXPECT_EQ(solver_->volumes().front().dense(), before);
  EXPECT_EQ(solver_->volumes().front().info().extra.at("scenario_hash"), "another");
}

TEST_F(EditedOnce, NamesSidesAndSymbolsComputeNoVolume) {
  after([](Scenario& s) {
    s.output.combine = CombineMode::per_emitter;
    s.emitters[3].antenna = scenario::makeSinc(45, 0.3, 0.3, -60);
    s.emitters[3].frequency_hz = 9e9;
  });
  const auto before = solver_->volumes()[3].dense();
  const FieldChanged changed = after([](Scenario& s) {
    s.emitters[3].name = "renamed";
    s.platforms[0].name = "elsewhere";
    s.platforms[0].side = scenario::Side::hostile;
    s.platforms[0].sidc = "10031000001101000000";
  });
  EXPECT_TRUE(changed.channels) << "by its name";
  EXPECT_THAT(changed.moved, IsEmpty());
  EXPECT_THAT(changed.turned, IsEmpty());
  EXPECT_THAT(changed.volumes, IsEmpty());
  EXPECT_EQ(solver_->volumes()[3].dense(), before);
  EXPECT_EQ(solver_->channels()[3].name, "power_density_dbwm2:renamed");
  EXPECT_EQ(solver_->volumes()[3].info().quantity, "power_density_dbwm2:renamed");
  EXPECT_THAT(solver_->warnings(), ::testing::Contains(HasSubstr("'renamed': voxels closer than")));
  EXPECT_THAT(solver_->warnings(), ::testing::Not(::testing::Contains(HasSubstr("'radio'"))));
}

TEST_F(EditedOnce, ResolvedWarningsDisappear) {
  after([](Scenario& s) {
    s.emitters[3].frequency_hz = 9e9;
    s.emitters[3].antenna = scenario::makeSinc(45, 0.3, 0.3, -60);
  });
  EXPECT_THAT(solver_->warnings(),
              ::testing::Contains(HasSubstr("'radio': voxels closer than the far-field distance")));
  after([](Scenario& s) { s.emitters[3].antenna = scenario::makeIsotropic(); });
  EXPECT_THAT(solver_->warnings(), ::testing::Not(::testing::Contains(HasSubstr("'radio'"))));
}

TEST_F(EditedOnce, RefusedEditKeepsTheField) {
  const auto before = solver_->volumes().front().dense();
  auto refused = std::make_shared<Scenario>(*scenario_);
  refused->emitters[3].propagation.model = PropagationModel::p528;
  refused->emitters[3].propagation.p528.time_percent = 200;
  EXPECT_THROW(solver_->update(scenario::snapshotAt(refused, nullptr, 0)), Error);
  EXPECT_EQ(solver_->volumes().front().dense(), before);
  after([](Scenario& s) { s.emitters[3].power_w *= 2; });
  SolvedField fresh(scenario_);
  expectEqualSolvers(*solver_, fresh);
}

TEST_F(EditedOnce, OtherElevationFilesMustBeGiven) {
  auto edited = std::make_shared<Scenario>(*scenario_);
  auto snapshot = scenario::snapshotAt(scenario_, nullptr, 0);
  edited->terrain = scenario::TerrainSpec{{"other.tif"}, {}, {}};
  snapshot.scenario = edited;
  EXPECT_EQ(
      test::errorOf([&] { solver_->update(snapshot); }),
      "test.yaml: the edited scenario names other elevation files: they must be loaded and given to the "
      "update");
}

}  // namespace
}  // namespace emscape::emfield
