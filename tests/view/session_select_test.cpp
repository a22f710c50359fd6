/// Selecting, measuring, and the value under the cursor.
#include "tests/view/session_sample.h"

namespace emscape::view::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// Pixel of an object in the picture.
render::Projected pixelOf(const Session& session, const std::string& path) {
  const playback::LivePicture& shown = *session.picture();
  return render::project(shown.camera, shown.size, shown.box.toDrawn(session.objectOf(path)->position_m));
}

/// A session on scenarios/quick.yaml whose picture is large enough to tell its objects apart.
class Pictured : public testing::Test, protected SessionSample {
 protected:
  Pictured() : SessionSample(optionsFor(shippedScenario("quick.yaml"), {480, 360})) { settle(); }
};

using Selection = Pictured;

TEST_F(Selection, IsAPathThatTheScenarioHas) {
  EXPECT_EQ(session->report()["selected"], "");
  perform(R"({"do":"select","path":"emitters.radar"})");
  EXPECT_EQ(error(), "");
  EXPECT_EQ(session->report()["selected"], "emitters.radar");
  perform(R"({"do":"select","path":"emitters.nobody"})");
  EXPECT_THAT(error(), StartsWith("select: there is no 'emitters.nobody'"));
  EXPECT_EQ(session->selected(), "emitters.radar");
  perform(R"({"do":"select"})");
  EXPECT_EQ(session->selected(), "");
}

TEST_F(Selection, MovesToTheNextAndPreviousObject) {
  const std::vector<SceneObject>& objects = session->objects();
  ASSERT_GT(objects.size(), 2U);
  EXPECT_EQ(objects[0].path, "emitters.radar");
  perform(R"({"do":"select","change":1})");
  EXPECT_EQ(session->selected(), objects[0].path);
  perform(R"({"do":"select","change":1})");
  EXPECT_EQ(session->selected(), objects[1].path);
  perform(R"({"do":"select","change":-1})");
  perform(R"({"do":"select","change":-1})");
  EXPECT_EQ(session->selected(), objects.back().path);
}

TEST_F(Selection, EndsWithTheObjectAndReturnsWithIt) {
  perform(R"({"do":"select","path":"emitters.transmitter"})");
  perform(R"({"do":"set","path":"emitters.transmitter","value":"null"})");
  settle();
  EXPECT_EQ(session->selected(), "");
  perform(R"({"do":"undo"})");
  settle();
  EXPECT_EQ(session->selected(), "emitters.transmitter");
}

TEST_F(Selection, AnObjectIsFoundAtItsPixelAndNotBesideIt) {
  const render::Projected at = pixelOf(*session, "emitters.radar");
  const SceneObject* found = objectAt(session->objects(), at.x + 4, at.y - 3);
  ASSERT_NE(found, nullptr);
  EXPECT_EQ(found->path, "emitters.radar") << "before its platform";
  EXPECT_EQ(found->kind, "radar");
  EXPECT_THAT(found->details, HasSubstr("GHz"));
  EXPECT_EQ(objectAt(session->objects(), at.x + 40, at.y - 40), nullptr);
}

TEST_F(Selection, WhatIsNotDrawnIsNotFound) {
  perform(R"({"do":"set","path":"platforms.radar site.side","value":"friendly"})");
  settle();
  const render::Projected at = pixelOf(*session, "emitters.radar");
  ASSERT_NE(objectAt(session->objects(), at.x, at.y), nullptr);
  perform(R"({"do":"sides","sides":"hostile"})");
  settle();
  EXPECT_EQ(objectAt(session->objects(), at.x, at.y), nullptr);
}

TEST_F(Selection, ATargetAReceiverAndAPlatformAreDrawnAndFound) {
  for (const char* what : {"target", "receiver", "platform"}) {
    perform(Json{{"do", "add"}, {"what", what}, {"latitude_deg", 52.02}, {"longitude_deg", 4.97}}.dump());
    settle();
    const std::string added = session->selected();
    const render::Projected at = pixelOf(*session, added);
    const SceneObject* const found = objectAt(session->objects(), at.x, at.y);
    ASSERT_NE(found, nullptr) << what;
    EXPECT_EQ(found->path, added);
    EXPECT_TRUE(found->pixel) << "a symbol";
    perform(R"({"do":"revert"})");
    settle();
  }
}

TEST_F(Selection, ItsPositionIsCopiedAndLookedAt) {
  perform(R"({"do":"copy_position"})");
  EXPECT_EQ(error(), "nothing is selected");
  perform(R"({"do":"copy_position","path":"emitters.radar"})");
  EXPECT_THAT(window.clipboard, StartsWith("52.00000°N 5.00000°E"));
  perform(R"({"do":"focus","path":"platforms.nowhere"})");
  EXPECT_EQ(error(), "there is no 'platforms.nowhere' in the picture");
  perform(R"({"do":"focus","path":")" + session->objects().back().path + R"("})");
  settle();
  const render::Projected at = pixelOf(*session, session->objects().back().path);
  EXPECT_NEAR(at.y, 180, 40);
}

using Measuring = Pictured;

TEST_F(Measuring, TwoPositionsGiveDistanceBearingAndSight) {
  perform(
      R"({"do":"measure","from_latitude_deg":52,"from_longitude_deg":5,"to_latitude_deg":52.02,"to_longitude_deg":5})");
  EXPECT_EQ(error(), "");
  const Json report = session->report();
  EXPECT_EQ(report["tool"], "measure");
  EXPECT_NEAR(report["measured_m"].get<double>(), 2225.4, 0.5) << "along the meridian";
  EXPECT_NEAR(report["measured_bearing_deg"].get<double>(), 0, 1e-6);
  EXPECT_TRUE(report["measured_in_sight"].get<bool>());
  perform(
      R"({"do":"measure","from_latitude_deg":52,"from_longitude_deg":5,"to_latitude_deg":53,"to_longitude_deg":5})");
  EXPECT_FALSE(session->report()["measured_in_sight"].get<bool>()) << "the earth's bulge";
  EXPECT_THAT(verdictOf(*session->tool().measurement, Units::metric),
              StartsWith("Not in sight: the earth's bulge"));
}

TEST_F(Measuring, PixelsAddPointsAndAThirdBeginsAnew) {
  const render::Projected at = pixelOf(*session, "emitters.radar");
  const auto click = [&](double x, double y) {
    session->perform({"measure", {{"x", x}, {"y", y}}});
    return error();
  };
  EXPECT_EQ(click(at.x, at.y), "");
  ASSERT_EQ(session->tool().points.size(), 1U);
  EXPECT_NEAR(session->tool().points[0].end.height_msl_m, session->objectOf("emitters.radar")->height_msl_m,
              1e-6)
      << "an object is measured where it is";
  EXPECT_EQ(click(at.x + 20, at.y + 3), "");
  ASSERT_TRUE(session->tool().measurement);
  EXPECT_GT(session->tool().measurement->distance_m, 100);
  EXPECT_EQ(click(at.x, at.y), "");
  EXPECT_FALSE(session->tool().measurement);
  EXPECT_EQ(click(-500, -500), "measure: there is no ground");
}

TEST_F(Measuring, BackEndsIt) {
  perform(R"({"do":"measure"})");
  EXPECT_EQ(session->report()["tool"], "measure");
  perform(R"({"do":"back"})");
  EXPECT_EQ(session->report()["tool"], "none");
  perform(R"({"do":"measure"})");
  perform(R"({"do":"measure"})");
  EXPECT_EQ(session->report()["tool"], "none");
}

TEST_F(Measuring, IncompletePositionsAreRefused) {
  perform(R"({"do":"measure","from_latitude_deg":52,"from_longitude_deg":5})");
  EXPECT_EQ(error(), "measure: expected x and y, or the positions of both ends");
}

TEST(Tracks, NeedAPlatformAndTwoPoints) {
  SessionSample sample("quick.yaml");
  sample.perform(R"({"do":"draw_track"})");
  EXPECT_EQ(sample.error(), "draw_track: expected platform first");
  sample.perform(R"({"do":"draw_track","platform":"nobody"})");
  EXPECT_THAT(sample.error(), HasSubstr("there is no"));
  const std::string platform = sample->scenario()->platforms.front().name;
  sample.perform(R"({"do":"draw_track","platform":")" + platform + R"("})");
  EXPECT_EQ(sample->report()["tool"], "track");
  sample.perform(R"({"do":"draw_track"})");
  EXPECT_EQ(sample.error(), "a track has at least two points; click them in the picture");
}

TEST_F(Pictured, ATrackThatIsRefusedKeepsItsPoints) {
  const render::Projected at = pixelOf(*session, "emitters.radar");
  perform(R"({"do":"draw_track","platform":"mast"})");
  for (int i = 0; i < 2; ++i) session->perform({"draw_track", {{"x", at.x}, {"y", at.y}}});
  EXPECT_EQ(error(), "");
  perform(R"({"do":"draw_track"})");
  EXPECT_EQ(error(), "points 1 and 2 of the track are the same");
  EXPECT_EQ(session->tool().points.size(), 2U);
}

using Cursor = Pictured;

TEST_F(Cursor, ValueIsReadWithoutThePanelOfTheProbe) {
  const render::Projected at = pixelOf(*session, "emitters.radar");
  session->cursor().hover(at);
  waitUntil([this] { return session->report().contains("cursor_text"); });
  EXPECT_NEAR(session->report()["cursor_latitude_deg"].get<double>(), 52, 0.2);
  EXPECT_FALSE(session->prober().isOn());
  EXPECT_TRUE(session->cursor().result()->reading->emitters.empty()) << "no explanation: it is cheap";
  session->cursor().hover(std::nullopt);
  EXPECT_FALSE(session->report().contains("cursor_text")) << "outside the picture";
}

TEST(Projection, ChangesByNameAndToTheOther) {
  SessionSample sample("quick.yaml");
  sample.perform(R"({"do":"projection"})");
  EXPECT_EQ(sample->report()["orthographic"], true);
  sample.perform(R"({"do":"projection","projection":"orthographic"})");
  EXPECT_EQ(sample->report()["orthographic"], true);
  sample.perform(R"({"do":"projection"})");
  EXPECT_EQ(sample->report()["orthographic"], false);
}

}  // namespace
}  // namespace emscape::view::test
