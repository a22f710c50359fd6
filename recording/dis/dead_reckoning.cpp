#include "recording/dis/dead_reckoning.h"

#include <cmath>

namespace emscape::interop::dis {
namespace {

/// Below this turn (rad) the closed forms lose digits to cancellation, and their series are used.
constexpr double kSmallTurn_rad = 0.02;

/// c1 v + c2 w x v + c3 (w . v) w
Vec3d combined(const Vec3d& v, const Vec3d& w, double c1, double c2, double c3) {
  return v * c1 + cross(w, v) * c2 + w * (c3 * dot(w, v));
}

/// Integral over 0..t of the rotation about w applied to v: R1 v.
Vec3d integrated(const Vec3d& v, const Vec3d& w, double t_s) {
  const double rate = length(w), turn = rate * t_s;
  if (std::abs(turn) < kSmallTurn_rad) {
    const double q = turn * turn, t2 = t_s * t_s;
    return combined(v, w, t_s * (1 - q / 6 * (1 - q / 20)), t2 / 2 * (1 - q / 12 * (1 - q / 30)),
                    t2 * t_s / 6 * (1 - q / 20 * (1 - q / 42)));
  }
  const double sine = std::sin(turn), cosine = std::cos(turn);
  return combined(v, w, sine / rate, (1 - cosine) / (rate * rate), (turn - sine) / (rate * rate * rate));
}

/// Integral over 0..t of the rotation about w applied to a times the time: R2 a.
Vec3d integratedWithTime(const Vec3d& a, const Vec3d& w, double t_s) {
  const double rate = length(w), turn = rate * t_s;
  if (std::abs(turn) < kSmallTurn_rad) {
    const double q = turn * turn, t2 = t_s * t_s;
    return combined(a, w, t2 / 2 * (1 - q / 4 * (1 - q / 18)), t2 * t_s / 3 * (1 - q / 10 * (1 - q / 28)),
                    t2 * t2 / 8 * (1 - q / 18 * (1 - q / 40)));
  }
  const double sine = std::sin(turn), cosine = std::cos(turn), rate2 = rate * rate;
  return combined(a, w, (cosine + turn * sine - 1) / rate2, (sine - turn * cosine) / (rate2 * rate),
                  (turn * turn / 2 - cosine - turn * sine + 1) / (rate2 * rate2));
}

/// A vector of the body after the turn, in the body's axes before it.
Vec3d turned(const Vec3d& v, const Vec3d& w, double t_s) {
  const double rate = length(w);
  if (rate == 0) return v;
  const double turn = rate * t_s, half = std::sin(turn / 2);
  return combined(v, w, std::cos(turn), std::sin(turn) / rate, 2 * half * half / (rate * rate));
}

}  // namespace

ReckonedPose reckonedPose(const EntityState& state, double t_s) {
  const int algorithm = state.algorithm;
  ReckonedPose pose{state.position_m, axesOf(state.orientation_rad)};
  if (algorithm < 2 || algorithm > 9) return pose;
  const bool accelerates = algorithm == 4 || algorithm == 5 || algorithm == 8 || algorithm == 9;
  const BodyAxes before = pose.axes;
  if (algorithm <= 5) {
    pose.position_m = pose.position_m + state.velocity_mps * t_s;
    if (accelerates) pose.position_m = pose.position_m + state.acceleration_mps2 * (t_s * t_s / 2);
  } else {
    Vec3d way_m = integrated(state.velocity_mps, state.turn_radps, t_s);
    if (accelerates) way_m = way_m + integratedWithTime(state.acceleration_mps2, state.turn_radps, t_s);
    pose.position_m = pose.position_m + before.toWorld(way_m);
  }
  const bool turns = algorithm == 3 || algorithm == 4 || algorithm == 7 || algorithm == 8;
  if (turns) {
    pose.axes.x = before.toWorld(turned({1, 0, 0}, state.turn_radps, t_s));
    pose.axes.y = before.toWorld(turned({0, 1, 0}, state.turn_radps, t_s));
    pose.axes.z = before.toWorld(turned({0, 0, 1}, state.turn_radps, t_s));
  }
  return pose;
}

}  // namespace emscape::interop::dis
