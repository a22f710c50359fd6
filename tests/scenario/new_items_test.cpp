/// Items that are added, copied, removed, switched off and moved along points, by edits.
#include "scenario/file/new_items.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "emscape/scenario/file/scenario_file.h"
#include "emscape/scenario/model/snapshot.h"
#include "scenario/scan/scan_sweep.h"
#include "tests/scenario/scenario_files.h"

namespace emscape::scenario {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::shared_ptr<const Scenario> quick() {
  return loadScenario(test::shippedScenario("quick.yaml"));
}

std::string savedText(const Scenario& scenario) {
  const test::TemporaryFolder folder;
  const std::string file = (folder.path() / "saved.yaml").string();
  saveScenario(scenario, file);
  return test::readFile(file);
}

TEST(AddedItem, IsWrittenAtTheEndOfItsListWithOneLinePerKey) {
  const auto original = quick();
  Scenario edited = *original;
  edited.set("emitters.\"new: one\"",
             "{platform: mast, kind: jammer, frequency_hz: 3e9, power_w: 5, antenna: "
             "{pattern: isotropic}}");
  ASSERT_EQ(edited.emitters.size(), 3U);
  EXPECT_EQ(edited.emitters[2].name, "new: one");
  const std::string added =
      "  - name: \"new: one\"\n    platform: mast\n    kind: jammer\n    frequency_hz: 3e9\n    power_w: 5\n"
      "    antenna: {pattern: isotropic}\n";
  EXPECT_EQ(savedText(edited), savedText(*original) + added);
  EXPECT_THAT(edited.edits(), ElementsAre(Edit{"emitters.new: one", edited.edits()[0].value}));
}

TEST(AddedItem, IsRemovedWithoutATrace) {
  const auto original = quick();
  Scenario edited = *original;
  edited.set("targets.aircraft", "{platform: mast, rcs_m2: 2}");  // a list that is not given
  edited.set("targets.aircraft.rcs_m2", "3");
  EXPECT_EQ(edited.targets.front().rcs_m2, 3);
  edited.set("targets.aircraft", "null");
  EXPECT_TRUE(edited.edits().empty());
  EXPECT_EQ(edited.hash, original->hash);
}

TEST(AddedItem, NeedsASetOfKeysAndAnUnusedName) {
  Scenario edited = *quick();
  const auto errorOf = [&](const std::string& path, const std::string& value) {
    return test::errorOf([&] { edited.set(path, value); }, ErrorCode::bad_input);
  };
  EXPECT_THAT(errorOf("emitters.radr", "5"), HasSubstr("did you mean 'radar'?"));
  EXPECT_THAT(errorOf("emitters.radr", "null"), HasSubstr("did you mean 'radar'?"));
  EXPECT_THAT(errorOf("emitters.radr.power_w", "5"), HasSubstr("did you mean 'radar'?"));
  EXPECT_THAT(errorOf("platforms.hill", "{name: valley}"), HasSubstr("'hill' in the path and 'valley'"));
}

TEST(NewItems, OfEveryKindAreValidAndCanBeCopiedAndRemoved) {
  for (const char* file : {"quick.yaml", "jacksboro.yaml", "links.yaml"}) {
    const auto original = loadScenario(test::shippedScenario(file));
    for (const std::string& kind : itemKinds()) {
      Scenario edited = *original;
      const std::vector<Edit> edits = editsToAdd(edited, {kind, "", "", {}});
      ASSERT_NO_THROW(edited.set(edits)) << file << ", " << kind;
      const std::string path = edits.back().path;
      ASSERT_NO_THROW(edited.set({editToDuplicate(edited, path, "")})) << file << ", " << kind;
      EXPECT_THAT(edited.edits().back().path, HasSubstr("new " + kind + " 2"));
      edited.set({editToRemove(edited, edited.edits().back().path)});
      edited.set({editToRemove(edited, path)});
      EXPECT_EQ(edited.hash, original->hash) << file << ", " << kind;
    }
  }
}

TEST(NewItems, AtAPositionHaveAPlatformThere) {
  Scenario edited = *quick();
  edited.set(editsToAdd(edited, {"radar", "picket", "", GroundPosition{52.01, 5.02}}));
  const Platform& platform = edited.platforms[static_cast<std::size_t>(edited.emitters.back().platform)];
  EXPECT_EQ(platform.name, "picket");
  EXPECT_EQ(platform.track.front().position.latitude_deg, 52.01);
}

TEST(RenamedItem, IsAlsoNamedByThoseThatReferToIt) {
  const auto original = quick();
  const std::vector<Edit> edits = editsWithReferences(*original, {"platforms.mast.name", "tower"});
  ASSERT_GT(edits.size(), 1U);
  const Scenario edited = *withEdits(*original, edits);
  EXPECT_EQ(edited.platforms[1].name, "tower");
  EXPECT_EQ(edited.emitters[1].platform, 1);
  Scenario wants = *original;
  wants.set("output.wanted_emitter", "radar");
  EXPECT_THAT(
      editsWithReferences(wants, {"emitters.radar.name", "\"a: b\""}),
      ElementsAre(Edit{"emitters.radar.name", "\"a: b\""}, Edit{"output.wanted_emitter", "\"a: b\""}));
  EXPECT_THAT(editsWithReferences(wants, {"emitters.radar.power_w", "5"}),
              ElementsAre(Edit{"emitters.radar.power_w", "5"}));
  EXPECT_THAT(editsWithReferences(wants, {"name", "x"}), ElementsAre(Edit{"name", "x"}));
  EXPECT_THAT(editsWithReferences(wants, {"nonsense", "x"}), ElementsAre(Edit{"nonsense", "x"}));
}

TEST(NewItems, ThatExistAreRefused) {
  const auto scenario = quick();
  EXPECT_THAT(test::errorOf(
                  [&] {
                    editsToAdd(*scenario, {"radar", "radar", "", {}});
                  },
                  ErrorCode::bad_input),
              HasSubstr("already one named 'radar'"));
  EXPECT_THAT(test::errorOf([&] { editToRemove(*scenario, "platforms.mast"); }, ErrorCode::bad_input),
              HasSubstr("carries 'transmitter'"));
}

TEST(WithEdits, MakesTheEditsOnTheFileInPlaceOfTheOwnOnes) {
  const auto original = quick();
  Scenario edited = *original;
  edited.set("emitters.radar.power_w", "5");
  edited.set("emitters.transmitter", "null");
  const auto one = withEdits(edited, {{"emitters.radar.power_w", "5"}});
  EXPECT_EQ(one->emitters.size(), 2U);
  EXPECT_EQ(one->emitters[0].power_w, 5);
  EXPECT_EQ(withEdits(edited, {})->hash, original->hash);
}

TEST(DisabledEmitter, IsOneThatNeverTransmits) {
  Scenario edited = *quick();
  edited.set("emitters.radar.enabled", "false");
  const auto disabled = std::make_shared<const Scenario>(edited);
  const Snapshot snapshot = snapshotAt(disabled, nullptr, 1);
  EXPECT_FALSE(snapshot.emitters[0].active);
  EXPECT_TRUE(snapshot.emitters[1].active);
  EXPECT_EQ(activeTime_s(disabled->emitters[0], 0, 4), 0);
  edited.set("emitters.radar.enabled", "true");
  EXPECT_EQ(activeTime_s(edited.emitters[0], 0, 4), 4);
}

TEST(DisabledEmitter, IsToldOnce) {
  const auto result =
      parseScenario(test::shippedScenario("quick.yaml"),
                    {{"emitters.radar.enabled", "false"}, {"emitters.transmitter.enabled", "false"}});
  ASSERT_TRUE(result.scenario);
  int count = 0;
  for (const Problem& problem : result.problems) {
    if (problem.message.find("disabled") == std::string::npos) continue;
    ++count;
    EXPECT_EQ(problem.message, "2 of 2 emitters are disabled: 'radar', 'transmitter'");
  }
  EXPECT_EQ(count, 1);
}

TEST(DrawnTrack, MovesAFixedPlatformAlongItsPoints) {
  Scenario edited = *quick();
  edited.set("platforms.mast.attitude.heading_deg", "20");
  edited.set(editsForTrack(edited, "mast", {{{52, 5}, {}}, {{52.01, 5}, {}}, {{52.03, 5}, 80.0}}, 0, {}));
  const Platform& mast = edited.platforms[1];
  ASSERT_EQ(mast.track.size(), 3U);
  EXPECT_EQ(mast.track[0].position.height_agl_m, 50);  // as before
  EXPECT_EQ(mast.track[2].position.height_agl_m, 80);
  EXPECT_NEAR(mast.track[1].t_s, 4. / 3, 1e-3);
  EXPECT_EQ(mast.track[2].t_s, 4);  // the end of the scenario
  EXPECT_NEAR(pointAt(mast, 2).position.latitude_deg, 52.015, 1e-5);
  edited.set(editsForTrack(edited, "mast", {{{52, 5}, {}}, {{52.01, 5}, {}}}, 1, 100.0));
  EXPECT_NEAR(edited.platforms[1].track[1].t_s, 1 + 11.126, 0.01);
}

TEST(DrawnTrack, KeepsTheKindOfHeightOfThePlatform) {
  Scenario edited = *quick();
  edited.set({{"platforms.mast.position", "{latitude_deg: 52, longitude_deg: 5, height_msl_m: 8000}"}});
  edited.set(editsForTrack(edited, "mast", {{{52, 5}, {}}, {{52.01, 5}, {}}}, 0, {}));
  EXPECT_EQ(edited.platforms[1].track[1].position.height_msl_m, 8000);
  EXPECT_FALSE(edited.platforms[1].track[1].position.height_agl_m);
}

TEST(DrawnTrack, ReplacesTheFileOfATrack) {
  Scenario edited = *loadScenario(test::shippedScenario("jacksboro.yaml"));
  edited.set(editsForTrack(edited, "helicopter", {{{36.3, -84.4}, {}}, {{36.35, -84.4}, {}}}, 0, 40.0));
  const auto helicopter =
      std::find_if(edited.platforms.begin(), edited.platforms.end(),
                   [](const Platform& platform) { return platform.name == "helicopter"; });
  EXPECT_EQ(helicopter->track.size(), 2U);
  EXPECT_EQ(helicopter->track_file, "");
}

TEST(DrawnTrack, NeedsTimesInOrderAndOneKindOfHeight) {
  Scenario edited = *quick();
  const auto errorOf = [&](const std::string& points) {
    return test::errorOf(
        [&] {
          edited.set(
              {{"platforms.mast.position", "null"}, {"platforms.mast.track", "{points: [" + points + "]}"}});
        },
        ErrorCode::bad_input);
  };
  const std::string first = "{t_s: 0, latitude_deg: 52, longitude_deg: 5, height_agl_m: 10}, ";
  EXPECT_THAT(errorOf(first + "{t_s: 0, latitude_deg: 52, longitude_deg: 5, height_agl_m: 10}"),
              HasSubstr("'t_s' is 0, not above the 0 s of the point before"));
  EXPECT_THAT(errorOf(first + "{t_s: 1, latitude_deg: 52, longitude_deg: 5, height_msl_m: 10}"),
              HasSubstr("the same kind of height"));
}

}  // namespace
}  // namespace emscape::scenario
