#include "playback/series/series_scenario.h"

#include "emscape/playback/series/series_writer.h"
#include "tests/playback/playback_samples.h"

namespace emscape::playback::test {
namespace {

class OwnSeries : public testing::Test {
 protected:
  OwnSeries() : scenario_(quickScenario(folder_)) {
    LoadedScenario loaded = loadScenarioWithTerrain(scenario_, {{"emitters.radar.power_w", "500"}});
    FieldSeries series(loaded, {0.0}, ComputeTarget().fieldOptions());
    SeriesOptions options;
    options.folder = folder_ / "out";
    options.formats = {"vti"};
    writeSeries(series, options);
  }
  ViewState viewOf(const std::string& input) const {
    ViewState view;
    view.input = input;
    addOwnScenario(view);
    return view;
  }

  const TemporaryFolder folder_;
  const std::string scenario_;
};

TEST_F(OwnSeries, IsDrawnWithTheScenarioAndTheEditsThatItWasComputedFrom) {
  const ViewState view = viewOf(folder_ / "out");
  EXPECT_TRUE(std::filesystem::equivalent(view.scenario, scenario_));
  ASSERT_EQ(view.edits.size(), 1U);
  EXPECT_EQ(view.edits[0].path, "emitters.radar.power_w");
}

TEST_F(OwnSeries, IsDrawnWithoutAScenarioThatWasChangedOrRemoved) {
  std::string text = readFile(scenario_);
  text.replace(text.find("name: quick"), 11, "name: other");
  writeFile(scenario_, text);
  EXPECT_EQ(viewOf(folder_ / "out").scenario, "");
  std::filesystem::remove(scenario_);
  EXPECT_EQ(viewOf(folder_ / "out").scenario, "");
}

TEST_F(OwnSeries, AStateOfOtherTypesIsDrawnWithoutItsScenario) {
  const std::string state = folder_ / "out/series.json", text = readFile(state);
  for (const std::string value : {"7", "null", "[]", "{}"}) {
    const std::size_t begin = text.find(':', text.find("\"scenario hash\"")) + 1;
    writeFile(state, text.substr(0, begin) + value + text.substr(text.find(',', begin)));
    EXPECT_EQ(viewOf(folder_ / "out").scenario, "") << value;
  }
}

TEST_F(OwnSeries, AVolumeOfAnotherProgramInItsFolderHasNoScenario) {
  const std::string other = folder_.write("out/other.vti", "");
  EXPECT_EQ(viewOf(other).scenario, "");
}

}  // namespace
}  // namespace emscape::playback::test
