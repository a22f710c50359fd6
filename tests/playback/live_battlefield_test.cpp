// Streams over the loopback interface as scenarios and poses.
#include "playback/stream/live_battlefield.h"

#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <thread>

#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/scenario/model/poses.h"
#include "playback/sockets/socket.h"
#include "playback/stream/acmi_server.h"
#include "recording/acmi/acmi_handshake.h"
#include "recording/dis/orientation.h"
#include "recording/dis/pdu.h"
#include "recording/read_recording.h"
#include "tests/playback/playback_samples.h"
#include "tests/support/errors.h"
#include "tests/support/files.h"

namespace emscape::playback::test {
namespace {

using emscape::test::errorOf;
using emscape::test::shippedScenario;
using testing::HasSubstr;

/// A port that is free: the system chooses one for a socket that is closed again.
std::uint16_t freePort() {
  static std::uint16_t next = static_cast<std::uint16_t>(20000 + getpid() % 20000);
  return ++next;
}

bool waitFor(const std::function<bool()>& condition) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

constexpr std::uint32_t kLocal = 0x7F000001;

StreamRequest requestAt(std::uint16_t port, StreamKind kind = StreamKind::dis) {
  StreamRequest request;
  request.kind = kind;
  request.connects = kind == StreamKind::acmi;
  request.address = {kLocal, port};
  request.interface = kLocal;
  request.base = shippedScenario("quick.yaml");
  return request;
}

interop::dis::EntityState stateOf(const std::string& marking, double latitude_deg, double longitude_deg) {
  interop::dis::EntityState state;
  state.id = {1, 1, static_cast<std::uint16_t>(marking[0])};
  state.type = {1, 3, 225, 0, 0, 0, 0};
  state.algorithm = 1;
  state.position_m = toEcef({latitude_deg, longitude_deg, 100});
  state.orientation_rad = interop::dis::eulerOf(
      interop::dis::axesOf(interop::dis::LocalAttitude{0, 0, 0}, latitude_deg, longitude_deg));
  state.marking = marking;
  return state;
}

template <class Pdu>
void send(DatagramSender& sender, const Pdu& pdu) {
  const auto bytes = interop::dis::encode({}, pdu);
  ASSERT_TRUE(sender.send(bytes.data(), bytes.size()));
}

interop::dis::Transmitter radioOf(const std::string& marking) {
  interop::dis::Transmitter radio;
  radio.entity = {1, 1, static_cast<std::uint16_t>(marking[0])};
  radio.radio = 1;
  radio.state = 2;
  radio.frequency_hz = 300000000;
  radio.power_dbm = 50;
  return radio;
}

TEST(LiveBattlefield, EntitiesBecomePlatformsAndMove) {
  const std::uint16_t port = freePort();
  LiveBattlefield battlefield(requestAt(port), {});
  const auto base = battlefield.now().scenario;
  DatagramSender sender({kLocal, port}, kLocal, 0);
  send(sender, stateOf("ship", 52.02, 5));
  send(sender, radioOf("ship"));
  ASSERT_TRUE(
      waitFor([&] { return battlefield.now().scenario->emitters.size() == base->emitters.size() + 1; }));
  const BattlefieldNow there = battlefield.now();
  ASSERT_EQ(there.poses->size(), 1u);
  const scenario::PlatformPose& pose = there.poses->front();
  EXPECT_EQ(there.scenario->platforms[static_cast<std::size_t>(pose.platform)].name, "ship");
  EXPECT_EQ(there.scenario->emitters.back().platform, pose.platform);
  EXPECT_NEAR(pose.position.latitude_deg, 52.02, 1e-7);
  EXPECT_EQ(battlefield.now().poses, there.poses) << "it rests";
  send(sender, stateOf("ship", 52.03, 5));
  ASSERT_TRUE(waitFor([&] { return battlefield.now().poses != there.poses; }));
  EXPECT_EQ(battlefield.now().scenario, there.scenario) << "a movement changes only the poses";
  EXPECT_NEAR(battlefield.now().poses->front().position.latitude_deg, 52.03, 1e-7);
  const StreamStatus status = battlefield.status();
  EXPECT_EQ(status.records, 3);
  EXPECT_EQ(status.entities, 1u);
  EXPECT_THAT(status.text(), HasSubstr("DIS: "));
  EXPECT_EQ(status.trouble, "");
}

TEST(LiveBattlefield, AnEntityWithTheNameOfAPlatformOfTheBaseMovesIt) {
  const std::uint16_t port = freePort();
  LiveBattlefield battlefield(requestAt(port), {});
  const auto base = battlefield.now().scenario;
  const std::string name = base->platforms.front().name;
  DatagramSender sender({kLocal, port}, kLocal, 0);
  send(sender, stateOf(name, 52.04, 5.01));
  ASSERT_TRUE(waitFor([&] { return !battlefield.now().poses->empty(); }));
  EXPECT_EQ(battlefield.now().scenario->platforms.size(), base->platforms.size());
  EXPECT_EQ(battlefield.now().poses->front().platform, 0);
}

TEST(LiveBattlefield, WhatArrivesIsRecordedAndReadAgain) {
  const emscape::test::TemporaryFolder folder;
  StreamRequest request = requestAt(freePort());
  request.record = folder / "seen.pcap";
  {
    LiveBattlefield battlefield(request, {});
    DatagramSender sender(request.address, kLocal, 0);
    send(sender, stateOf("ship", 52.02, 5));
    send(sender, radioOf("ship"));
    ASSERT_TRUE(waitFor([&] { return battlefield.status().records == 2; }));
    battlefield.finishRecording();
  }
  const interop::Recording recording = interop::readRecording(request.record);
  EXPECT_EQ(recording.objects.size(), 1u);
  EXPECT_EQ(recording.beams.size(), 1u);
  EXPECT_THAT(errorOf([&] { LiveBattlefield again(request, {}); }, ErrorCode::usage), HasSubstr("seen.pcap"));
}

TEST(LiveBattlefield, AStreamOfOtherBytesIsToldInOneLine) {
  const std::uint16_t port = freePort();
  LiveBattlefield battlefield(requestAt(port), {});
  DatagramSender sender({kLocal, port}, kLocal, 0);
  const std::string text = "GET / HTTP/1.1";
  for (int n = 0; n < 1000; ++n) sender.send(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  ASSERT_TRUE(waitFor([&] { return battlefield.status().bad > 0; }));
  const std::string trouble = battlefield.status().trouble;
  EXPECT_THAT(trouble, HasSubstr("cannot be read, the first: a datagram that is no DIS"));
  EXPECT_EQ(trouble.find('\n'), std::string::npos);
}

TEST(LiveBattlefield, AnAcmiHostIsReadAndItsEndIsTold) {
  const std::uint16_t port = freePort();
  std::optional<AcmiServer> server(std::in_place, Address{kLocal, port}, "secret");
  std::atomic<bool> ends{false};
  std::thread host([&] {
    server->send(
        "\xEF\xBB\xBF"
        "FileType=text/acmi/tacview");
    server->send("FileVersion=2.2");
    server->send("#1");
    server->send("a,T=5|52.02|100|0|0|0,Type=Sea+Watercraft,Name=Boat");
    server->send("a,T=|52.03|");
    while (!ends) server->serve(0.01);
    server.reset();
  });
  StreamRequest request = requestAt(port, StreamKind::acmi);
  request.password = "secret";
  LiveBattlefield battlefield(request, {});
  EXPECT_TRUE(waitFor([&] { return battlefield.now().poses->size() == 1; }));
  if (!battlefield.now().poses->empty()) {
    const auto& pose = battlefield.now().poses->front();
    EXPECT_NEAR(pose.position.latitude_deg, 52.03, 1e-9) << "who comes late gets the present state";
    EXPECT_NEAR(pose.position.longitude_deg, 5, 1e-9);
  }
  ends = true;
  host.join();
  EXPECT_TRUE(waitFor([&] { return battlefield.status().trouble.find("the host has ended") == 0; }));
}

std::string cotOf(const std::string& uid, double latitude_deg) {
  return "<event version='2.0' uid='" + uid +
         "' type='a-h-S' time='2026-06-01T06:00:00Z' start='2026-06-01T06:00:00Z' "
         "stale='2026-06-01T07:00:00Z'>"
         "<point lat='" +
         std::to_string(latitude_deg) + "' lon='5' hae='100'/><detail><contact callsign='" + uid +
         "'/></detail></event>";
}

TEST(LiveBattlefield, EventsOfTakComeAsDatagramsAndAreRecorded) {
  const emscape::test::TemporaryFolder folder;
  StreamRequest request = requestAt(freePort(), StreamKind::cot);
  request.record = folder / "team.cot";
  {
    LiveBattlefield battlefield(request, {});
    DatagramSender sender(request.address, kLocal, 0);
    const std::string event = cotOf("boat", 52.02);
    ASSERT_TRUE(sender.send(reinterpret_cast<const std::uint8_t*>(event.data()), event.size()));
    ASSERT_TRUE(waitFor([&] { return battlefield.now().poses->size() == 1; }));
    EXPECT_NEAR(battlefield.now().poses->front().position.latitude_deg, 52.02, 1e-9);
    EXPECT_THAT(battlefield.status().text(), HasSubstr("CoT: 1 event"));
    battlefield.finishRecording();
  }
  EXPECT_EQ(interop::readRecording(request.record).objects.at(0).name, "boat");
}

TEST(LiveBattlefield, AServerOfTakIsAskedAndItsEventsMayComeInPieces) {
  StreamRequest request = requestAt(freePort(), StreamKind::cot);
  request.connects = true;
  std::atomic<bool> ends{false};
  Listener listener(request.address);
  std::string asked;
  std::thread server([&] {
    auto client = listener.accept(10);
    if (!client) return;
    std::array<char, 4096> bytes{};
    asked.assign(bytes.data(), client->read(10, bytes.data(), bytes.size()).value_or(0));
    const std::string text = "<?xml version='1.0'?>" + cotOf("boat", 52.02) + cotOf("tug", 52.03);
    client->write(text.substr(0, 100), 1);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    client->write(text.substr(100), 1);
    while (!ends) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  });
  LiveBattlefield battlefield(request, {});
  EXPECT_TRUE(waitFor([&] { return battlefield.now().poses->size() == 2; }));
  EXPECT_EQ(battlefield.status().trouble, "");
  ends = true;
  server.join();
  EXPECT_THAT(asked, HasSubstr("t-x-c-t"));
}

TEST(LiveBattlefield, AWrongPasswordIsTold) {
  const std::uint16_t port = freePort();
  AcmiServer server(Address{kLocal, port}, "secret");
  std::atomic<bool> ends{false};
  std::thread host([&] {
    while (!ends) server.serve(0.01);
  });
  LiveBattlefield battlefield(requestAt(port, StreamKind::acmi), {});
  EXPECT_TRUE(waitFor([&] { return battlefield.status().trouble.find("password") != std::string::npos; }));
  ends = true;
  host.join();
}

TEST(Sockets, AddressesAreReadAndOthersRefusedWithAnExample) {
  EXPECT_EQ(parseAddress("3000", "--dis").text(), "127.0.0.1:3000");
  EXPECT_TRUE(parseAddress("239.1.2.3:3000", "--dis").isMulticast());
  for (const char* text : {"", "0", "65536", "127.0.0.1", "1.2.3.4:x", "3000.5"})
    EXPECT_THAT(errorOf([&] { parseAddress(text, "--dis"); }, ErrorCode::usage), HasSubstr("127.0.0.1:3000"))
        << text;
}

TEST(Sockets, APortInUseIsNamedWithARemedy) {
  const Address address{kLocal, freePort()};
  const DatagramReceiver first(address, kLocal);
  EXPECT_THAT(errorOf([&] { DatagramReceiver second(address, kLocal); }, ErrorCode::other),
              HasSubstr("another program uses the port"));
  EXPECT_THAT(errorOf([&] { Connection::to({kLocal, freePort()}); }), HasSubstr("no program listens there"));
}

}  // namespace
}  // namespace emscape::playback::test
