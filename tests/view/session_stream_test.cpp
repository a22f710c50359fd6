/// Battlefields of other programs in a session: live streams and recordings.
#include "apps/view/parts/opening.h"
#include "apps/view/session/session_opener.h"
#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/emfield/solver/field_solver.h"
#include "emscape/scenario/model/poses.h"
#include "emscape/scenario/terrain/terrain.h"
#include "playback/sockets/socket.h"
#include "playback/stream/acmi_server.h"
#include "recording/dis/orientation.h"
#include "recording/dis/pdu.h"
#include "tests/support/ports.h"
#include "tests/view/session_sample.h"

namespace emscape::view::test {
namespace {

using testing::HasSubstr;

constexpr std::uint32_t kLocal = 0x7F000001;

/// A session on quick.yaml with a stream, and its sender.
class StreamTest : public testing::Test {
 protected:
  playback::StreamRequest request() const {
    playback::StreamRequest request;
    request.address = {kLocal, emscape::test::freePort()};
    request.interface = kLocal;
    request.base = base_;
    return request;
  }

  ViewOptions options() {
    ViewOptions options = optionsFor(stream_->file(), {160, 120});
    options.stream = stream_;
    options.made_of = base_;
    return options;
  }
  void send(double latitude_deg, double longitude_deg) {
    interop::dis::EntityState state;
    state.id = {1, 1, 9};
    state.type = {1, 3, 225, 0, 0, 0, 0};
    state.algorithm = 1;
    state.position_m = toEcef({latitude_deg, longitude_deg, 120});
    state.orientation_rad = interop::dis::eulerOf(
        interop::dis::axesOf(interop::dis::LocalAttitude{0, 0, 0}, latitude_deg, longitude_deg));
    state.marking = "boat";
    send(state);
  }
  void sendRadio() {
    interop::dis::Transmitter radio;
    radio.entity = {1, 1, 9};
    radio.radio = 1;
    radio.state = 2;
    radio.frequency_hz = 300000000;
    radio.power_dbm = 50;
    send(radio);
  }
  template <class Pdu>
  void send(const Pdu& pdu) {
    const auto bytes = interop::dis::encode({}, pdu);
    ASSERT_TRUE(sender_.send(bytes.data(), bytes.size()));
  }
  static const scenario::Platform* boatOf(const Session& session, const std::string& name = "boat") {
    if (session.picture() == nullptr || !session.picture()->scenario) return nullptr;
    for (const scenario::Platform& platform : session.picture()->scenario->platforms) {
      if (platform.name == name) return &platform;
    }
    return nullptr;
  }
  /// True if the picture comes to show the boat there.
  static bool comesTo(SessionSample& session, double latitude_deg, const std::string& name = "boat") {
    return session.waitUntil([&] {
      const scenario::Platform* const boat = boatOf(*session, name);
      return boat != nullptr && std::abs(boat->track.front().position.latitude_deg - latitude_deg) < 1e-6;
    });
  }

  const StateFolder folder_;
  const std::string base_ = folder_.write("base.yaml", readFile(shippedScenario("quick.yaml")));
  const playback::StreamRequest request_ = request();
  std::shared_ptr<playback::LiveBattlefield> stream_ =
      std::make_shared<playback::LiveBattlefield>(request_, nullptr);
  playback::DatagramSender sender_{request_.address, kLocal, 0};
};

TEST_F(StreamTest, ThePictureFollowsEntitiesAndRestsExact) {
  SessionSample session(options());
  session.settle();
  const std::size_t platforms = session->picture()->scenario->platforms.size();
  send(52.01, 5);
  sendRadio();
  ASSERT_TRUE(session.waitUntil([&] { return boatOf(*session) != nullptr && session->settled(); }));
  EXPECT_EQ(session->picture()->scenario->platforms.size(), platforms + 1);
  send(52.02, 5.01);
  ASSERT_TRUE(session.waitUntil([&] {
    const scenario::Platform* const boat = boatOf(*session);
    return boat != nullptr && boat->track.front().position.latitude_deg > 52.0199 && session->settled();
  }));
  EXPECT_TRUE(session->exact());
  const playback::LivePicture& picture = *session->picture();
  emfield::FieldOptions field;
  field.quantities = {picture.info().quantity};
  emfield::FieldSolver fresh(picture.scenario, picture.terrain, field);
  fresh.update(scenario::snapshotAt(picture.scenario, picture.terrain.get(), picture.info().time_s));
  EXPECT_EQ(picture.volume.host()->values, fresh.volumes().front().host()->values);
  EXPECT_THAT(session->programState().stream, HasSubstr("DIS: "));
  EXPECT_TRUE(session.waitUntil([&] { return session->report()["stream_entities"] == 1; }));
}

TEST_F(StreamTest, EditsStayWhenObjectsCome) {
  SessionSample session(options());
  session.settle();
  EXPECT_EQ(session.perform(R"({"do":"set","path":"emitters.radar.power_w","value":"3"})"), "");
  send(52.01, 5);
  sendRadio();
  ASSERT_TRUE(session.waitUntil([&] { return boatOf(*session) != nullptr && session->settled(); }));
  EXPECT_EQ(session->picture()->scenario->emitters.front().power_w, 3);
  EXPECT_FALSE(session->canUndo()) << "of another scenario";
  EXPECT_TRUE(session->hasUnsavedEdits());
}

TEST_F(StreamTest, ThePlatformsMoveWhateverTheUserEdits) {
  SessionSample session(options());
  session.settle();
  send(52.01, 5);
  ASSERT_TRUE(comesTo(session, 52.01));
  EXPECT_EQ(
      session.perform(R"({"do":"add","what":"platform","name":"Aa","latitude_deg":52,"longitude_deg":5})"),
      "");
  send(52.02, 5);
  EXPECT_TRUE(comesTo(session, 52.02)) << "after one more";
  EXPECT_EQ(session.perform(R"({"do":"set","path":"platforms.boat.name","value":"ship"})"), "");
  send(52.03, 5);
  EXPECT_TRUE(comesTo(session, 52.03, "ship")) << "with another name";
  const scenario::Platform* const added = boatOf(*session, "Aa");
  ASSERT_NE(added, nullptr);
  EXPECT_EQ(added->track.front().position.latitude_deg, 52) << "what the stream does not know stays";
}

TEST_F(StreamTest, WhatTheStreamMovesCannotBeMovedByTheUser) {
  SessionSample session(options());
  session.settle();
  EXPECT_EQ(session->streamTitle(), "live, nothing received");
  send(52.01, 5);
  ASSERT_TRUE(comesTo(session, 52.01));
  const std::string reason = "'boat' cannot be put elsewhere: it is where the stream has it";
  for (const char* command : {R"({"do":"move","platform":"boat","latitude_deg":52.02,"longitude_deg":5})",
                              R"({"do":"set","path":"platforms.boat.position.latitude_deg","value":"52.02"})",
                              R"({"do":"set","path":"platforms.boat.attitude.heading_deg","value":"20"})",
                              R"({"do":"draw_track","platform":"boat"})",
                              R"({"do":"track","platform":"boat","points":["52,5","52.01,5.01"]})"}) {
    EXPECT_EQ(session.perform(command), reason) << command;
  }
  EXPECT_EQ(errorOf([&] { session->requireMovable("boat"); }), reason);
  session->drag({{"platforms.boat.position.latitude_deg", "52.02"}});
  EXPECT_FALSE(session->isDragging());
  EXPECT_EQ(session->scenario()->edits().size(), 0U);
  EXPECT_FALSE(session->hasUnsavedEdits());
  // Of the mast the stream tells nothing.
  session.perform(R"({"do":"move","platform":"mast","latitude_deg":52.02,"longitude_deg":5})");
  EXPECT_EQ(session->scenario()->edits().size(), 2U);
  session.perform(R"({"do":"set","path":"platforms.boat.name","value":"ship"})");
  EXPECT_EQ(session.perform(R"({"do":"move","platform":"ship","latitude_deg":52.02,"longitude_deg":5})"),
            "'ship' cannot be put elsewhere: it is where the stream has it");
  EXPECT_EQ(session->scenario()->edits().size(), 3U);
  EXPECT_EQ(session->streamTitle(), "live");
}

TEST_F(StreamTest, TheTitleTellsRecordsThatMoveNothing) {
  SessionSample session(options());
  session.settle();
  send(52.01, 5);
  ASSERT_TRUE(comesTo(session, 52.01));
  ASSERT_TRUE(session.settle());
  const std::string before = session->picture()->annotations.time;
  EXPECT_THAT(before, HasSubstr("live, "));
  std::this_thread::sleep_for(std::chrono::milliseconds(2100));
  send(52.01, 5);
  EXPECT_TRUE(session.waitUntil([&] { return session->picture()->annotations.time != before; }));
  const std::vector<playback::NamedPose> none;
  EXPECT_THAT(playback::posesOf({}, none, 1, /*has_stopped=*/true)->told, testing::EndsWith(", stopped"));
}

TEST_F(StreamTest, OutputsWithoutANameAreBesideTheBaseAndStay) {
  const std::string home = std::getenv("HOME") == nullptr ? "" : std::getenv("HOME");
  setenv("HOME", folder_.path().c_str(), 1);  // without Pictures
  {
    SessionSample session(options());
    session.settle();
    EXPECT_EQ(session->usualScenarioFile(), folder_ / "base.edited.yaml");
    EXPECT_EQ(session->usualColorsFile(), folder_ / "base.transfer.json");
    EXPECT_EQ(session.perform(R"({"do":"set","path":"emitters.radar.power_w","value":"3"})"), "");
    for (const char* verb : {"save", "save_state", "save_transfer", "picture"}) {
      session.settle();
      EXPECT_EQ(session.perform(std::string(R"({"do":")") + verb + R"("})"), "") << verb;
      session.waitUntil([&] { return !session->working(); });
    }
  }
  setenv("HOME", home.c_str(), 1);
  stream_.reset();
  for (const char* file : {"base.edited.yaml", "base.view.json", "base.transfer.json", "emscape-0001.png"})
    EXPECT_TRUE(std::filesystem::exists(folder_ / file)) << file;
}

TEST_F(StreamTest, AViewFileKeepsTheStreamAndAnotherInputEndsItWithItsRecording) {
  const std::string view = folder_ / "a.view.json";
  playback::StreamRequest recorded = request();
  recorded.record = folder_ / "seen.pcap";
  stream_ = std::make_shared<playback::LiveBattlefield>(recorded, nullptr);
  const std::weak_ptr<playback::LiveBattlefield> stream = stream_;
  SessionSample session(options());
  stream_.reset();
  SessionOpener opener(session.files, [&](const ViewOptions& options) { return session.make(options); });
  const auto open = [&](const std::string& file) {
    session->perform({"open", {{"file", file}}});
    session.waitUntil([&] {
      opener.update(session.session);
      return !opener.active() && session->settled();
    });
    EXPECT_EQ(session.error(), "");
  };
  session.settle();
  session.perform(R"({"do":"save_state","file":")" + view + R"("})");
  session.waitUntil([&] { return !session->working(); });
  open(view);
  EXPECT_NE(session->options().stream, nullptr);
  open(base_);
  EXPECT_EQ(session->options().stream, nullptr);
  EXPECT_TRUE(std::filesystem::exists(recorded.record));
  EXPECT_TRUE(session.waitUntil([&] { return stream.expired(); })) << "the port is free";
}

TEST(AcmiStream, TheCameraFollowsAnObjectByItsNameWhenOthersComeAndGo) {
  const StateFolder folder;
  playback::StreamRequest request;
  request.kind = playback::StreamKind::acmi;
  request.connects = true;
  request.address = {kLocal, emscape::test::freePort()};
  request.base = shippedScenario("quick.yaml");
  playback::AcmiServer host(request.address, "");
  for (const char* line : {"FileType=text/acmi/tacview", "FileVersion=2.2",
                           "1,T=5|52|900,Type=Air,Name=Alpha", "2,T=5.01|52|900,Type=Air,Name=Bravo"})
    host.send(line);
  const auto stream = std::make_shared<playback::LiveBattlefield>(request, nullptr);
  ViewOptions options = optionsFor(stream->file(), {160, 120});
  options.stream = stream;
  options.made_of = request.base;
  SessionSample session(options);
  const auto waitFor = [&](const char* name) {
    return session.waitUntil([&] {
      host.serve(0);
      return session->scenario() && playback::platformIndices(*session->scenario()).count(name) == 1 &&
             session->settled();
    });
  };
  ASSERT_TRUE(waitFor("Bravo"));
  EXPECT_EQ(session.perform(R"({"do":"follow","name":"Bravo"})"), "");
  host.send("-1");
  host.send("3,T=5.02|52|900,Type=Air,Name=Xray");
  ASSERT_TRUE(waitFor("Xray"));
  EXPECT_EQ(session->view().follow, "Bravo");
}

const char kWalk[] =
    "<gpx version=\"1.1\"><trk><name>walker</name><trkseg>"
    "<trkpt lat=\"52\" lon=\"5\"><ele>2</ele><time>2026-06-01T06:00:00Z</time></trkpt>"
    "<trkpt lat=\"52.01\" lon=\"5\"><ele>2</ele><time>2026-06-01T06:10:00Z</time></trkpt>"
    "</trkseg></trk></gpx>\n";

const char kWalkersRadio[] =
    "schema_version: 1\nemitters:\n  - name: radio\n    match: {object_name: walker}\n    emitter: {kind: "
    "transmitter, "
    "frequency_hz: 3.0e8, power_w: 5, antenna: {pattern: isotropic}}\n";

TEST(Recordings, WithoutAnEmitterMoveAndTellHowToAddOne) {
  const StateFolder folder;
  const std::string recording = folder.write("walk.gpx", kWalk);
  const Opening opening = prepareOpening({recording, "", std::nullopt, false}, {});
  const std::string silent =
      "walk.gpx: 1 platform, without an emitter, as the starter set has none for it: switch on 'walker "
      "transmitter' in What if, or add others there";
  ViewOptions options = opening.options;
  options.view.size = {160, 120};
  SessionSample session(options);
  session->shown({});
  ASSERT_TRUE(session.settle());
  const scenario::Scenario& scenario = *session->scenario();
  EXPECT_TRUE(scenario.platforms.front().moves());
  EXPECT_FALSE(scenario.emitters.front().enabled);
  EXPECT_EQ(session->files().recent, std::vector<std::string>{recording}) << "not its copy";
  EXPECT_THAT(session->notice().text, HasSubstr(silent));
  EXPECT_THAT(session->warnings(), testing::Contains(HasSubstr(silent)));
  EXPECT_EQ(session.perform(R"({"do":"enable","emitter":"walker transmitter"})"), "");
  EXPECT_TRUE(session.settle());
  EXPECT_EQ(session->notice().text, "") << "no longer true";
  EXPECT_THAT(session->warnings(), testing::Contains(testing::StartsWith("walk.gpx: 1 platform; over flat")));
  session->perform({"reload"});
  ASSERT_TRUE(session.files->request);
  EXPECT_EQ(session.files->request->file, recording);
  folder.write("walk.gpx.emitters.yaml", kWalkersRadio);
  const Opening reopening = prepareOpening(*session.files->request, session->options());
  EXPECT_TRUE(reopening.imports);
  EXPECT_THAT(reopening.options.made_note.text(true),
              testing::StartsWith("walk.gpx: 1 platform, emitters of walk.gpx.emitters.yaml; over flat"));
}

TEST(Recordings, OpenedAgainAreNotTakenForChangedFiles) {
  const StateFolder folder;
  const std::string recording = folder.write("walk.gpx", kWalk);
  const auto hasChanged = [&](bool adds_edit) {
    const Opening opening = prepareOpening({recording, "", std::nullopt, false}, {});  // writes the copy
    ViewOptions options = opening.options;
    options.view.size = {160, 120};
    SessionSample session(options);
    session->shown({});
    session.settle();
    if (adds_edit) session.perform(R"({"do":"enable","emitter":"walker transmitter"})");
    session->leave(true);
    session.waitUntil([&] { return !session->working(); });
    return session->keptView() && session->keptView()->input_changed;
  };
  hasChanged(true);
  EXPECT_FALSE(hasChanged(false));
  std::filesystem::last_write_time(recording, std::filesystem::file_time_type::clock::now());
  EXPECT_TRUE(hasChanged(false));
}

TEST(Recordings, AreOpenedAsScenariosInTheFolderOfTheState) {
  const StateFolder folder;
  const std::string recording =
      folder.write("flight.acmi",
                   "FileType=text/acmi/"
                   "tacview\nFileVersion=2.2\n1,T=5|52|3000|0|0|90,Type=Air+FixedWing,Name=F-14B,RadarMode=1,"
                   "RadarHorizontalBeamwidth=3\n#10\n1,T=5.01|52\n");
  const Opening opening = prepareOpening({recording, "", std::nullopt, false}, {});
  EXPECT_EQ(std::filesystem::path(opening.options.view.input).filename(), "flight.yaml");
  EXPECT_THAT(opening.options.made_note.text(true),
              HasSubstr("flight.acmi: 1 platform, emitters of the starter set (nominal values"));
  EXPECT_EQ(opening.options.view.input.find(folder.path().string()), 0u);
  EXPECT_EQ(opening.options.namesake(), recording) << "outputs are beside it";
  folder.write("torn.acmi", "nothing of the kind\n");
  EXPECT_THAT(errorOf([&] {
                prepareOpening({folder / "torn.acmi", "", std::nullopt, false}, {});
              }),
              HasSubstr("torn.acmi"));
}

}  // namespace
}  // namespace emscape::view::test
