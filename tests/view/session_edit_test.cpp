#include "apps/view/session/platform_drag.h"
#include "apps/view/values/edit_text.h"
#include "apps/view/values/shown_quantity.h"
#include "emscape/scenario/file/scenario_file.h"
#include "playback/editing/pick.h"
#include "tests/view/session_sample.h"

namespace emscape::view::test {
namespace {

using testing::HasSubstr;

const scenario::SitePosition& positionOf(const Session& session, std::size_t platform) {
  return session.scenario()->platforms[platform].track.front().position;
}

TEST(SessionEdits, AreMadeRefusedUndoneAndRedone) {
  SessionSample sample("quick.yaml");
  sample.perform(R"({"do":"set","path":"emitters.radar.power_w","value":"5"})");
  EXPECT_EQ(sample->scenario()->emitters[0].power_w, 5);
  EXPECT_FALSE(sample->rejection());
  sample.perform(R"({"do":"set","path":"emitters.radar.power_w","value":"-5"})");
  EXPECT_EQ(sample->scenario()->emitters[0].power_w, 5);
  EXPECT_THAT(sample.error(), HasSubstr("power is -5"));
  ASSERT_TRUE(sample->rejection());
  EXPECT_EQ(sample->rejection()->edits.front().path, "emitters.radar.power_w");
  sample.perform(R"({"do":"undo"})");
  EXPECT_EQ(sample->scenario()->emitters[0].power_w, 10000);
  sample.perform(R"({"do":"redo"})");
  EXPECT_EQ(sample->scenario()->emitters[0].power_w, 5);
}

TEST(SessionEdits, SeveralInOneStep) {
  SessionSample sample("quick.yaml");
  sample.perform(
      R"({"do":"set_together","edits":["emitters.radar.power_w=5","emitters.transmitter.power_w=6"]})");
  EXPECT_EQ(sample->scenario()->emitters[1].power_w, 6);
  sample.perform(R"({"do":"undo"})");
  EXPECT_EQ(sample->scenario()->emitters[0].power_w, 10000);
  EXPECT_EQ(sample->scenario()->emitters[1].power_w, 1000);
  sample.perform(R"({"do":"choose","path":"emitters.radar.antenna.pattern","value":"phased_array"})");
  EXPECT_EQ(sample.error(), "");
  EXPECT_EQ(sample->scenario()->edits().size(), 5U);
  sample.perform(R"({"do":"undo"})");
  EXPECT_EQ(sample->scenario()->edits().size(), 0U);
}

TEST(SessionEdits, ANewKeyOfASectionThatIsNotGivenIsAdded) {
  SessionSample sample("quick.yaml");
  sample.perform(R"({"do":"set","path":"atmosphere.k_factor","value":"1.6"})");
  EXPECT_EQ(sample->scenario()->atmosphere.k_factor, 1.6);
  sample.perform(R"({"do":"set","path":"emitters.transmitter.diffraction.method","value":"deygout"})");
  EXPECT_EQ(sample.error(), "");
  EXPECT_EQ(sample->scenario()->emitters[1].propagation.diffraction.method,
            propagation::DiffractionMethod::deygout);
}

TEST(SessionEdits, ItemsAreSwitchedAddedCopiedAndRemovedWithUndo) {
  SessionSample sample("quick.yaml");
  const auto& emitters = [&]() -> const std::vector<scenario::Emitter>& {
    return sample->scenario()->emitters;
  };
  EXPECT_EQ(sample.perform(R"({"do":"enable","emitter":"radar"})"), "");
  EXPECT_FALSE(emitters()[0].enabled);
  sample.perform(R"({"do":"enable","emitter":"radar"})");
  EXPECT_TRUE(emitters()[0].enabled);
  EXPECT_TRUE(sample->scenario()->edits().empty());
  EXPECT_EQ(
      sample.perform(R"({"do":"add","what":"jammer","name":"noise","latitude_deg":52,"longitude_deg":5.01})"),
      "");
  ASSERT_EQ(emitters().size(), 3U);
  EXPECT_EQ(sample->scenario()->platforms.size(), 3U);
  EXPECT_EQ(sample.perform(R"({"do":"duplicate","path":"emitters.noise"})"), "");
  EXPECT_EQ(emitters().back().name, "noise 2");
  EXPECT_EQ(sample.perform(R"({"do":"remove","path":"emitters.noise"})"), "");
  EXPECT_EQ(emitters().size(), 3U);
  EXPECT_THAT(sample.perform(R"({"do":"remove","path":"platforms.noise"})"), HasSubstr("carries 'noise 2'"));
  sample.perform(R"({"do":"undo"})");
  sample.perform(R"({"do":"undo"})");
  sample.perform(R"({"do":"undo"})");
  EXPECT_EQ(emitters().size(), 2U);
  sample.perform(R"({"do":"track","platform":"mast","points":["52,5","52.01,5.01,70"],"speed_m_s":100})");
  EXPECT_EQ(sample->scenario()->platforms[1].track.size(), 2U);
  EXPECT_THAT(sample.perform(R"({"do":"track","platform":"mast","points":["52,5","52"]})"),
              HasSubstr("point '52': expected LAT,LON"));
}

TEST(SessionEdits, WhatWasAddedTogetherIsTakenBackTogether) {
  SessionSample sample("quick.yaml");
  const auto add = [&] {
    EXPECT_EQ(sample.perform(R"({"do":"add","what":"radar","latitude_deg":52,"longitude_deg":5.01})"), "");
    const std::vector<std::string> texts = editTexts(*sample->original(), sample->scenario()->edits());
    EXPECT_THAT(texts, testing::ElementsAre("platform new radar: added", "emitter new radar: added"));
  };
  for (const char* path : {"platforms.new radar", "emitters.new radar"}) {
    add();
    EXPECT_EQ(sample.perform(Json{{"do", "revert"}, {"path", path}}.dump()), "") << path;
    EXPECT_EQ(sample->scenario()->edits(), std::vector<scenario::Edit>()) << path;
    sample.perform(R"({"do":"undo"})");
    EXPECT_EQ(sample->scenario()->edits().size(), 2U) << "one step";
    sample.perform(R"({"do":"undo"})");
    EXPECT_EQ(sample->scenario()->edits().size(), 0U);
  }
  for (const char* path : {"platforms.new radar", "emitters.new radar"}) {
    add();
    sample.perform(R"({"do":"set","path":"platforms.new radar.name","value":"hill"})");
    sample.perform(R"({"do":"set","path":"emitters.new radar.name","value":"eye"})");
    EXPECT_EQ(sample.perform(Json{{"do", "revert"}, {"path", path}}.dump()), "") << path;
    EXPECT_EQ(sample->scenario()->edits(), std::vector<scenario::Edit>()) << path << ", renamed";
  }
  // A platform that carries more, also from elsewhere, stays or takes it along.
  add();
  sample.perform(R"({"do":"set","path":"emitters.transmitter.platform","value":"new radar"})");
  EXPECT_EQ(sample.perform(R"({"do":"revert","path":"emitters.new radar"})"), "");
  EXPECT_EQ(sample->scenario()->edits().size(), 2U);
  EXPECT_EQ(sample.perform(R"({"do":"revert","path":"platforms.new radar"})"), "");
  EXPECT_EQ(sample->scenario()->edits().size(), 0U);
}

TEST(SessionEdits, ANewNameComputesNothingAndIsFollowed) {
  SessionSample session("quick.yaml");
  const std::string channel = "snr_db:radar";
  session.perform(
      R"({"do":"set_together","edits":["output.quantities=[snr_db]","output.combine=per_emitter"]})");
  session.perform(R"({"do":"quantity","name":")" + channel + "\"}");
  session.perform(R"({"do":"select","path":"emitters.radar"})");
  session.perform(R"({"do":"follow","name":"radar site"})");
  session.perform(R"({"do":"range_rings","rings":["radar:spacing_m=2000,count=3"]})");
  session.settle();
  const auto before = session->picture()->volume.dense();
  session.perform(R"({"do":"set","path":"emitters.radar.name","value":"eye"})");
  session.perform(R"({"do":"set","path":"platforms.radar site.name","value":"hill"})");
  session.settle();
  EXPECT_EQ(session.error(), "");
  EXPECT_EQ(session->picture()->volume.dense(), before) << "not computed again";
  EXPECT_EQ(session->selected(), "emitters.eye");
  EXPECT_EQ(session->view().quantity, "snr_db:eye");
  EXPECT_EQ(session->picture()->info().quantity, "snr_db:eye");
  EXPECT_EQ(session->view().follow, "hill");
  EXPECT_EQ(session->view().range_rings.front().emitter, "eye");
  session.perform(R"({"do":"undo"})");
  session.perform(R"({"do":"undo"})");
  session.settle();
  EXPECT_EQ(session->selected(), "emitters.radar");
  EXPECT_EQ(session->view().quantity, channel);
}

TEST(SessionEdits, RangeRingsOfARemovedEmitterEnd) {
  SessionSample session("quick.yaml");
  session.perform(R"({"do":"range_rings","rings":["radar:spacing_m=2000","transmitter:spacing_m=3000"]})");
  session.perform(R"({"do":"remove","path":"emitters.transmitter"})");
  session.settle();
  ASSERT_EQ(session->view().range_rings.size(), 1U);
  EXPECT_EQ(session->view().range_rings.front().emitter, "radar");
}

using playback::editedPaths;
using playback::editsWithout;
using playback::foldedEdits;
using Edits = std::vector<scenario::Edit>;

TEST(RenamedItems, HaveTheirEditsUnderTheNewName) {
  EXPECT_THAT(editedPaths({{"emitters.radar.power_w", "5"},
                           {"emitters.radar.name", "\"a.b\""},
                           {"emitters.\"a.b\".losses_db", "2"},
                           {"name", "x"}}),
              testing::ElementsAre("emitters.\"a.b\".losses_db", "emitters.\"a.b\".name",
                                   "emitters.\"a.b\".power_w", "name"));
}

TEST(RenamedItems, RenamesInARowAreOneEdit) {
  EXPECT_EQ(foldedEdits({{"emitters.a.name", "b"}, {"emitters.b.power_w", "5"}, {"emitters.b.name", "c"}}),
            (Edits{{"emitters.a.name", "c"}, {"emitters.c.power_w", "5"}}));
  EXPECT_EQ(foldedEdits({{"platforms.p.name", "q"},
                         {"emitters.a.platform", "q"},
                         {"platforms.q.name", "r"},
                         {"emitters.a.platform", "r"}}),
            (Edits{{"platforms.p.name", "r"}, {"emitters.a.platform", "r"}}));
  EXPECT_EQ(foldedEdits({{"emitters.a.name", "b"}, {"emitters.b.power_w", "5"}, {"emitters.b.name", "a"}}),
            (Edits{{"emitters.a.power_w", "5"}}));
  const Edits of_another{{"emitters.a.name", "b"}, {"emitters.b", "null"}, {"emitters.c.name", "b"}};
  EXPECT_EQ(foldedEdits(of_another), of_another);
  const Edits name_that_was_free{
      {"emitters.a.name", "b"}, {"emitters.c.name", "d"}, {"emitters.b.name", "c"}};
  EXPECT_EQ(foldedEdits(name_that_was_free), name_that_was_free) << "another one had it before";
}

TEST(RenamedItems, OtherEditsStayWithoutARename) {
  const Edits edits{{"emitters.a.name", "b"}, {"emitters.b.power_w", "5"}, {"emitters.b.name", "c"}};
  EXPECT_EQ(editsWithout(edits, "emitters.a.name"), (Edits{{"emitters.a.power_w", "5"}}));
  EXPECT_EQ(editsWithout(edits, "emitters.c.power_w"), (Edits{{"emitters.a.name", "c"}}));
  EXPECT_EQ(editsWithout(edits, "emitters.c"), Edits{});
  EXPECT_EQ(editsWithout({{"platforms.p.name", "q"}, {"emitters.a.platform", "q"}}, "platforms.p.name"),
            Edits{});
}

TEST(SessionEdits, SeveralNamesInARowAreOneChangeEverywhere) {
  SessionSample sample("quick.yaml");
  std::string path = "emitters.radar";
  for (const char* name : {"Вышка", "a: [b", "say \"x\" 'y' #z", "a.b", "Север 12"}) {
    const std::string quoted = Json(name).dump();
    sample.perform(Json{{"do", "set"}, {"path", path + ".name"}, {"value", quoted}}.dump());
    sample.settle();
    path = "emitters." + scenario::pathStep(name);
  }
  EXPECT_EQ(sample->scenario()->edits(), (Edits{{"emitters.radar.name", "\"Север 12\""}}));
  EXPECT_EQ(scenario::changeCountOf(*sample->scenario()), "1 value changed");
  EXPECT_EQ(sample->original()->edits(), Edits{});
  sample.perform(Json{{"do", "set"}, {"path", path + ".name"}, {"value", "radar"}}.dump());
  sample.settle();
  EXPECT_EQ(sample->scenario()->edits(), Edits{});
  EXPECT_FALSE(sample->hasUnsavedEdits());
}

TEST(SessionEdits, ARefusalsMessageEndsWithItsReason) {
  SessionSample sample("quick.yaml");
  sample.perform(R"({"do":"set","path":"emitters.radar.name","value":"transmitter"})");
  sample.settle();
  EXPECT_THAT(sample->notice().text, testing::HasSubstr("transmitter"));
  sample.perform(R"({"do":"set","path":"emitters.radar.name","value":"north"})");
  sample.settle();
  EXPECT_EQ(sample->notice().text, "");
  sample.perform(R"({"do":"recall","number":5})");
  EXPECT_THAT(sample->notice().text, testing::HasSubstr("bookmark 5"));
  sample.perform(R"({"do":"bookmark","number":5})");
  sample.perform(R"({"do":"recall","number":5})");
  EXPECT_THAT(sample->notice().text, testing::Not(testing::HasSubstr("empty")));
}

TEST(SessionEdits, RevertOfARenameKeepsTheOtherEdits) {
  SessionSample sample("quick.yaml");
  sample.perform(R"({"do":"set","path":"emitters.radar.name","value":"alpha"})");
  sample.perform(R"({"do":"set","path":"emitters.alpha.power_w","value":"5"})");
  sample.perform(R"({"do":"set","path":"emitters.alpha.name","value":"beta"})");
  EXPECT_EQ(sample->report()["edits"], 2);
  EXPECT_EQ(sample.perform(R"({"do":"revert","path":"emitters.radar.name"})"), "");
  EXPECT_EQ(sample->scenario()->emitters[0].name, "radar");
  EXPECT_EQ(sample->scenario()->emitters[0].power_w, 5);
}

TEST(SessionEdits, RevertTakesBackOneOrAllInOneStep) {
  SessionSample sample("quick.yaml");
  sample.perform(R"({"do":"set","path":"emitters.radar.power_w","value":"5"})");
  sample.perform(R"({"do":"set","path":"emitters.radar.losses_db","value":"1"})");
  sample.perform(R"({"do":"set","path":"emitters.transmitter.power_w","value":"6"})");
  EXPECT_EQ(sample.perform(R"({"do":"revert","path":"emitters.radar.power_w"})"), "");
  EXPECT_EQ(sample->scenario()->emitters[0].power_w, 10000);
  EXPECT_EQ(sample->scenario()->emitters[0].losses_db, 1);
  sample.perform(R"({"do":"undo"})");
  EXPECT_EQ(sample->scenario()->edits().size(), 3U);
  sample.perform(R"({"do":"revert","path":"emitters.radar"})");
  EXPECT_EQ(sample->scenario()->edits().size(), 1U);
  sample.perform(R"({"do":"revert"})");
  EXPECT_TRUE(sample->scenario()->edits().empty());
  sample.perform(R"({"do":"undo"})");
  EXPECT_EQ(sample->scenario()->emitters[1].power_w, 6);
}

TEST(SessionEdits, MovePutsAPlatformElsewhereInOneStep) {
  SessionSample sample("quick.yaml");
  sample.perform(R"({"do":"move","platform":"mast","latitude_deg":52.01,"longitude_deg":5.02})");
  EXPECT_EQ(positionOf(*sample, 1).latitude_deg, 52.01);
  EXPECT_EQ(positionOf(*sample, 1).longitude_deg, 5.02);
  EXPECT_EQ(positionOf(*sample, 1).height_agl_m, 50);
  sample.perform(R"({"do":"undo"})");
  EXPECT_EQ(positionOf(*sample, 1).latitude_deg, 52.05);
  sample.perform(R"({"do":"move","platform":"tower","latitude_deg":52,"longitude_deg":5})");
  EXPECT_EQ(sample.error(), "there is no platform 'tower'; the scenario has 'radar site', 'mast'");
  sample.perform(R"({"do":"move","platform":"mast","latitude_deg":95,"longitude_deg":5})");
  EXPECT_THAT(sample.error(), HasSubstr("latitude is 95"));
  EXPECT_EQ(positionOf(*sample, 1).latitude_deg, 52.05);
}

TEST(SessionEdits, TheShownQuantityFollowsTheScenarioUnlessItWasChosen) {
  SessionSample sample("quick.yaml");
  const auto shown = [&] { return sample->picture()->volume.info().quantity; };
  EXPECT_EQ(shown(), "power_density_dbwm2");
  sample.perform(R"({"do":"set","path":"output.quantities","value":"[field_strength_dbuvm]"})");
  sample.waitUntil([&] { return shown() == "field_strength_dbuvm"; });
  sample.perform(R"({"do":"undo"})");
  sample.waitUntil([&] { return shown() == "power_density_dbwm2"; });
  sample.perform(R"({"do":"quantity","name":"emitter_count"})");
  sample.waitUntil([&] { return shown() == "emitter_count"; });
  sample.perform(R"({"do":"set","path":"output.quantities","value":"[field_strength_dbuvm]"})");
  sample.settle();
  EXPECT_EQ(shown(), "emitter_count");
}

TEST(SessionEdits, AQuantityThatTheScenarioDoesNotHaveIsRefused) {
  SessionSample sample("quick.yaml");
  EXPECT_EQ(sample.perform(R"({"do":"quantity","name":"sinr_db"})"),
            "quantity 'sinr_db' needs an entry under 'receivers' without a platform");
  EXPECT_EQ(sample->view().quantity, "");
  EXPECT_THAT(sample.perform(R"({"do":"quantity","name":"foo"})"), HasSubstr("unknown quantity 'foo'"));
  EXPECT_EQ(sample.perform(R"({"do":"quantity","name":"snr_db:mast"})"),
            "quantity 'snr_db:mast': there is no such channel; there are snr_db");
  sample.perform(R"({"do":"seek","time_s":1})");
  sample.settle();
  EXPECT_EQ(sample->report()["shown_s"], 1);
  EXPECT_EQ(sample->viewState().quantity, "");
  const std::vector<std::string> offered = quantitiesOf(*sample->scenario());
  EXPECT_THAT(offered, testing::Contains("snr_db"));
  EXPECT_THAT(offered, testing::Each(testing::AllOf(testing::Not("sinr_db"), testing::Not("detection_age_s"),
                                                    testing::Not("jammer_to_signal_db"))));
}

TEST(SessionEdits, TheErrorOfAFieldGoesWithTheNextFieldThatSucceeds) {
  SessionSample sample("quick.yaml");
  sample.perform(R"({"do":"set_together","edits":["platforms.mast.position.height_agl_m=null",
    "platforms.mast.position.height_msl_m=-30"]})");
  ASSERT_TRUE(sample.waitUntil([&] { return sample->status().failed; }));
  EXPECT_THAT(sample.error(), HasSubstr("'mast' at t = 0 s"));
  sample.perform(R"({"do":"dolly","factor":0.9})");
  EXPECT_THAT(sample.error(), HasSubstr("'mast' at t = 0 s"));
  sample.perform(R"({"do":"undo"})");
  ASSERT_TRUE(sample.settle());
  EXPECT_EQ(sample.error(), "");
}

TEST(SessionEdits, AnEditThatTakesTheShownQuantityAwayShowsTheFirstOne) {
  SessionSample sample("quick.yaml");
  const auto shown = [&] { return sample->picture()->volume.info().quantity; };
  sample.perform(R"({"do":"set_together","edits":[
    "receivers=[{name: rx, gain_dbi: 0, noise_figure_db: 5, bandwidth_hz: 1000000}]",
    "output.receiver=rx", "output.wanted_emitter=transmitter"]})");
  ASSERT_EQ(sample.error(), "");
  EXPECT_THAT(quantitiesOf(*sample->scenario()), testing::Contains("sinr_db"));
  sample.perform(R"({"do":"quantity","name":"sinr_db"})");
  sample.settle();
  ASSERT_EQ(shown(), "sinr_db");
  sample.perform(R"({"do":"undo"})");
  sample.settle();
  EXPECT_EQ(sample.error(),
            "quantity 'sinr_db' needs an entry under 'receivers' without a platform; power_density_dbwm2 is "
            "shown instead");
  EXPECT_EQ(shown(), "power_density_dbwm2");
  EXPECT_EQ(sample->viewState().quantity, "");
  sample.perform(R"({"do":"seek","time_s":2})");
  sample.settle();
  EXPECT_EQ(sample->report()["shown_s"], 2);
}

/// The pixel of an emitter's marker.
render::Projected pixelOf(const Session& session, std::size_t emitter) {
  const playback::LivePicture& picture = *session.picture();
  return render::project(picture.camera, picture.size,
                         picture.box.toDrawn(picture.annotations.markers[emitter].position_m));
}

TEST(PlatformDrag, SLOW_FollowsTheCursorOverTheGround) {
  SessionSample sample("jacksboro.yaml", {{"region.dims", "[40, 40, 20]"}});
  const std::size_t mast = 2;
  for (int i = 0; i < 3; ++i) {
    const render::Projected from = pixelOf(*sample, mast);
    const playback::LivePicture picture = *sample->picture();
    const SceneObject* object = objectAt(sample->objects(), from.x + 2, from.y - 2);
    ASSERT_NE(object, nullptr);
    EXPECT_EQ(object->path, "emitters.communications mast");
    PlatformDrag drag(picture, *object, from.x + 2, from.y - 2);
    EXPECT_EQ(drag.object().path, "emitters.communications mast");
    for (int step = 1; step <= 4; ++step) {
      const auto edits = drag.moveTo(picture, from.x + 2 + 4 * step, from.y - 2 + step);
      ASSERT_TRUE(edits);
      sample->drag(*edits);
    }
    sample->endDrag();
    sample.settle();
    const render::Projected to = pixelOf(*sample, mast);
    EXPECT_NEAR(to.x, from.x + 16, 1.5);
    EXPECT_NEAR(to.y, from.y + 4, 2.5);
    EXPECT_EQ(*sample->scenario()->platforms[2].track.front().position.height_agl_m, 40);
    sample.perform(R"({"do":"undo"})");
    sample.settle();
    EXPECT_EQ(sample->scenario()->edits().size(), 1U);
  }
  // What is above the ground is beside the picture's middle; the sky holds no ground.
  const render::Projected from = pixelOf(*sample, mast);
  PlatformDrag drag(*sample->picture(), sample->objects()[mast], from.x, from.y);
  EXPECT_FALSE(drag.moveTo(*sample->picture(), from.x, -500));
}

TEST(SessionFocus, LooksAtTheGroundUnderAPixel) {
  SessionSample sample("jacksboro.yaml", {{"region.dims", "[40, 40, 20]"}});
  const playback::LivePicture picture = *sample->picture();
  ASSERT_TRUE(picture.ground);
  const auto ground_m =
      playback::pickGround(picture.camera, picture.box, picture.size, 100, 110, *picture.ground);
  ASSERT_TRUE(ground_m);
  sample.perform(R"({"do":"focus","x":100,"y":110})");
  ASSERT_TRUE(sample->camera().spec().target_m);
  EXPECT_LT(length(*sample->camera().spec().target_m - *ground_m), 1e-6);
  EXPECT_LE(*sample->camera().spec().distance, 0.45);
}

TEST(SessionFocus, LooksAtEmittersThatAreHidden) {
  SessionSample sample("quick.yaml");
  const Vec3d radar_m = sample->picture()->annotations.markers[0].position_m;
  sample.perform(R"({"do":"emitters","on":false})");
  sample.settle();
  ASSERT_TRUE(sample->picture()->annotations.markers.empty());
  EXPECT_EQ(sample.perform(R"({"do":"focus","emitter":"radar"})"), "");
  ASSERT_TRUE(sample->camera().spec().target_m);
  EXPECT_LT(length(*sample->camera().spec().target_m - radar_m), 1e-6);
  sample.perform(R"({"do":"focus"})");
  EXPECT_EQ(sample->notice().text, "transmitter");
  EXPECT_EQ(sample.perform(R"({"do":"focus","emitter":"nobody"})"),
            "there is no emitter 'nobody'; the scenario has 'radar', 'transmitter'");
}

TEST(SessionFocus, RefusesIncompatibleArguments) {
  SessionSample sample("quick.yaml");
  EXPECT_EQ(sample.perform(R"({"do":"focus","x":3})"), "focus: expected x and y, emitter, or path");
  EXPECT_EQ(sample.perform(R"({"do":"focus","x":3,"y":3,"emitter":"radar"})"),
            "focus: expected x and y, emitter, or path");
  EXPECT_FALSE(sample->camera().spec().target_m);
}

TEST(PlatformDrag, IsRefusedForMovingPlatforms) {
  SessionSample sample("jacksboro.yaml", {{"region.dims", "[40, 40, 20]"}});
  const std::string error = errorOf([&] { PlatformDrag(*sample->picture(), sample->objects()[3], 0, 0); });
  EXPECT_THAT(error, HasSubstr("'helicopter' cannot be put elsewhere: it moves along"));
  EXPECT_THAT(error, HasSubstr("helicopter.csv"));
}

}  // namespace
}  // namespace emscape::view::test
