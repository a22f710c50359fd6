// PDUs as recordings.
#include "recording/dis/dis_recorder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "recording/dis/dead_reckoning.h"
#include "recording/dis/orientation.h"
#include "recording/read_recording.h"
#include "tests/recording/dis_pdus.h"
#include "tests/support/errors.h"
#include "tests/support/reference_data.h"

namespace emscape::interop::dis {
namespace {

using testing::HasSubstr;

/// A stream of PDUs of one sender.
class Stream {
 public:
  explicit Stream(int version = 7, const ReadOptions& options = {}) : version_(version), recorder_(options) {}

  template <class Pdu>
  void send(double time_s, const Pdu& pdu) {
    sendAt(time_s, time_s, pdu);
  }
  /// @param sent_s  the sender's time
  template <class Pdu>
  void sendAt(double arrival_s, double sent_s, const Pdu& pdu) {
    const auto bytes = test::pduAt(version_, sent_s, pdu);
    recorder_.take({arrival_s, bytes.data(), bytes.size()});
  }
  Recording finish() { return recorder_.finish(); }
  DisRecorder& recorder() { return recorder_; }

 private:
  int version_;
  DisRecorder recorder_;
};

EntityState stateAt(double latitude_deg, double longitude_deg, double height_ellipsoid_m = 1000) {
  EntityState state;
  state.id = {1, 1, 7};
  state.force = 1;
  state.type = {1, 2, 225, 1, 0, 0, 0};
  state.position_m = toEcef({latitude_deg, longitude_deg, height_ellipsoid_m});
  state.orientation_rad = eulerOf(axesOf(LocalAttitude{30, 5, -10}, latitude_deg, longitude_deg));
  state.marking = "VIPER";
  return state;
}

Emission emissionOf(const std::vector<int>& beams) {
  return test::radarOf({1, 1, 7}, beams);
}

std::vector<bool> switches(const RecordedBeam& beam) {
  std::vector<bool> on;
  for (const BeamState& state : beam.states) on.push_back(state.is_on);
  return on;
}

TEST(DisRecorder, EntityHasItsPoseAndIdentity) {
  Stream stream;
  stream.send(0, stateAt(36, -84));
  stream.send(1, stateAt(36.001, -84));
  const Recording r = stream.finish();
  ASSERT_EQ(r.objects.size(), 1u);
  const RecordedObject& object = r.objects[0];
  EXPECT_EQ(object.name, "VIPER");
  EXPECT_EQ(object.id, "1:1:7");
  EXPECT_EQ(object.domain, Domain::air);
  EXPECT_EQ(object.side, Side::friendly);
  ASSERT_EQ(object.poses.size(), 2u);
  EXPECT_NEAR(object.poses[0].latitude_deg, 36, 1e-9);
  EXPECT_NEAR(object.poses[0].height_msl_m, 1000 + 31, 3) << "the geoid is below the ellipsoid there";
  EXPECT_NEAR(object.poses[0].heading_deg, 30, 1e-4);
  EXPECT_NEAR(object.poses[0].pitch_deg, 5, 1e-4);
  EXPECT_NEAR(object.poses[0].roll_deg, -10, 1e-4);
  EXPECT_EQ(r.format, "DIS version 7");
}

TEST(DisRecorder, BeamThatItsSystemDoesNotListIsOffUpToVersion6) {
  for (const int version : {6, 7}) {
    Stream stream(version);
    stream.send(0, stateAt(36, -84));
    stream.send(1, emissionOf({1, 2}));
    stream.send(2, emissionOf({1}));
    const Recording r = stream.finish();
    ASSERT_EQ(r.beams.size(), 2u);
    const std::vector<bool> expected =
        version == 6 ? std::vector<bool>{true, false} : std::vector<bool>{true};
    EXPECT_EQ(switches(r.beams[1]), expected) << version;
    EXPECT_EQ(switches(r.beams[0]), std::vector<bool>{true}) << version;
  }
}

TEST(DisRecorder, EmissionWithoutBeamsIsOff) {
  for (const int version : {6, 7}) {
    Stream stream(version);
    stream.send(0, stateAt(36, -84));
    stream.send(1, emissionOf({1}));
    stream.send(2, emissionOf({}));
    EXPECT_EQ(switches(stream.finish().beams.at(0)), (std::vector<bool>{true, false})) << version;
  }
}

TEST(DisRecorder, EmissionEndsAfterItsTimeout) {
  Stream stream;
  stream.send(0, stateAt(36, -84));
  stream.send(1, emissionOf({1}));
  for (double t = 5; t < 60; t += 5) stream.send(t, stateAt(36, -84));
  stream.send(60, emissionOf({1}));
  const Recording r = stream.finish();
  const auto& states = r.beams.at(0).states;
  ASSERT_EQ(states.size(), 3u);
  EXPECT_NEAR(states[1].t_s, 25, 1e-3);
  EXPECT_FALSE(states[1].is_on);
  EXPECT_NEAR(states[2].t_s, 60, 1e-3);
}

TEST(DisRecorder, EntityWithoutUpdatesIsAbsentUntilTheNext) {
  Stream stream;
  stream.send(0, stateAt(36, -84));
  stream.send(100, stateAt(36, -84));
  const auto presence = stream.finish().objects.at(0).presence;
  ASSERT_EQ(presence.size(), 2u);
  EXPECT_NEAR(presence[0].t_s, 12, 1e-3);
  EXPECT_FALSE(presence[0].is_present);
  EXPECT_NEAR(presence[1].t_s, 100, 1e-3);
}

TEST(DisRecorder, DestroyedEntityIsAbsent) {
  Stream stream;
  stream.send(0, stateAt(36, -84));
  EntityState destroyed = stateAt(36, -84);
  destroyed.appearance = 3 << 3;
  stream.send(1, destroyed);
  const auto presence = stream.finish().objects.at(0).presence;
  ASSERT_EQ(presence.size(), 1u);
  EXPECT_FALSE(presence[0].is_present);
}

TEST(DisRecorder, EmissionBeforeTheEntityWaitsForIt) {
  Stream stream;
  stream.send(0, emissionOf({1}));
  stream.send(3, stateAt(36, -84));
  const Recording r = stream.finish();
  ASSERT_EQ(r.beams.size(), 1u);
  EXPECT_EQ(r.objects[r.beams[0].object].name, "VIPER");
}

TEST(DisRecorder, RadiatedPowerAbove200DbmIsWatts) {
  Stream stream;
  stream.send(0, stateAt(36, -84));
  Emission emission = emissionOf({1});
  emission.systems[0].beams[0].erp_dbm = 70000;
  stream.send(1, emission);
  const Recording r = stream.finish();
  EXPECT_NEAR(r.beams.at(0).states.at(0).erp_dbm, 78.45, 0.01);
  EXPECT_THAT(r.tally.notes.at(0), HasSubstr("above 200 dBm; it is taken as watts"));
}

TEST(DisRecorder, SearchBeamWithoutSweepTurnsAllAroundATrackingBeamDoesNot) {
  for (const int function : {1, 4}) {
    Stream stream;
    stream.send(0, stateAt(36, -84));
    Emission emission = emissionOf({1});
    emission.systems[0].beams[0].function = static_cast<std::uint8_t>(function);
    stream.send(1, emission);
    EXPECT_EQ(stream.finish().beams.at(0).states.at(0).azimuth_half_sweep_deg, function == 1 ? 180 : 0);
  }
}

TEST(DisRecorder, TransmitterIsOnWhileItTransmits) {
  Stream stream;
  stream.send(0, stateAt(36, -84));
  Transmitter transmitter;
  transmitter.entity = {1, 1, 7};
  transmitter.radio = 2;
  transmitter.frequency_hz = 243000000;
  transmitter.power_dbm = 40;
  double time_s = 1;
  for (const int state : {1, 2, 1}) {
    transmitter.state = static_cast<std::uint8_t>(state);
    stream.send(time_s++, transmitter);
  }
  const Recording r = stream.finish();
  ASSERT_EQ(r.beams.size(), 1u);
  EXPECT_EQ(r.beams[0].name, "radio 2");
  EXPECT_EQ(switches(r.beams[0]), (std::vector<bool>{true, false}));
}

TEST(DisRecorder, SendersClockIsUsedWhereItAgreesWithTheArrivals) {
  Stream stream;
  stream.sendAt(100, 3599.5, stateAt(36, -84));
  stream.sendAt(101, 3600.25, stateAt(36.001, -84));  // wraps to 0.25
  stream.sendAt(110, 9, stateAt(36.002, -84));
  const Recording r = stream.finish();
  const auto& poses = r.objects.at(0).poses;
  ASSERT_EQ(poses.size(), 3u);
  EXPECT_NEAR(poses[1].t_s, 0.75, 1e-5);
  EXPECT_NEAR(poses[2].t_s, 9.5, 1e-5);
  EXPECT_TRUE(r.tally.notes.empty());
}

TEST(DisRecorder, AReplayFasterThanItsTimestampsLosesNothingAndIsTimedByItsArrivals) {
  for (const double rate : {2.0, 5.0, 100.0}) {
    Stream stream;
    for (int i = 0; i < 200; ++i) {
      const double arrival_s = 7 + 0.1 * i + (i % 3 == 1 ? 0.02 : 0);
      stream.sendAt(arrival_s, 10 + rate * 0.1 * i, stateAt(36 + 0.001 * i, -84));
    }
    const Recording r = stream.finish();
    const auto& poses = r.objects.at(0).poses;
    ASSERT_EQ(poses.size(), 200u) << rate;
    for (std::size_t i = 1; i < poses.size(); ++i) {
      EXPECT_GT(poses[i].t_s, poses[i - 1].t_s) << rate;
      EXPECT_NEAR(poses[i].t_s, 0.1 * static_cast<double>(i), 0.13) << rate;
    }
    ASSERT_EQ(r.tally.notes.size(), 1u) << rate;
    EXPECT_THAT(r.tally.notes[0], HasSubstr("do not agree with their arrivals")) << rate;
  }
}

TEST(DisRecorder, ArrivalsAreUsedWhereTimestampsAreACounter) {
  Stream stream;
  for (int i = 0; i < 10; ++i) stream.sendAt(5 * i, 1e-6 * i, stateAt(36 + 0.001 * i, -84));
  const Recording r = stream.finish();
  EXPECT_NEAR(r.objects.at(0).poses.back().t_s, 45, 1e-9);
  EXPECT_THAT(r.tally.notes.at(0), HasSubstr("do not agree with their arrivals"));
}

TEST(DisRecorder, PathBetweenStatesIsTheReckonedOne) {
  // A turn of 9 deg/s at 200 m/s: in 4 s the chord is up to 160 m inside the arc.
  Stream stream;
  EntityState state = stateAt(36, -84);
  state.algorithm = 7;
  state.velocity_mps = {200, 0, 0};
  state.turn_radps = {0, 0, 0.157};
  stream.send(0, state);
  const ReckonedPose after = reckonedPose(state, 4);
  EntityState next = state;
  next.position_m = after.position_m;
  next.orientation_rad = eulerOf(after.axes);
  stream.send(4, next);
  const Recording r = stream.finish();
  const PoseSample middle = poseAt(r.objects.at(0), 2);
  const GeodeticPosition expected = fromEcef(reckonedPose(state, 2).position_m);
  EXPECT_NEAR(middle.latitude_deg, expected.latitude_deg, 2 / 111e3);
  EXPECT_NEAR(middle.longitude_deg, expected.longitude_deg, 2 / 90e3);
}

TEST(DisRecorder, SeveralPdusOfADatagramAreTakenAndBadOnesCounted) {
  DisRecorder recorder{ReadOptions{}};
  std::vector<std::uint8_t> bytes = encode(Header{}, stateAt(36, -84));
  EntityState nowhere = stateAt(36, -84);
  nowhere.position_m = {};
  const auto bad = encode(Header{}, nowhere);
  bytes.insert(bytes.end(), bad.begin(), bad.end());
  recorder.take({0, bytes.data(), bytes.size()});
  const std::string other = "this is no PDU at all";
  recorder.take({1, reinterpret_cast<const std::uint8_t*>(other.data()), other.size()});
  const Recording r = recorder.finish();
  EXPECT_EQ(r.tally.records, 2);
  EXPECT_EQ(r.tally.bad, 1);
  EXPECT_THAT(r.tally.first_bad,
              HasSubstr("PDU 2: an Entity State PDU whose position is not near the earth"));
  EXPECT_EQ(r.tally.ignored.at("datagrams other than DIS"), 1);
}

TEST(DisRecorder, OfSeveralExercisesTheFirstOrTheChosenOneIsReadAndTheOthersAreTold) {
  const auto read = [](const ReadOptions& options) {
    DisRecorder recorder(options);
    for (int i = 0; i < 10; ++i) {
      auto bytes = test::pduAt(7, 0.5 * i, stateAt(36 + 0.02 * (i % 2) + 1e-4 * i, -84));
      bytes[1] = static_cast<std::uint8_t>(1 + i % 2);  // the exercise
      recorder.take({0.5 * i, bytes.data(), bytes.size()});
    }
    return recorder.finish();
  };
  const Recording first = read({});
  ASSERT_EQ(first.objects.size(), 1u);
  EXPECT_EQ(first.objects[0].poses.size(), 5u);
  EXPECT_LT(first.objects[0].poses.back().latitude_deg, 36.01);
  EXPECT_THAT(first.tally.notes,
              testing::Contains(
                  HasSubstr("5 PDUs of exercise 2 are not used, only those of exercise 1: --exercise 2")));
  ReadOptions options;
  options.exercise = 2;
  EXPECT_GT(read(options).objects.at(0).poses.front().latitude_deg, 36.01);
}

TEST(DisRecordings, PublicLogsHaveTheirEntities) {
  if (!test::referenceFile("interop/dis/kdis_log1.log")) GTEST_SKIP() << test::notInRepository("interop/dis");
  const auto read = [](const std::string& name) {
    return readRecording(*test::referenceFile("interop/dis/" + name));
  };
  const Recording log = read("kdis_log2.log"), capture = read("kdis_log2.pcap");
  EXPECT_EQ(log.objects.size(), 22u);
  EXPECT_EQ(log.tally.records, 759);
  EXPECT_EQ(log.tally.bad, 0) << log.tally.first_bad;
  EXPECT_EQ(log.format, "DIS version 5");
  EXPECT_FALSE(log.epoch_ms);
  ASSERT_EQ(capture.objects.size(), 22u);
  EXPECT_TRUE(capture.epoch_ms);
  for (std::size_t i = 0; i < log.objects.size(); ++i)
    EXPECT_EQ(log.objects[i].poses.size(), capture.objects[i].poses.size()) << i;
  EXPECT_EQ(read("kdis_log1.log").objects.size(), 3u);
  const Recording session = read("disco_dislocator-test.session");
  EXPECT_EQ(session.objects.size(), 2u);
  EXPECT_THAT(session.tally.torn, HasSubstr("within"));
}

}  // namespace
}  // namespace emscape::interop::dis
