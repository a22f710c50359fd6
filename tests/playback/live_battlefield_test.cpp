// Streams over the loopback interface as scenarios and poses.
#include "playback/stream/live_battlefield.h"

#include <sys/resource.h>

#include <array>
#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>

#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/base/geodesy/geoid.h"
#include "emscape/scenario/model/poses.h"
#include "playback/sockets/socket.h"
#include "playback/stream/acmi_server.h"
#include "recording/dis/orientation.h"
#include "recording/dis/pdu.h"
#include "recording/read_recording.h"
#include "tests/playback/playback_samples.h"
#include "tests/support/errors.h"
#include "tests/support/file_size_limit.h"
#include "tests/support/files.h"
#include "tests/support/ports.h"

namespace emscape::playback::test {
namespace {

using emscape::test::errorOf;
using emscape::test::freePort;
using emscape::test::shippedScenario;
using testing::HasSubstr;

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
  const NamedPose& pose = there.poses->front();
  EXPECT_EQ(pose.platform, "ship");
  EXPECT_EQ(there.scenario->emitters.back().platform, scenario::platformNamed(*there.scenario, "ship"));
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
  EXPECT_EQ(battlefield.now().poses->front().platform, name);
}

/// The present battlefield as the field is computed of it.
scenario::Snapshot snapshotOf(const LiveBattlefield& battlefield) {
  const BattlefieldNow now = battlefield.now();
  return scenario::snapshotAt(now.scenario, nullptr, 0,
                              posesOf(platformIndices(*now.scenario), *now.poses, 1)->platforms);
}

TEST(LiveBattlefield, APlatformThatTheStreamNoLongerTellsOfStaysAtItsLastPlaceAndIsSilent) {
  const std::uint16_t port = freePort();
  StreamRequest request = requestAt(port);
  request.read.entity_timeout_s = 0.6;
  LiveBattlefield battlefield(request, {});
  const auto base = battlefield.now().scenario;
  const std::string name = base->platforms.front().name;
  const auto is_active = [&] {
    const scenario::Snapshot now = snapshotOf(battlefield);
    for (std::size_t e = 0; e < now.emitters.size(); ++e) {
      if (now.scenario->emitters[e].platform == 0 && now.emitters[e].active) return true;
    }
    return false;
  };
  EXPECT_TRUE(is_active()) << "as in the scenario";
  EXPECT_THAT(battlefield.status().untold, testing::Contains(name));
  DatagramSender sender({kLocal, port}, kLocal, 0);
  // Sent again and again: on a busy machine one may time out before it is looked at.
  ASSERT_TRUE(waitFor([&] {
    send(sender, stateOf(name, 52.04, 5.01));
    return battlefield.status().untold.size() + 1 == base->platforms.size() && is_active();
  }));
  ASSERT_TRUE(waitFor([&] { return !battlefield.status().silent.empty(); })) << "it has timed out";
  EXPECT_FALSE(is_active());
  EXPECT_NEAR(snapshotOf(battlefield).platforms.front().position.latitude_deg, 52.04, 1e-6);
  EXPECT_THAT(battlefield.status().text(), HasSubstr("silent at the last known place: " + name));
  interop::dis::EntityState destroyed = stateOf(name, 52.05, 5.01);
  const auto isBack = [&] {
    send(sender, destroyed);
    return is_active();
  };
  ASSERT_TRUE(waitFor(isBack)) << "it is back";
  constexpr std::uint32_t kDestroyed = 3u << 3;
  destroyed.appearance |= kDestroyed;
  destroyed.position_m = toEcef({52.06, 5.01, 100});
  send(sender, destroyed);
  EXPECT_TRUE(waitFor([&] { return !is_active(); })) << "destroyed";
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
    EXPECT_THAT(battlefield.status().text(), HasSubstr("1 object"));
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

/// A host of ACMI on a thread.
class Host {
 public:
  Host(std::uint16_t port, const std::vector<std::string>& lines)
      : server_(std::in_place, Address{kLocal, port}, ""), thread_([this, lines] {
          server_->send("FileType=text/acmi/tacview");
          server_->send("FileVersion=2.2");
          for (const std::string& line : lines) server_->send(line);
          while (!ends_) {
            {
              const std::lock_guard<std::mutex> lock(mutex_);
              for (const std::string& line : std::exchange(more_, {})) server_->send(line);
            }
            server_->serve(0.01);
          }
          server_.reset();
        }) {}
  ~Host() {
    ends_ = true;
    thread_.join();
  }
  void send(const std::string& line) {
    const std::lock_guard<std::mutex> lock(mutex_);
    more_.push_back(line);
  }

 private:
  std::optional<AcmiServer> server_;
  std::mutex mutex_;
  std::vector<std::string> more_;
  std::atomic<bool> ends_{false};
  std::thread thread_;
};

std::string namesOf(const LiveBattlefield& battlefield) {
  std::string names;
  for (const scenario::Platform& platform : battlefield.now().scenario->platforms)
    names += platform.name + ";";
  return names;
}

bool hasPlatform(const LiveBattlefield& battlefield, const std::string& name) {
  const auto scenario = battlefield.now().scenario;
  return platformIndices(*scenario).count(name) == 1;
}

TEST(LiveBattlefield, APlatformWhoseAcmiObjectIsRemovedIsSilentUntilAnotherOneOfItsNameComes) {
  const std::uint16_t port = freePort();
  Host host(port, {"1,T=5|52|3000,Type=Air,Name=mast"});
  LiveBattlefield battlefield(requestAt(port, StreamKind::acmi), {});
  const auto is_active = [&] { return snapshotOf(battlefield).emitters.back().active; };
  ASSERT_TRUE(waitFor([&] { return !battlefield.now().poses->empty(); }));
  EXPECT_TRUE(is_active());
  host.send("#5");
  host.send("-1");
  ASSERT_TRUE(waitFor([&] { return !is_active(); }));
  host.send("#6");
  host.send("2,T=5.02|52|3000,Type=Air,Name=mast");
  EXPECT_TRUE(waitFor([&] { return is_active(); }));
}

TEST(LiveBattlefield, AfterAnotherConnectionTheObjectsAreThoseOfTheNewHost) {
  const std::uint16_t port = freePort();
  auto host = std::make_unique<Host>(port, std::vector<std::string>{"1,T=5|52|3000,Type=Air,Name=First"});
  LiveBattlefield battlefield(requestAt(port, StreamKind::acmi), {});
  ASSERT_TRUE(waitFor([&] { return hasPlatform(battlefield, "First"); }));
  host.reset();
  ASSERT_TRUE(waitFor([&] { return !battlefield.status().trouble.empty(); }));
  host = std::make_unique<Host>(port, std::vector<std::string>{"1,T=5.02|52|3000,Type=Air,Name=Second",
                                                               "2,T=5|52.02|3000,Type=Air,Name=Third"});
  EXPECT_TRUE(
      waitFor([&] { return hasPlatform(battlefield, "Second") && hasPlatform(battlefield, "Third"); }));
  EXPECT_FALSE(hasPlatform(battlefield, "First"));
  EXPECT_EQ(battlefield.status().trouble, "");
}

TEST(LiveBattlefield, WhateverItsPosesAreTheyCanBeShown) {
  const std::uint16_t port = freePort();
  Host host(port,
            {"1,T=5|52|3000|0|0|400,Type=Air,Name=Turning", "2,T=5.02|52|3000|0|0|0,Type=Air,Name=Other"});
  LiveBattlefield battlefield(requestAt(port, StreamKind::acmi), {});
  ASSERT_TRUE(waitFor([&] { return battlefield.now().poses->size() == 2; }));
  host.send("2,T=5.03||");
  EXPECT_TRUE(waitFor([&] {
    const BattlefieldNow now = battlefield.now();
    const auto shown =
        scenario::withPoses(*now.scenario, posesOf(platformIndices(*now.scenario), *now.poses, 1)->platforms);
    const auto index = static_cast<std::size_t>(scenario::platformNamed(*shown, "Other"));
    return std::abs(shown->platforms[index].track.front().position.longitude_deg - 5.03) < 1e-9;
  }));
}

TEST(LiveBattlefield, AnObjectOutsideOfTheLimitsIsToldAndTheOthersAreShown) {
  const std::uint16_t port = freePort();
  LiveBattlefield battlefield(requestAt(port), {});
  DatagramSender sender({kLocal, port}, kLocal, 0);
  interop::dis::EntityState satellite = stateOf("satellite", 0, 5);
  satellite.position_m = toEcef({0, 5, 35786000});
  send(sender, satellite);
  send(sender, radioOf("satellite"));
  interop::dis::EntityState edge = stateOf("edge", 52, 5);
  edge.position_m = toEcef({52, 5, 99999 + geoidUndulation_m(52, 5)});
  send(sender, edge);
  interop::dis::Transmitter on_edge = radioOf("edge");
  on_edge.relative_antenna_m = {0, 0, -5};
  send(sender, on_edge);
  send(sender, stateOf("boat", 52.02, 5));
  send(sender, radioOf("boat"));
  ASSERT_TRUE(waitFor([&] { return hasPlatform(battlefield, "boat") && hasPlatform(battlefield, "edge"); }))
      << namesOf(battlefield) << battlefield.status().trouble;
  EXPECT_FALSE(hasPlatform(battlefield, "satellite"));
  EXPECT_EQ(battlefield.status().outside, 1);
  EXPECT_EQ(battlefield.status().trouble, "1 position is higher than 100 km or lower than -12 km, not used");
}

TEST(LiveBattlefield, AWakeThatEndsLeavesTheLaterOne) {
  const std::uint16_t port = freePort();
  LiveBattlefield battlefield(requestAt(port), {});
  std::atomic<int> first{0}, second{0};
  auto of_first = battlefield.setWake([&] { ++first; });
  const auto of_second = battlefield.setWake([&] { ++second; });
  of_first.reset();
  DatagramSender sender({kLocal, port}, kLocal, 0);
  send(sender, stateOf("ship", 52.02, 5));
  EXPECT_TRUE(waitFor([&] { return second > 0; }));
  EXPECT_EQ(first, 0);
}

TEST(LiveBattlefield, ARecordingThatEndsEarlyIsAnErrorAtItsEnd) {
  const emscape::test::TemporaryFolder folder;
  StreamRequest request = requestAt(freePort());
  request.record = folder / "seen.pcap";
  LiveBattlefield battlefield(request, {});
  DatagramSender sender(request.address, kLocal, 0);
  {
    const emscape::test::FileSizeLimit full(4096);
    for (int n = 0; n < 200; ++n) send(sender, stateOf("ship", 52.02, 5));
    ASSERT_TRUE(waitFor([&] { return battlefield.status().records == 200; }));
    EXPECT_THAT(errorOf([&] { battlefield.finishRecording(); }, ErrorCode::other), HasSubstr("seen.pcap"));
  }
}

TEST(LiveBattlefield, AHostThatDoesNotGreetIsTold) {
  const Address address{kLocal, freePort()};
  Listener silent(address);
  LiveBattlefield battlefield(requestAt(address.port, StreamKind::acmi), {});
  EXPECT_TRUE(waitFor([&] { return battlefield.status().trouble.find("no greeting in") == 0; }));
}

TEST(AcmiServer, WhoComesLateGetsJoinedLinesWhole) {
  const std::uint16_t port = freePort();
  const Host host(port, {"1,T=5|52|3000,Type=Air,Label=two\nlines,Name=Jet"});
  LiveBattlefield battlefield(requestAt(port, StreamKind::acmi), {});
  EXPECT_TRUE(waitFor([&] { return hasPlatform(battlefield, "Jet"); }));
  EXPECT_EQ(battlefield.status().bad, 0);
}

TEST(Sockets, BroadcastIsSent) {
  const std::uint16_t port = freePort();
  DatagramReceiver receiver({0, port}, kLocal);
  DatagramSender sender({0x7FFFFFFF, port}, kLocal, 0);
  const std::uint8_t byte = 7;
  EXPECT_TRUE(sender.send(&byte, 1));
  EXPECT_EQ(receiver.receive(5, [](const std::uint8_t*, std::size_t) {}), 1u);
}

TEST(Sockets, AListenerThatCannotAcceptWaits) {
  const Address address{kLocal, freePort()};
  Listener listener(address);
  const Connection client = Connection::to(address);
  rlimit before{};
  getrlimit(RLIMIT_NOFILE, &before);
  const rlimit none{1, before.rlim_max};
  setrlimit(RLIMIT_NOFILE, &none);
  const auto begin = std::chrono::steady_clock::now();
  const bool is_accepted = listener.accept(0.02).has_value();
  const std::chrono::duration<double> waited = std::chrono::steady_clock::now() - begin;
  setrlimit(RLIMIT_NOFILE, &before);
  EXPECT_FALSE(is_accepted);
  EXPECT_GE(waited.count(), 0.02);
  EXPECT_TRUE(listener.accept(5).has_value());
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
