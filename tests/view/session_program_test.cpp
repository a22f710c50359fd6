#include "apps/view/parts/program_state.h"
#include "tests/view/session_sample.h"

namespace emscape::view::test {
namespace {

using testing::HasSubstr;

playback::LiveStatus settledStatus() {
  playback::LiveStatus status;
  status.exact = true;
  return status;
}

ProgramFacts shownFacts() {
  ProgramFacts facts;
  facts.has_input = facts.has_picture = facts.has_field = true;
  return facts;
}

TEST(ProgramState, SaysWhatIsComputedAndHowFarItIs) {
  playback::LiveStatus status = settledStatus();
  ProgramFacts facts = shownFacts();
  EXPECT_EQ(programState(facts, status).badge, "IDLE");
  EXPECT_EQ(programState(facts, status).picture, "exact, full rays");
  status.computing = true;
  status.exact = false;
  status.progress = {"power_density_dbwm2 at 3 s", "'radar' by itm, 1 of 2", 0.423};
  EXPECT_EQ(programState(facts, status).badge, "COMPUTING");
  EXPECT_EQ(programState(facts, status).what, "") << "short ones are not explained";
  facts.computing_s = 1;
  const ProgramState state = programState(facts, status);
  EXPECT_EQ(state.badge, "COMPUTING 42 %");
  EXPECT_EQ(state.what, "Power density at 3 s: 'radar' by itm, 1 of 2");
  EXPECT_EQ(state.picture, "the picture shows the field before");
  EXPECT_TRUE(state.can_cancel);
}

TEST(ProgramState, IsBusyWhileColumnsOfTheFieldAreInterpolated) {
  playback::LiveStatus status = settledStatus();
  status.exact = false;
  status.column_step = 2;
  EXPECT_EQ(programState(shownFacts(), status).badge, "BUSY");
  EXPECT_EQ(programState(shownFacts(), status).picture, "approximate, field in every second column");
  status.computing = true;
  EXPECT_EQ(programState(shownFacts(), status).badge, "BUSY") << "the next one moves, too";
  ProgramFacts edited = shownFacts();
  edited.has_pending_edits = true;
  EXPECT_EQ(programState(edited, status).badge, "COMPUTING");
}

TEST(ProgramState, IsNeverIdleWithWorkLeft) {
  const ProgramFacts shown = shownFacts();
  ProgramFacts pending = shown, plays = shown, opens = shown, first = shown;
  pending.has_pending_edits = true;
  EXPECT_EQ(programState(pending, settledStatus()).activity, Activity::computing);
  plays.is_playing = true;
  playback::LiveStatus playing = settledStatus();
  playing.fields_per_s = 3.14;
  EXPECT_EQ(programState(plays, playing).badge, "PLAYING");
  EXPECT_EQ(programState(plays, playing).what, "× 1, 3.1 fields/s");
  opens.opening = OpeningProgress{"b.yaml", {"opening", "reading the terrain", 0.2}};
  EXPECT_EQ(programState(opens, settledStatus()).badge, "OPENING 20 %");
  EXPECT_EQ(programState(opens, settledStatus()).what, "b.yaml: opening: reading the terrain");
  EXPECT_TRUE(programState(opens, settledStatus()).can_cancel);
  first.has_picture = false;
  EXPECT_EQ(programState(first, {}).activity, Activity::opening);
  EXPECT_TRUE(programState(first, {}).can_cancel);
  first.has_picture = true;
  first.has_field = false;
  playback::LiveStatus computing;
  computing.computing = true;
  EXPECT_EQ(programState(first, computing).activity, Activity::opening) << "up to the first field";
  EXPECT_EQ(programState(first, computing).picture, "without the field");
  EXPECT_EQ(programState(first, settledStatus()).activity, Activity::idle) << "the field was cancelled";
  EXPECT_EQ(programState({}, {}).badge, "EMPTY");
  playback::LiveStatus status;
  EXPECT_EQ(programState(shown, status).activity, Activity::restore) << "not exact yet";
  status = settledStatus();
  status.searching = true;
  EXPECT_EQ(programState(shown, status).activity, Activity::computing);
  EXPECT_FALSE(programState(shown, status).can_cancel);
}

class SessionProgram : public SessionTest {
 protected:
  /// Requests a field that takes long: the parabolic equation over a large region.
  void computeForLong() {
    perform(R"({"do":"set_together","edits":["emitters.radar.propagation=parabolic_equation",
            "emitters.transmitter.propagation=parabolic_equation","region.size_m=[200000, 200000, 9000]",
            "region.dims=[200, 200, 100]"]})");
    waitUntil(
        [this] { return session->status().progress.part.find("parabolic equation") != std::string::npos; });
  }
};

TEST_F(SessionProgram, ComputesFromTheCommandOnUntilThePictureHoldsIt) {
  perform(R"({"do":"seek","time_s":3.3})");
  EXPECT_EQ(session->report()["program"], "COMPUTING");
  waitUntil([this] { return session->report()["program"] != "COMPUTING"; });
  EXPECT_EQ(session->status().shown_s, 3.3);
  perform(R"({"do":"quantity","name":"field_strength_dbuvm"})");
  EXPECT_TRUE(session->status().computing);
  EXPECT_EQ(session->picture()->info().quantity, "power_density_dbwm2") << "so is the legend";
  waitUntil([this] { return session->report()["program"] != "COMPUTING"; });
  EXPECT_EQ(session->picture()->info().quantity, "field_strength_dbuvm");
  EXPECT_FALSE(session->status().computing);
}

TEST_F(SessionProgram, CancelGoesBackToWhatThePictureShows) {
  const auto before = session->scenario();
  const auto pixels = session->picture()->image.rgba;
  computeForLong();
  EXPECT_EQ(session->report()["program"], "COMPUTING");
  perform(R"({"do":"cancel"})");
  EXPECT_EQ(error(), "");
  EXPECT_THAT(session->notice().text, HasSubstr("cancelled"));
  settle();
  EXPECT_EQ(session->scenario(), before);
  EXPECT_TRUE(session->picture()->image.rgba == pixels);
  EXPECT_TRUE(session->canRedo()) << "the edit can be made again";
  EXPECT_EQ(session->status().fields_computed, 1);
  EXPECT_EQ(session->status().fields_abandoned, 1);
  perform(R"({"do":"cancel"})");
  EXPECT_EQ(error(), "cancel: nothing is being computed or opened");
}

TEST(SessionOpening, ShowsTheGroundFirstAndCanBeCancelled) {
  ViewOptions options = optionsFor(shippedScenario("quick.yaml"), {160, 120});
  options.view.edits = {{"emitters.radar.propagation", "parabolic_equation"},
                        {"region.size_m", "[200000, 200000, 9000]"},
                        {"region.dims", "[200, 200, 100]"}};
  SessionSample sample(options);
  EXPECT_EQ(sample->report()["program"], "OPENING");
  sample.waitUntil([&] { return sample->picture() != nullptr; });
  EXPECT_FALSE(sample->hasField());
  EXPECT_EQ(sample->objects().size(), 4U) << "they can be selected";
  EXPECT_EQ(sample->transfer(), nullptr);
  EXPECT_EQ(sample->report()["program"], "OPENING");
  EXPECT_EQ(sample.perform(R"({"do":"cancel"})"), "");
  sample.waitUntil([&] { return sample->settled(); });
  EXPECT_EQ(sample->report()["program"], "IDLE");
  EXPECT_EQ(sample->programState().picture, "without the field");
  EXPECT_EQ(sample->status().fields_computed, 0);
  EXPECT_EQ(sample.perform(R"({"do":"choose","path":"emitters.radar.propagation","value":"free_space"})"),
            "");
  sample.settle();
  EXPECT_TRUE(sample->hasField());
  EXPECT_NE(sample->transfer(), nullptr);
}

TEST_F(SessionProgram, AnUndoneFieldIsAbandonedAndNeverShown) {
  computeForLong();
  perform(R"({"do":"undo"})");
  settle();
  EXPECT_EQ(session->status().fields_computed, 1);
  EXPECT_EQ(session->picture()->grid().dims, (Dims{40, 40, 20}));
}

TEST_F(SessionProgram, CancelledTimesAndQuantitiesReturn) {
  perform(R"({"do":"set_together","edits":["region.size_m=[200000, 200000, 9000]"]})");
  settle();
  perform(R"({"do":"quantity","name":"field_strength_dbuvm"})");
  perform(R"({"do":"seek","time_s":2})");
  if (!session->status().computing) GTEST_SKIP() << "computed already";
  perform(R"({"do":"back"})");
  settle();
  EXPECT_EQ(session->picture()->info().quantity, "power_density_dbwm2");
  EXPECT_EQ(session->timeline().asked_s(), 0);
}

TEST_F(SessionProgram, FollowsPlatformsByTheirNameOrThatOfAnEmitter) {
  perform(R"({"do":"follow","name":"radar","mode":"chase"})");
  EXPECT_EQ(session->view().follow, "radar site");
  EXPECT_EQ(session->notice().text, "the camera chases radar site");
  perform(R"({"do":"follow"})");
  EXPECT_EQ(session->report()["following"], "");
  perform(R"({"do":"follow"})");
  EXPECT_EQ(session->report()["following"], "radar site");
  perform(R"({"do":"follow","mode":"off"})");
  EXPECT_EQ(session->report()["following"], "");
  perform(R"({"do":"follow","name":"nobody"})");
  EXPECT_THAT(error(), HasSubstr("follow: there is no platform 'nobody'; there are radar site, mast"));
  EXPECT_FALSE(session->perform({"follow", {{"platform", "mast"}}}));
  EXPECT_EQ(error(), "follow: unknown argument 'platform'");
  perform(R"({"do":"trail","seconds":20})");
  EXPECT_EQ(session->report()["trail"], 20);
}

TEST_F(SessionProgram, TheCameraStaysWhereItFollowedAPlatform) {
  perform(R"({"do":"follow","name":"mast","mode":"chase"})");
  settle();
  const render::Camera followed = session->picture()->camera;
  perform(R"({"do":"follow","mode":"off"})");
  settle();
  EXPECT_NEAR(length(session->picture()->camera.eye_m - followed.eye_m), 0, 1e-6);
  perform(R"({"do":"follow","name":"mast"})");
  perform(R"({"do":"focus","emitter":"radar"})");
  EXPECT_EQ(session->report()["following"], "") << "it looks at the radar";
}

TEST_F(SessionProgram, CancelWithinADragTakesTheDragBack) {
  const auto before = session->scenario();
  session->drag({{"emitters.radar.power_w", "7"}});
  waitUntil([&] { return session->scenario() != before; });
  session->drag({{"region.size_m", "[400000, 400000, 9000]"}});
  if (session->report()["program"] == "COMPUTING") {
    perform(R"({"do":"cancel"})");
  }
  session->endDrag();
  settle();
  perform(R"({"do":"set","path":"emitters.radar.losses_db","value":"3"})");
  settle();
  perform(R"({"do":"undo"})");
  settle();
  EXPECT_FALSE(session->canUndo()) << "the edit after the cancelled drag is one step, and the only one";
  EXPECT_EQ(session->scenario(), before);
}

}  // namespace
}  // namespace emscape::view::test
