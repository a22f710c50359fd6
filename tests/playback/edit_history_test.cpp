#include "playback/editing/edit_history.h"

#include <fmt/format.h>

#include <random>

#include "emscape/scenario/file/scenario_file.h"
#include "tests/playback/playback_samples.h"

namespace emscape::playback::test {
namespace {

using testing::HasSubstr;

/// The text of a scenario with its edits.
std::string textOf(const TemporaryFolder& folder, const scenario::Scenario& scenario) {
  saveScenario(scenario, folder / "saved.yaml");
  return readFile(folder / "saved.yaml");
}

scenario::Edit randomEdit(std::mt19937& random) {
  const auto number = [&](double from, double to) {
    return fmt::format("{}", std::uniform_real_distribution<double>(from, to)(random));
  };
  switch (random() % 7) {
    case 0:
      return {"emitters.radar.power_w", number(1, 1e6)};
    case 1:
      return {"emitters.transmitter.frequency_hz", number(5e7, 5e9)};
    case 2:
      return {"platforms.mast.position.height_agl_m", number(1, 500)};
    case 3:
      return {"atmosphere.k_factor", number(1, 2)};
    case 4:
      return {"atmosphere.k_factor", "null"};
    case 5:
      return {"emitters.radar.active_s", "[[0, " + number(1, 4) + "]]"};
    default:
      return {"output", "{floor: " + number(-150, -100) + "}"};
  }
}

TEST(EditHistory, UndoAndRedoOfRandomEditsGiveTheSameTexts) {
  const TemporaryFolder folder;
  EditHistory history(scenario::loadScenario(quickScenario(folder)));
  std::mt19937 random(5);
  std::vector<std::string> texts{textOf(folder, *history.scenario())};
  std::vector<std::vector<scenario::Edit>> edits{history.edits()};
  while (texts.size() <= 100) {
    history.set({randomEdit(random)});
    std::string text = textOf(folder, *history.scenario());
    if (text == texts.back()) continue;  // such as removing a missing key: no step
    texts.push_back(std::move(text));
    edits.push_back(history.edits());
  }
  for (std::size_t step = texts.size() - 1; step-- > 0;) {
    ASSERT_TRUE(history.canUndo());
    history.undo();
    ASSERT_EQ(textOf(folder, *history.scenario()), texts[step]);
    ASSERT_EQ(history.edits(), edits[step]);
  }
  EXPECT_FALSE(history.canUndo());
  EXPECT_FALSE(history.isModified());
  history.undo();
  EXPECT_EQ(textOf(folder, *history.scenario()), texts.front());
  for (std::size_t step = 1; step < texts.size(); ++step) {
    ASSERT_TRUE(history.canRedo());
    history.redo();
    ASSERT_EQ(textOf(folder, *history.scenario()), texts[step]);
  }
  EXPECT_FALSE(history.canRedo());
  EXPECT_TRUE(history.isModified());
}

TEST(EditHistory, OfLargeScenariosFewerStepsAreKept) {
  const TemporaryFolder folder;
  std::string track = "t_s,latitude_deg,longitude_deg,height_msl_m\n";
  for (int t_s = 0; t_s < 20000; ++t_s) track += fmt::format("{},52.05,5.06,{}\n", t_s, 1000 + t_s % 100);
  folder.write("track.csv", track);
  const std::string fixed = "position: {latitude_deg: 52.05, longitude_deg: 5.06, height_agl_m: 50}";
  EditHistory small(scenario::loadScenario(quickScenario(folder)));
  EditHistory large(scenario::loadScenario(quickScenario(folder, {{fixed, "track: {file: track.csv}"}})));
  for (int n = 0; n < 60; ++n) {
    for (EditHistory* history : {&small, &large}) {
      history->beginDrag();
      history->set("emitters.radar.power_w", fmt::format("{}", 1 + n));
      history->endDrag();
    }
  }
  EXPECT_EQ(small.stepsBack(), 60u);
  EXPECT_GE(large.stepsBack(), 10u);
  EXPECT_LE(large.stepsBack() * 20000 * sizeof(scenario::TrackPoint), std::size_t{64} << 20);
  for (std::size_t n = large.stepsBack(); n > 0; --n) large.undo();
  EXPECT_FALSE(large.canUndo());
  EXPECT_TRUE(large.canRedo());
}

TEST(EditHistory, ADragIsOneStep) {
  const TemporaryFolder folder;
  EditHistory history(scenario::loadScenario(quickScenario(folder)));
  history.set("emitters.radar.losses_db", "5");
  history.beginDrag();
  for (int i = 1; i <= 50; ++i) history.set("emitters.radar.power_w", fmt::format("{}", 10000 + i));
  EXPECT_EQ(history.scenario()->emitters[0].power_w, 10050);
  history.endDrag();
  history.undo();
  EXPECT_EQ(history.scenario()->emitters[0].power_w, 10000);
  EXPECT_EQ(history.scenario()->emitters[0].losses_db, 5);
  history.redo();
  EXPECT_EQ(history.scenario()->emitters[0].power_w, 10050);
}

TEST(EditHistory, DragWithoutEffectIsNoStepAndKeepsRedo) {
  const TemporaryFolder folder;
  EditHistory history(scenario::loadScenario(quickScenario(folder)));
  history.set("emitters.radar.losses_db", "5");
  history.undo();
  history.beginDrag();
  history.set("emitters.radar.power_w", "20000");
  history.set("emitters.radar.power_w", "10000");
  history.endDrag();
  EXPECT_FALSE(history.canUndo());
  EXPECT_TRUE(history.canRedo());
  history.beginDrag();
  history.set("emitters.radar.power_w", "20000");
  history.cancelDrag();
  EXPECT_EQ(history.scenario()->emitters[0].power_w, 10000);
  EXPECT_FALSE(history.canUndo());
  history.redo();
  EXPECT_EQ(history.scenario()->emitters[0].losses_db, 5);
}

TEST(EditHistory, UndoEndsDragAndEditClearsRedo) {
  const TemporaryFolder folder;
  EditHistory history(scenario::loadScenario(quickScenario(folder)));
  history.beginDrag();
  history.set("emitters.radar.power_w", "20000");
  EXPECT_TRUE(history.canUndo());
  history.undo();
  EXPECT_EQ(history.scenario()->emitters[0].power_w, 10000);
  EXPECT_TRUE(history.canRedo());
  history.set("emitters.radar.losses_db", "5");
  EXPECT_FALSE(history.canRedo());
}

TEST(EditHistory, InvalidEditKeepsTheScenario) {
  const TemporaryFolder folder;
  EditHistory history(scenario::loadScenario(quickScenario(folder)));
  const ScenarioPtr before = history.scenario();
  EXPECT_THAT(errorOf([&] { history.set("emitters.radar.power_w", "-1"); }), HasSubstr("'power_w' is -1"));
  EXPECT_EQ(history.scenario(), before);
  EXPECT_FALSE(history.canUndo());
}

TEST(EditHistory, KnowsWhetherItIsSaved) {
  const TemporaryFolder folder;
  EditHistory history(scenario::loadScenario(quickScenario(folder)));
  history.set("emitters.radar.losses_db", "5");
  EXPECT_TRUE(history.isModified());
  history.markSaved();
  EXPECT_FALSE(history.isModified());
  history.undo();
  EXPECT_TRUE(history.isModified());
}

TEST(EditHistory, ACommandMakesTheSameEdits) {
  const TemporaryFolder folder;
  EditHistory history(scenario::loadScenario(quickScenario(folder)));
  history.set("emitters.radar.power_w", "500");
  history.set("emitters.radar.scan.elevation_deg", "7");
  history.set("name", "the colonel's");
  const std::string command = commandText("render", *history.scenario());
  EXPECT_EQ(command, "emscape render " + folder / "scenario.yaml" +
                         " --set emitters.radar.power_w=500 --set emitters.radar.scan.elevation_deg=7"
                         " --set 'name=the colonel'\\''s'");
}

}  // namespace
}  // namespace emscape::playback::test
