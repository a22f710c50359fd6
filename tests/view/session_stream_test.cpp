/// Battlefields of other programs in a session: live streams and recordings.
#include <unistd.h>

#include "apps/view/parts/opening.h"
#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/emfield/solver/field_solver.h"
#include "emscape/scenario/model/poses.h"
#include "emscape/scenario/terrain/terrain.h"
#include "recording/dis/orientation.h"
#include "recording/dis/pdu.h"
#include "playback/sockets/socket.h"
#include "tests/view/session_sample.h"

namespace emscape::view::test {
namespace {

using testing::HasSubstr;

constexpr std::uint32_t kLocal = 0x7F000001;

/// A session on quick.yaml with a stream, and its sender.
class StreamTest : public testing::Test {
 protected:
  static playback::StreamRequest request() {
    static std::uint16_t port = static_cast<std::uint16_t>(42000 + getpid() % 10000);
    playback::StreamRequest request;
    request.address = {kLocal, ++port};
    request.interface = kLocal;
    request.base = shippedScenario("quick.yaml");
    return request;
  }

  ViewOptions options() {
    ViewOptions options = optionsFor(stream_->file(), {160, 120});
    options.stream = stream_;
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
  static const scenario::Platform* boatOf(const Session& session) {
    if (session.picture() == nullptr || !session.picture()->scenario) return nullptr;
    for (const scenario::Platform& platform : session.picture()->scenario->platforms) {
      if (platform.name == "boat") return &platform;
    }
    return nullptr;
  }

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

TEST_F(StreamTest, AnotherInputEndsTheStream) {
  const Opening opening = prepareOpening({shippedScenario("quick.yaml"), "", std::nullopt, false}, options());
  EXPECT_EQ(opening.options.stream, nullptr);
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
  EXPECT_THAT(opening.note, HasSubstr("flight.acmi: 1 platform, emitters of the starter set"));
  EXPECT_EQ(opening.options.view.input.find(folder.path().string()), 0u);
  folder.write("torn.acmi", "nothing of the kind\n");
  EXPECT_THAT(errorOf([&] {
                prepareOpening({folder / "torn.acmi", "", std::nullopt, false}, {});
              }),
              HasSubstr("torn.acmi"));
}

}  // namespace
}  // namespace emscape::view::test
