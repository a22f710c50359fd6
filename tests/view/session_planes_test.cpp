/// Cutting planes and comparison, as requested by keys, panels and scripts.
#include <set>

#include "apps/view/session/plane_drag.h"
#include "tests/view/session_sample.h"

namespace emscape::view::test {
namespace {

using Planes = SessionTest;

TEST_F(Planes, AreAddedMovedFlippedSwitchedAndRemoved) {
  perform(R"({"do":"plane","kind":"horizontal"})");
  perform(R"({"do":"plane","spec":"vertical:bearing_deg=30,keep=right"})");
  ASSERT_EQ(session->settings().planes.size(), 2U);
  EXPECT_EQ(session->settings().planes[0].altitude_m, 2500) << "the middle of the box";
  perform(R"({"do":"plane","index":1,"altitude_m":1200,"flip":true})");
  EXPECT_EQ(toString(session->settings().planes[0]), "horizontal:altitude_m=1200,keep=above");
  perform(R"({"do":"plane","offset_m":-500})");
  EXPECT_EQ(toString(session->settings().planes[1]), "vertical:bearing_deg=30,offset_m=-500,keep=right");
  EXPECT_EQ(session->report()["planes"], 2);
  perform(R"({"do":"plane"})");
  EXPECT_EQ(session->report()["planes"], 0) << "all off";
  perform(R"({"do":"plane","kind":"vertical"})");
  EXPECT_EQ(session->report()["planes"], 1) << "the first of its kind is on again";
  perform(R"({"do":"plane","index":1,"remove":true})");
  ASSERT_EQ(session->settings().planes.size(), 1U);
  settle();
  EXPECT_EQ(error(), "");
  EXPECT_EQ(session->picture()->settings.planes, session->settings().planes);
  EXPECT_EQ(session->viewState().settings.planes, session->settings().planes);
}

TEST_F(Planes, ErrorsAreReported) {
  perform(R"({"do":"plane","flip":true})");
  EXPECT_EQ(error(), "plane: there is no plane; `spec` or `kind` adds one");
  perform(R"({"do":"plane","kind":"slanted"})");
  EXPECT_EQ(error(), "plane: kind 'slanted': expected horizontal, vertical");
  perform(R"({"do":"plane","spec":"vertical"})");
  perform(R"({"do":"plane","index":2,"on":true})");
  EXPECT_EQ(error(), "plane: index 2: expected 1..1");
  for (int n = 0; n < 3; ++n) perform(R"({"do":"plane","spec":"vertical"})");
  EXPECT_EQ(error(), "plane: there are 3 already, which is the most");
  perform(R"({"do":"plane","index":1,"bearing_deg":1000})");
  EXPECT_EQ(error(), "plane: bearing_deg 1000: expected -360..360");
  EXPECT_EQ(session->settings().planes[0].bearing_deg, 0);
  perform(R"({"do":"plane","index":1,"altitude_m":1000})");
  EXPECT_EQ(error(), "plane: a vertical plane has no altitude_m");
}

TEST_F(Planes, ANewVerticalOneFacesTheViewer) {
  perform(R"({"do":"camera","spec":"orbit:azimuth_deg=180"})");
  const render::CutPlane plane = session->newPlane(render::CutPlane::Kind::vertical);
  EXPECT_EQ(plane.bearing_deg, 90) << "along the picture of a camera in the south";
  EXPECT_EQ(plane.keep, render::CutPlane::Side::left) << "the north";
  EXPECT_FALSE(plane.cuts_ground);
}

TEST_F(Planes, SwitchingOneOnOpensItsPanel) {
  ASSERT_FALSE(session->panels.planes);
  perform(R"({"do":"plane","kind":"horizontal"})");
  EXPECT_TRUE(session->panels.planes);
  perform(R"({"do":"panel","name":"planes","open":false})");
  perform(R"({"do":"plane","kind":"horizontal"})");
  EXPECT_FALSE(session->panels.planes) << "it is off";
}

TEST_F(Planes, HandleMovesAPlaneAlongItsNormalWithTheCursor) {
  session->setPictureSize({480, 360});
  perform(R"({"do":"plane","kind":"horizontal"})");
  settle();
  const auto handleOf = [&] { return planeHandle(*session->picture(), session->settings().planes[0]); };
  const auto before = handleOf();
  ASSERT_TRUE(before);
  ASSERT_EQ(planeHandleAt(*session, before->x + 3, before->y - 2), 0U);
  EXPECT_FALSE(planeHandleAt(*session, before->x + 30, before->y));
  const PlaneDrag drag(*session, 0, before->x + 3, before->y - 2);
  drag.moveTo(before->x + 3, before->y - 12, *session, true);
  EXPECT_GT(session->settings().planes[0].altitude_m, 2500);
  settle();
  EXPECT_NEAR(handleOf()->y, before->y - 10, 0.5);
  drag.moveTo(before->x, -10000, *session, false);
  EXPECT_EQ(session->settings().planes[0].altitude_m, 5000) << "the top of the box";
  drag.finish(*session);
  EXPECT_EQ(session->settings().planes[0].altitude_m, 5000);
  EXPECT_EQ(error(), "");
}

TEST_F(Planes, HandleIsMissingWhereThePlaneCannotBeMovedInThePicture) {
  perform(R"({"do":"plane","kind":"horizontal"})");
  perform(R"({"do":"camera","spec":"orbit:azimuth_deg=180,elevation_deg=90,projection=orthographic"})");
  settle();
  EXPECT_FALSE(planeHandle(*session->picture(), session->settings().planes[0]));
}

TEST_F(Planes, ADragOfOneIsOneUndoStep) {
  session->setPictureSize({480, 360});
  perform(R"({"do":"plane","kind":"horizontal"})");
  settle();
  const auto handle = planeHandle(*session->picture(), session->settings().planes[0]);
  ASSERT_TRUE(handle);
  const PlaneDrag drag(*session, 0, handle->x, handle->y);
  for (const int up_px : {4, 8, 12}) drag.moveTo(handle->x, handle->y - up_px, *session, up_px == 4);
  drag.finish(*session);
  const double dragged_m = session->settings().planes[0].altitude_m;
  ASSERT_GT(dragged_m, 2500);
  perform(R"({"do":"undo"})");
  EXPECT_EQ(session->settings().planes[0].altitude_m, 2500);
  perform(R"({"do":"undo"})");
  EXPECT_TRUE(session->settings().planes.empty());
  perform(R"({"do":"redo"})");
  perform(R"({"do":"redo"})");
  EXPECT_EQ(session->settings().planes[0].altitude_m, dragged_m);
  EXPECT_FALSE(session->canRedo());
}

TEST_F(Planes, ADragThatIsCancelledLeavesThePlaneWhereItWas) {
  session->setPictureSize({480, 360});
  perform(R"({"do":"plane","kind":"horizontal"})");
  settle();
  const auto handle = planeHandle(*session->picture(), session->settings().planes[0]);
  ASSERT_TRUE(handle);
  const PlaneDrag drag(*session, 0, handle->x, handle->y);
  drag.moveTo(handle->x, handle->y - 8, *session, true);
  ASSERT_GT(session->settings().planes[0].altitude_m, 2500);
  perform(R"({"do":"back"})");
  EXPECT_EQ(session->settings().planes[0].altitude_m, 2500);
  EXPECT_TRUE(session->panels.planes) << "back cancels the drag alone";
  drag.moveTo(handle->x, handle->y - 12, *session, false);
  EXPECT_EQ(session->settings().planes[0].altitude_m, 2500) << "the button is still held";
  perform(R"({"do":"undo"})");
  EXPECT_TRUE(session->settings().planes.empty()) << "the drag made no step";
}

using Map = SessionTest;

TEST_F(Map, LayerIsSwitchedAndKeepsItsHeight) {
  perform(R"({"do":"map_layer"})");
  EXPECT_EQ(session->report()["map_layer"], 100);
  perform(R"({"do":"map_layer","height_agl_m":250,"opacity":0.5})");
  perform(R"({"do":"map_layer"})");
  EXPECT_TRUE(session->report()["map_layer"].is_null());
  perform(R"({"do":"map_layer","opacity":0.75})");
  EXPECT_TRUE(session->report()["map_layer"].is_null()) << "opacity alone does not switch it";
  perform(R"({"do":"map_layer","on":true})");
  settle();
  EXPECT_EQ(session->picture()->settings.map_height_agl_m, 250);
  EXPECT_EQ(session->picture()->settings.map_opacity, 0.75);
  EXPECT_EQ(session->picture()->annotations.legend->map_note, "map: at 250 m above ground");
  perform(R"({"do":"reset_switches"})");
  EXPECT_TRUE(session->report()["map_layer"].is_null());
  EXPECT_EQ(error(), "");
  perform(R"({"do":"map_layer","height_agl_m":-1})");
  EXPECT_EQ(error(), "map_layer: height_agl_m -1: expected a number 0..100000");
}

using Split = SessionTest;

TEST_F(Split, ShowsTheFieldWithoutEditsAtTheLeft) {
  perform(R"({"do":"set","path":"emitters.radar.power_w","value":"100000"})");
  settle();
  const render::TransferFunction colors = session->picture()->transfer;
  perform(R"({"do":"split"})");
  settle();
  const auto& picture = *session->picture();
  EXPECT_EQ(picture.split_column, picture.size.width / 2);
  EXPECT_EQ(picture.transfer, colors);
  ASSERT_NE(picture.beside, nullptr);
  EXPECT_NE(picture.beside->values()->values, picture.values()->values);
  session->moveSplit(0.25 * picture.size.width);
  settle();
  EXPECT_EQ(session->report()["split"], 0.25);
  perform(R"({"do":"compare"})");
  settle();
  EXPECT_EQ(session->report()["quantity"], "power_density_difference_db");
  EXPECT_EQ(session->report()["split"], 0);
  perform(R"({"do":"split"})");
  settle();
  EXPECT_EQ(session->report()["quantity"], "power_density_dbwm2");
  EXPECT_EQ(session->report()["split"], 0.25) << "where it was";
  perform(R"({"do":"split"})");
  settle();
  EXPECT_EQ(session->picture()->split_column, 0);
  EXPECT_EQ(session->viewState().compare, "");
  EXPECT_EQ(error(), "");
}

TEST_F(Split, CursorReadsTheHalfUnderIt) {
  perform(R"({"do":"set","path":"emitters.radar.power_w","value":"100000"})");
  settle();
  session->cursor().turnOn(true);
  const double x = session->picture()->size.width * 0.45, y = session->picture()->size.height * 0.55;
  double nudge = 0;
  const auto valueUnderCursor = [&] {
    settle();
    session->cursor().hover(render::Projected{x + (nudge += 1e-3), y});
    waitUntil([&] { return !session->cursor().isBusy(); });
    const ProbeResult* const result = session->cursor().result();
    return result && result->reading ? result->reading->sample.value : 0.0F;
  };
  const float changed = valueUnderCursor();
  perform(R"({"do":"split","position":0.8})");
  const float original = valueUnderCursor();
  perform(R"({"do":"split","position":0.1})");
  EXPECT_NEAR(valueUnderCursor(), changed, 0.1);
  EXPECT_LT(original, changed);
}

TEST_F(Split, AReadingOfTheLeftHalfStaysOneWhenTheCursorLeaves) {
  perform(R"({"do":"set","path":"emitters.radar.power_w","value":"100000"})");
  settle();
  session->cursor().turnOn(true);
  perform(R"({"do":"split","position":0.8})");
  settle();
  const render::ImageSize size = session->picture()->size;
  session->cursor().hover(render::Projected{size.width * 0.45, size.height * 0.55});
  settle();
  waitUntil([&] { return !session->cursor().isBusy(); });
  const ProbeResult before = *session->cursor().result();
  ASSERT_TRUE(before.reading);
  EXPECT_TRUE(before.is_beside);
  session->cursor().hover(std::nullopt);
  perform(R"({"do":"set","path":"emitters.radar.power_w","value":"200000"})");
  settle();
  waitUntil([&] { return !session->cursor().isBusy(); });
  const ProbeResult& after = *session->cursor().result();
  ASSERT_TRUE(after.reading);
  EXPECT_TRUE(after.is_beside);
  EXPECT_EQ(after.reading->sample.value, before.reading->sample.value);
}

using Comparison = SessionTest;

TEST_F(Comparison, ShowsTheDifferenceWithColoursOfItsOwnAndTheFieldAgain) {
  const double before = session->picture()->transfer.lowest();
  perform(R"({"do":"set","path":"emitters.radar.power_w","value":"100000"})");
  perform(R"({"do":"compare"})");
  settle();
  EXPECT_EQ(session->report()["quantity"], "power_density_difference_db");
  EXPECT_EQ(session->picture()->transfer.lowest(), -session->picture()->transfer.highest());
  ASSERT_NE(session->transfer(), nullptr);
  EXPECT_EQ(session->transfer()->function().unit, "dB");
  EXPECT_EQ(session->viewState().compare, playback::kOriginal);
  perform(R"({"do":"compare","on":false})");
  settle();
  EXPECT_EQ(session->report()["quantity"], "power_density_dbwm2");
  EXPECT_LE(session->picture()->transfer.lowest(), before + 20);
  EXPECT_EQ(session->viewState().compare, "");
  EXPECT_EQ(error(), "");
}

TEST_F(Comparison, TheFieldHasItsColoursAgainAfterwards) {
  perform(R"({"do":"range","min":-77,"max":-33})");
  perform(R"({"do":"transfer","colors":"cividis"})");
  perform(R"({"do":"set","path":"emitters.radar.power_w","value":"100000"})");
  settle();
  const render::TransferFunction made = session->transfer()->function();
  perform(R"({"do":"compare"})");
  settle();
  perform(R"({"do":"range","min":-9,"max":9})");
  settle();
  perform(R"({"do":"compare"})");
  settle();
  EXPECT_EQ(session->transfer()->function(), made);
  EXPECT_EQ(session->picture()->transfer, made);
  EXPECT_TRUE(session->hasUnsavedColors());
  perform(R"({"do":"compare"})");
  settle();
  EXPECT_EQ(session->picture()->transfer.lowest(), -9);
}

TEST_F(Comparison, WarningsOfTheReferenceAreListedOnce) {
  perform(R"({"do":"compare"})");
  settle();
  const std::vector<std::string>& warnings = session->warnings();
  EXPECT_EQ(std::set<std::string>(warnings.begin(), warnings.end()).size(), warnings.size());
}

TEST_F(Comparison, UndefinedDifferenceIsReported) {
  perform(R"({"do":"quantity","name":"dominant_emitter"})");
  settle();
  perform(R"({"do":"compare"})");
  waitUntil([this] { return !error().empty(); });
  EXPECT_EQ(error(), "dominant_emitter: indices have no difference; compare another quantity");
  EXPECT_FALSE(session->compares());
  perform(R"({"do":"seek","time_s":1})");
  settle();
  EXPECT_EQ(session->report()["shown_s"], 1);
}

}  // namespace
}  // namespace emscape::view::test
