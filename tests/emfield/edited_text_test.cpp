// Edits of a scenario's text, as `--set` makes them, against a new solver on the edited scenario.
#include <gtest/gtest.h>

#include <filesystem>

#include "emscape/base/error.h"
#include "emscape/emfield/solver/field_solver.h"
#include "emscape/scenario/file/scenario_file.h"
#include "emscape/scenario/model/snapshot.h"
#include "scenario/file/schema.h"
#include "scenario/file/source.h"
#include "tests/scenario/random_edits.h"
#include "tests/support/files.h"

namespace emscape::emfield {
namespace {

using scenario::Edit;
using scenario::Scenario;

/// A random edit of any key of the table that applies to the scenario.
Edit someEdit(const Scenario& scenario, scenario::RandomEdits& random) {
  std::vector<Edit> edits;
  scenario::forEachPath(scenario.source->root.get(), scenario::scenarioSpec(), "",
                        [&](const std::string& path, const document::ValueSpec& spec) {
                          edits.push_back({path, random.below(6) == 0 ? "null" : random.valueFor(spec)});
                        });
  return edits[random.below(edits.size())];
}

void expectTheSameVolumes(const FieldSolver& updated, const FieldSolver& fresh) {
  ASSERT_EQ(updated.volumes().size(), fresh.volumes().size());
  for (std::size_t c = 0; c < fresh.volumes().size(); ++c) {
    const auto a = updated.volumes()[c].host(), b = fresh.volumes()[c].host();
    EXPECT_TRUE(a->info == b->info);
    EXPECT_EQ(a->first_valid_k, b->first_valid_k);
    EXPECT_TRUE(a->values == b->values) << fresh.channels()[c].name;
  }
}

class EditedText : public ::testing::TestWithParam<const char*> {};

TEST_P(EditedText, SLOW_EqualsNewSolverBitForBit) {
  const std::filesystem::path folder = emscape::test::shippedScenario("");
  auto scenario = std::make_shared<const Scenario>([&] {
    Scenario small = *scenario::loadScenario((folder / GetParam()).string());
    small.set("region.dims", "[14, 12, 10]");
    return small;
  }());
  scenario::TerrainPtr terrain = scenario::loadTerrain(*scenario);
  FieldSolver solver(scenario, terrain, {});
  solver.update(scenario::snapshotAt(scenario, terrain.get(), 0));
  scenario::RandomEdits random(21);
  int compared = 0;
  for (int tries = 0; tries < 400 && compared < 25; ++tries) {
    const Edit edit = someEdit(*scenario, random);
    SCOPED_TRACE(scenario::toString(edit));
    const auto edited = scenario::editScenario(*scenario, {edit}).scenario;
    if (!edited || edited->region.dims.count() > 4000 || edited->region.size_m.x > 6e4) continue;
    try {
      const bool other_ground =
          !(edited->terrain == scenario->terrain) || edited->region.size_m != scenario->region.size_m;
      const scenario::TerrainPtr ground = other_ground ? scenario::loadTerrain(*edited) : terrain;
      const scenario::Snapshot snapshot = scenario::snapshotAt(edited, ground.get(), double(tries % 3));
      FieldSolver fresh(edited, ground, {});
      fresh.update(snapshot);
      solver.update(snapshot, ground);
      expectTheSameVolumes(solver, fresh);
      if (HasFailure()) return;
      scenario = edited;
      terrain = ground;
      ++compared;
    } catch (const Error&) {
      continue;  // refused: below the ground, beyond a model, over missing terrain
    }
  }
  EXPECT_EQ(compared, 25);
}

INSTANTIATE_TEST_SUITE_P(Scenarios, EditedText,
                         ::testing::Values("jacksboro.yaml", "jamming.yaml", "eme_200.yaml", "quick.yaml"),
                         [](const auto& scenario) {
                           return std::filesystem::path(scenario.param).stem().string();
                         });

}  // namespace
}  // namespace emscape::emfield
