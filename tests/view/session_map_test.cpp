/// Places, range rings, units and positions by the verbs of a session.
#include <algorithm>

#include "tests/view/session_sample.h"

namespace emscape::view::test {
namespace {

using testing::HasSubstr;

long long linesOf(const Session& session, render::GroundInk ink) {
  const std::vector<render::GroundLine>& lines = session.picture()->annotations.ground_lines;
  return std::count_if(lines.begin(), lines.end(),
                       [ink](const render::GroundLine& line) { return line.ink == ink; });
}

TEST(SessionMap, GoingToAPositionLooksAtTheGroundThere) {
  const SessionSample sample("quick.yaml");
  for (const char* const text : {"52.05, 5.06", "52°03'N 5°03'36\"E", "31U FT 41255 68602"}) {
    sample->perform({"reset_view", Json::object()});
    sample->perform({"goto_position", {{"position", text}}});
    ASSERT_FALSE(sample->notice().is_error) << sample->notice().text;
    const std::optional<Vec3d> target_m = sample->view().camera.target_m;
    ASSERT_TRUE(target_m) << text;
    EXPECT_NEAR(target_m->x, 4115, 30) << text;
    EXPECT_NEAR(target_m->y, 5565, 30) << text;
    EXPECT_NEAR(target_m->z, 0, 1) << text;
  }
  sample->perform({"goto_position", {{"position", "53, 5"}}});
  EXPECT_TRUE(sample->notice().is_error);
  EXPECT_THAT(sample->notice().text, HasSubstr("53.00000°N 5.00000°E is outside of the volume"));
  sample->perform({"goto_position", {{"position", "there"}}});
  EXPECT_THAT(sample->notice().text, HasSubstr("is not a position"));
}

TEST(SessionMap, RingsPlacesAndGraticuleAreDrawnAndRemoved) {
  SessionSample sample("quick.yaml");
  const TemporaryFolder folder;
  const std::string places =
      folder.write("places.geojson", R"({"type": "Feature", "properties": {"name": "here"},
      "geometry": {"type": "Point", "coordinates": [5, 52]}})");
  sample->perform({"range_rings", {{"rings", {"radar:spacing_m=2000,count=3"}}}});
  sample->perform({"places", {{"files", {places}}}});
  sample->perform({"graticule", {{"shown", "off"}}});
  sample.settle();
  EXPECT_EQ(linesOf(*sample, render::GroundInk::ring), 3);
  EXPECT_EQ(linesOf(*sample, render::GroundInk::graticule), 0);
  ASSERT_EQ(sample->picture()->annotations.ground_points.size(), 1U);
  EXPECT_EQ(sample->picture()->annotations.ground_points[0].label, "here");
  sample->perform({"range_rings", {{"rings", Json::array()}}});
  sample->perform({"places", {{"files", Json::array()}}});
  sample->perform({"graticule", {{"shown", "on"}}});
  sample.settle();
  EXPECT_EQ(linesOf(*sample, render::GroundInk::ring), 0);
  EXPECT_GT(linesOf(*sample, render::GroundInk::graticule), 4);
  EXPECT_TRUE(sample->picture()->annotations.ground_points.empty());
}

TEST(SessionMap, AFileThatCannotBeReadIsReportedAndTheRestIsDrawn) {
  const StateFolder folder;
  SessionSample sample("quick.yaml");
  sample->perform({"drape", {{"file", folder.write("broken.tif", "no picture")}}});
  sample.settle();
  EXPECT_THAT(sample->status().error, HasSubstr("broken.tif"));
  EXPECT_TRUE(sample->picture()->ground);
}

}  // namespace
}  // namespace emscape::view::test
