// Platforms before and after their tracks.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "emscape/scenario/file/scenario_file.h"
#include "emscape/scenario/model/poses.h"
#include "emscape/scenario/model/snapshot.h"
#include "tests/support/errors.h"
#include "tests/support/files.h"

namespace emscape::scenario {
namespace {

using ::testing::HasSubstr;

/// quick.yaml, 0 to 4 s, with its mast on a track from 1 to 3 s, and a receiver on it.
std::shared_ptr<const Scenario> trackedMast(const std::string& outside = "") {
  const std::string track =
      "{points: [{t_s: 1, latitude_deg: 52, longitude_deg: 5, height_agl_m: 50}, {t_s: 3, latitude_deg: 52, "
      "longitude_deg: 5.1, height_agl_m: 50}]" +
      outside + "}";
  return loadScenario(test::shippedScenario("quick.yaml"),
                      {{"platforms.mast.position", "null"}, {"platforms.mast.track", track}});
}

int mastOf(const Scenario& scenario) {
  return platformNamed(scenario, "mast");
}

TEST(Presence, PlatformIsAbsentOutsideItsTrackWithItsEmitters) {
  const auto scenario = trackedMast();
  const auto mast = static_cast<std::size_t>(mastOf(*scenario));
  for (const double time_s : {0.0, 0.99, 1.0, 2.0, 3.0, 3.01, 4.0}) {
    const Snapshot snapshot = snapshotAt(scenario, nullptr, time_s);
    const bool is_there = time_s >= 1 && time_s <= 3;
    EXPECT_EQ(snapshot.platforms[mast].present, is_there) << time_s;
    for (std::size_t e = 0; e < scenario->emitters.size(); ++e) {
      if (scenario->emitters[e].platform != static_cast<int>(mast)) continue;
      EXPECT_EQ(snapshot.emitters[e].active, is_there) << time_s;
    }
  }
}

TEST(Presence, PlatformThatHoldsStandsAtTheEndsOfItsTrack) {
  const auto scenario = trackedMast(", outside: hold");
  const auto mast = static_cast<std::size_t>(mastOf(*scenario));
  for (const double time_s : {0.0, 2.0, 4.0}) {
    const Snapshot snapshot = snapshotAt(scenario, nullptr, time_s);
    EXPECT_TRUE(snapshot.platforms[mast].present);
    EXPECT_TRUE(snapshot.emitters[0].active);
  }
  EXPECT_NEAR(snapshotAt(scenario, nullptr, 4).platforms[mast].position.longitude_deg, 5.1, 1e-9);
}

TEST(Presence, StatedPoseIsThereAtAnyTime) {
  const auto scenario = trackedMast();
  const Snapshot snapshot =
      snapshotAt(scenario, nullptr, 0, {{mastOf(*scenario), positionAgl(52, 5, 50), {}}});
  EXPECT_TRUE(snapshot.platforms[static_cast<std::size_t>(mastOf(*scenario))].present);
  EXPECT_TRUE(snapshot.emitters[0].active);
}

TEST(Presence, TextNamesTheTimesAndTheRemedy) {
  const auto scenario = trackedMast();
  const Platform& mast = scenario->platforms[static_cast<std::size_t>(mastOf(*scenario))];
  EXPECT_EQ(absenceText(mast, 0.0),
            "'mast' is absent at t = 0 s: its track runs from 1 to 3 s ('track: {outside: hold}' keeps it at "
            "the track's ends)");
  EXPECT_THAT(absenceText(mast, std::vector<double>{0, 1, 2, 4}), HasSubstr("absent at 2 of 4 times"));
  EXPECT_EQ(absenceText(mast, std::vector<double>{1, 2}), "");
}

}  // namespace
}  // namespace emscape::scenario
