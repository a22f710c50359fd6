// Dead reckoning against its differential equation and against recordings; orientations.
#include "recording/dis/dead_reckoning.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "emscape/base/units.h"
#include "recording/dis/datagrams.h"
#include "tests/support/reference_data.h"

namespace emscape::interop::dis {
namespace {

EntityState turningState(int algorithm, double turn_radps) {
  EntityState state;
  state.position_m = {4e6, 3e6, 4e6};
  state.orientation_rad = {0.7, -0.3, 1.1};
  state.velocity_mps = {200, 15, -8};
  state.acceleration_mps2 = {3, -2, 1};
  state.turn_radps = Vec3d{0.6, -0.48, 0.64} * turn_radps;
  state.algorithm = static_cast<std::uint8_t>(algorithm);
  return state;
}

struct Motion {
  Vec3d position_m, forward, right, down;
};

/// The motion in body axes, integrated in small steps (midpoint rule).
Motion integratedMotion(const EntityState& state, double t_s, bool accelerates) {
  const BodyAxes axes = axesOf(state.orientation_rad);
  Motion motion{state.position_m, axes.x, axes.y, axes.z};
  const int steps = 20000;
  const double dt = t_s / steps;
  const auto rates = [&](const Motion& m) {
    const Vec3d turn =
        m.forward * state.turn_radps.x + m.right * state.turn_radps.y + m.down * state.turn_radps.z;
    return Motion{{}, cross(turn, m.forward), cross(turn, m.right), cross(turn, m.down)};
  };
  for (int i = 0; i < steps; ++i) {
    const Motion rate = rates(motion);
    Motion middle = motion;
    middle.forward = motion.forward + rate.forward * (dt / 2);
    middle.right = motion.right + rate.right * (dt / 2);
    middle.down = motion.down + rate.down * (dt / 2);
    const Vec3d v = state.velocity_mps + (accelerates ? state.acceleration_mps2 * ((i + 0.5) * dt) : Vec3d{});
    motion.position_m =
        motion.position_m + (middle.forward * v.x + middle.right * v.y + middle.down * v.z) * dt;
    const Motion middle_rate = rates(middle);
    motion.forward = motion.forward + middle_rate.forward * dt;
    motion.right = motion.right + middle_rate.right * dt;
    motion.down = motion.down + middle_rate.down * dt;
  }
  return motion;
}

TEST(DeadReckoning, BodyAlgorithmsSolveTheirDifferentialEquation) {
  for (const int algorithm : {6, 7, 8, 9}) {
    for (const double turn_radps : {0.0, 1e-6, 1e-3, 0.0039, 0.0041, 0.05, 0.5}) {
      const EntityState state = turningState(algorithm, turn_radps);
      for (const double t_s : {5.0, -2.0}) {
        const Motion exact = integratedMotion(state, t_s, algorithm >= 8);
        const ReckonedPose pose = reckonedPose(state, t_s);
        EXPECT_LT(length(pose.position_m - exact.position_m), 1e-3) << algorithm << ", " << turn_radps;
        if (algorithm == 7 || algorithm == 8) {
          EXPECT_LT(length(pose.axes.x - exact.forward), 1e-6) << algorithm << ", " << turn_radps;
          EXPECT_LT(length(pose.axes.z - exact.down), 1e-6) << algorithm << ", " << turn_radps;
        }
      }
    }
  }
}

TEST(DeadReckoning, WorldAlgorithmsAreStraightOrParabolic) {
  for (const int algorithm : {1, 2, 3, 4, 5}) {
    const EntityState state = turningState(algorithm, 0.1);
    Vec3d expected = state.position_m;
    if (algorithm >= 2) expected = expected + state.velocity_mps * 3;
    if (algorithm >= 4) expected = expected + state.acceleration_mps2 * 4.5;
    EXPECT_LT(length(reckonedPose(state, 3).position_m - expected), 1e-9) << algorithm;
  }
}

TEST(DeadReckoning, UnknownAlgorithmRests) {
  EXPECT_EQ(reckonedPose(turningState(200, 0.1), 10).position_m, turningState(200, 0.1).position_m);
}

TEST(Orientation, LocalAnglesAreTheSameAfterEulerAngles) {
  for (const double heading : {0.0, 10.0, 135.0, 359.0}) {
    for (const double pitch : {-80.0, -5.0, 0.0, 30.0}) {
      for (const double roll : {-170.0, 0.0, 45.0}) {
        const BodyAxes axes = axesOf(LocalAttitude{heading, pitch, roll}, -36, 151);
        const LocalAttitude back = attitudeOf(axesOf(eulerOf(axes)), -36, 151);
        EXPECT_NEAR(std::remainder(back.heading_deg - heading, 360), 0, 1e-9);
        EXPECT_NEAR(back.pitch_deg, pitch, 1e-9);
        EXPECT_NEAR(back.roll_deg, roll, 1e-9);
      }
    }
  }
}

TEST(Orientation, LevelBodyOnTheEquatorHasTheEulerAnglesOfItsAxes) {
  // At latitude 0 and longitude 0 north is z, east y and up x: heading north is theta = -90 degrees.
  const Vec3d north = eulerOf(axesOf(LocalAttitude{0, 0, 0}, 0, 0));
  EXPECT_NEAR(north.y, -kPi / 2, 1e-6);
  const BodyAxes east = axesOf(LocalAttitude{90, 0, 0}, 0, 0);
  EXPECT_NEAR(east.x.y, 1, 1e-12);
  EXPECT_NEAR(east.z.x, -1, 1e-12) << "z is downwards";
}

/// Median of the distance (m) between the position reckoned from a state and the next state.
double medianError_m(const std::string& name) {
  const auto file = test::referenceFile("interop/dis/" + name);
  if (!file) return -1;
  std::unordered_map<std::uint64_t, std::pair<double, EntityState>> last;
  std::vector<double> errors;
  ReadingTally tally;
  const DatagramSink sink = [&](const Datagram& datagram) {
    const auto header = decodeHeader(datagram.bytes, datagram.size);
    if (!header || header->type != 1) return;
    std::string fault;
    const auto state = decodeEntityState(datagram.bytes, header->length, fault);
    if (!state) return;
    const auto found = last.find(state->id.key());
    if (found != last.end()) {
      const double gap_s = std::fmod(header->seconds() - found->second.first + 3600, 3600);
      if (gap_s > 0 && gap_s < 30)
        errors.push_back(length(reckonedPose(found->second.second, gap_s).position_m - state->position_m));
    }
    last[state->id.key()] = {header->seconds(), *state};
  };
  const auto source = openFile(*file);
  if (name.find(".log") != std::string::npos) {
    readHexLog(*source, tally, sink);
  } else {
    readSession(*source, tally, sink);
  }
  EXPECT_GT(errors.size(), 50u);
  std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2),
                   errors.end());
  return errors[errors.size() / 2];
}

TEST(DeadReckoning, PredictsTheNextStateOfRecordings) {
  if (!test::referenceFile("interop/dis/kdis_log1.log")) GTEST_SKIP() << test::notInRepository("interop/dis");
  EXPECT_LE(medianError_m("kdis_log1.log"), 0.245);
  EXPECT_LE(medianError_m("kdis_log2.log"), 0.365);
  EXPECT_LE(medianError_m("disco_dislocator-test.session"), 0.295);
}

}  // namespace
}  // namespace emscape::interop::dis
