// Discontinuities: models are evaluated over range, height and azimuth in small steps over real terrain.
// Where a loss changes much over a step, the step is halved repeatedly: a slope flattens, a jump stays.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "emfield/ground/ground_posts.h"
#include "emscape/base/units.h"
#include "emscape/emfield/link/path_profile.h"
#include "propagation/air/gases.h"
#include "propagation/diffraction/edges.h"
#include "propagation/itm/itm.h"
#include "propagation/p528/p528.h"
#include "propagation/two_ray/two_ray.h"
#include "tests/emfield/random_profile.h"

namespace emscape::emfield {
namespace {

using namespace propagation;

using namespace emscape::emfield::testing;

constexpr double kFrequencies_hz[] = {1e8, 1e9, 1e10};
constexpr double kMastAgl_m = 15;
/// J(nu) itself begins with 0.02 dB, to which Bullington's correction adds its part.
constexpr double kMinJump_db = 0.1;

struct Jump {
  double before = 0, after = 0;  ///< adjacent positions
  double size_db = 0;
};

/// The jumps of more than `least_db` of a loss between two positions.
std::vector<Jump> jumpsOf(const std::function<double(double)>& loss_db, double begin, double end, int steps,
                          double least_db) {
  std::vector<Jump> jumps;
  double before = loss_db(begin);
  for (int i = 1; i <= steps; ++i) {
    double low = begin + (end - begin) * (i - 1) / steps, high = begin + (end - begin) * i / steps;
    double at_low = before, at_high = loss_db(high);
    before = at_high;
    for (int half = 0; half < 26 && std::abs(at_high - at_low) > least_db; ++half) {
      const double middle = (low + high) / 2, at_middle = loss_db(middle);
      if (std::abs(at_middle - at_low) > std::abs(at_high - at_middle)) {
        high = middle;
        at_high = at_middle;
      } else {
        low = middle;
        at_low = at_middle;
      }
    }
    if (std::abs(at_high - at_low) > least_db) jumps.push_back({low, high, at_high - at_low});
  }
  return jumps;
}

/// A path from a fixed site in the White Mountains.
class Walk {
 public:
  /// @param at_crossings  see readPathProfile()
  Walk(scenario::TerrainPtr terrain, bool at_crossings)
      : terrain_(std::move(terrain)), at_crossings_(at_crossings) {
    site_.position = {44.43, -71.47, 0};
    site_.height_msl_m = terrain_->heightMsl_m(44.43, -71.47) + kMastAgl_m;
    site_.position.height_ellipsoid_m = site_.height_msl_m;
  }

  PathProfile to(double azimuth_rad, double range_m, double height_msl_m) const {
    PathEnd end{
        geodesicDirect(site_.position.latitude_deg, site_.position.longitude_deg, azimuth_rad, range_m),
        height_msl_m};
    end.position.height_ellipsoid_m = height_msl_m;
    return readPathProfile(site_, end, 4.0 / 3, terrain_.get(), at_crossings_);
  }

  using Path = std::function<PathProfile(double)>;
  struct Way {
    const char* name;
    Path path;
    double begin, end;
    int steps;
  };
  /// Over range, height (m) and azimuth (rad).
  std::vector<Way> ways() const {
    const double azimuth = degToRad(70.0);
    return {{"range", [=](double range_m) { return to(azimuth, range_m, 900); }, 4000, 16000, 500},
            {"height", [=](double height_m) { return to(azimuth, 14000, height_m); }, 700, 2600, 400},
            {"azimuth", [=](double bearing) { return to(bearing, 14000, 1000); }, 0, 2 * kPi, 700}};
  }

  /// Walks every way; `explain` gets each jump and returns whether it is inherent to the model.
  template <class Loss, class Explain>
  void expectJumpsAreOnly(const Loss& loss_db, const Explain& explain) const {
    for (const Way& way : ways()) {
      const auto along = [&](double at) { return loss_db(way.path(at)); };
      for (const Jump& jump : jumpsOf(along, way.begin, way.end, way.steps, kMinJump_db)) {
        EXPECT_TRUE(explain(way.path(jump.before), way.path(jump.after)))
            << way.name << ": " << jump.size_db << " dB at " << jump.before;
      }
    }
  }
  template <class Loss>
  void expectNoJumps(const Loss& loss_db) const {
    expectJumpsAreOnly(loss_db, [](const PathProfile&, const PathProfile&) { return false; });
  }

 private:
  scenario::TerrainPtr terrain_;
  bool at_crossings_;
  PathEnd site_;
};

TerrainProfile viewOf(const PathProfile& profile) {
  return {profile.ranges_m.data(), profile.ground_msl_m.data(), profile.count()};
}

DiffractionModel<double> diffractionAt(double frequency_hz, const PathProfile& profile) {
  DiffractionParameters parameters;
  parameters.frequency_hz = frequency_hz;
  parameters.effective_earth_radius_m = profile.effective_earth_radius_m;
  return diffractionModel<double>(parameters);
}

class ModelContinuity : public ::testing::Test {
 protected:
  const scenario::TerrainPtr terrain_ = whiteMountainsTile();
};

TEST_F(ModelContinuity, DiffractionHasNoJumps) {
  const Walk walk(terrain_, true);
  for (const double frequency_hz : kFrequencies_hz) {
    SCOPED_TRACE(frequency_hz);
    walk.expectNoJumps([&](const PathProfile& profile) {
      return deltaBullington(diffractionAt(frequency_hz, profile), viewOf(profile),
                             profile.begin.height_msl_m, profile.end.height_msl_m)
          .loss_db;
    });
  }
}

/// The far end, raised above its ground as the field does it.
double raisedEnd_m(const PathProfile& profile) {
  return DiffractionModel<double>::raised_m(profile.end.height_msl_m,
                                            static_cast<double>(profile.ground_msl_m.back()));
}

TEST_F(ModelContinuity, SingleEdgeHasNoJumps) {
  const Walk walk(terrain_, false);
  for (const double frequency_hz : kFrequencies_hz) {
    SCOPED_TRACE(frequency_hz);
    walk.expectNoJumps([&](const PathProfile& profile) {
      return singleEdgeLossDb(diffractionAt(frequency_hz, profile), viewOf(profile),
                              profile.begin.height_msl_m, raisedEnd_m(profile));
    });
  }
}

/// Where another post becomes the main edge, the edges on both sides change, too.
TEST_F(ModelContinuity, DeygoutJumpsOnlyWhereMainEdgeChanges) {
  const Walk walk(terrain_, false);
  for (const double frequency_hz : kFrequencies_hz) {
    SCOPED_TRACE(frequency_hz);
    const auto mainPost_m = [&](const PathProfile& profile) {
      const int post = mainEdge(diffractionAt(frequency_hz, profile), viewOf(profile), 0,
                                profile.begin.height_msl_m, profile.count() - 1, raisedEnd_m(profile))
                           .post;
      return profile.ranges_m[static_cast<std::size_t>(post)];
    };
    walk.expectJumpsAreOnly(
        [&](const PathProfile& profile) {
          return deygoutLossDb(diffractionAt(frequency_hz, profile), viewOf(profile),
                               profile.begin.height_msl_m, raisedEnd_m(profile));
        },
        [&](const PathProfile& a, const PathProfile& b) { return mainPost_m(a) != mainPost_m(b); });
  }
}

/// ITM's link of a path and its result.
ItmResult<double> itmOver(const PathProfile& profile, double frequency_hz) {
  constexpr int kIntervals = 150;
  static thread_local std::vector<float> even;
  even.clear();
  std::size_t after = 1;
  for (int i = 0; i <= kIntervals; ++i) {
    const double at_m = profile.range_m * i / kIntervals;
    while (after + 1 < profile.ranges_m.size() && profile.ranges_m[after] < at_m) ++after;
    const double part =
        (at_m - profile.ranges_m[after - 1]) / (profile.ranges_m[after] - profile.ranges_m[after - 1]);
    even.push_back(profile.ground_msl_m[after - 1] +
                   static_cast<float>(part) *
                       (profile.ground_msl_m[after] - profile.ground_msl_m[after - 1]));
  }
  ItmLink<double> link;
  link.frequency_hz = frequency_hz;
  link.height_agl_m[0] = kMastAgl_m;
  link.height_agl_m[1] = std::max(profile.end.height_msl_m - static_cast<double>(even.back()), 1.0);
  return itmPointToPoint(ItmProfile<float>{even.data(), kIntervals, profile.range_m / kIntervals}, link,
                         ItmQuantiles<double>());
}

/// True if ITM branches differently on two adjacent paths: another mode, another post as a horizon, found
/// instead of estimated horizons, or an irregularity from another number of posts.
bool takesAnotherCourse(const ItmResult<double>& a, const ItmResult<double>& b) {
  bool other = a.mode != b.mode ||
               std::abs(a.path.irregularity_m - b.path.irregularity_m) > 1e-3 * a.path.irregularity_m;
  for (int end : {0, 1}) {
    const auto& of_a = a.path.terminal[end];
    const auto& of_b = b.path.terminal[end];
    other = other || std::abs(of_a.horizon_distance_m - of_b.horizon_distance_m) > 1 ||
            std::abs(of_a.effective_height_m - of_b.effective_height_m) > 0.01;
  }
  return other;
}

TEST_F(ModelContinuity, ItmJumpsOnlyWhereItsBranchChanges) {
  const Walk walk(terrain_, false);
  for (const double frequency_hz : kFrequencies_hz) {
    SCOPED_TRACE(frequency_hz);
    const auto over = [&](const PathProfile& profile) { return itmOver(profile, frequency_hz); };
    walk.expectJumpsAreOnly(
        [&](const PathProfile& profile) { return over(profile).loss_db; },
        [&](const PathProfile& a, const PathProfile& b) { return takesAnotherCourse(over(a), over(b)); });
  }
}

TEST(ModelContinuityOverTheSea, TwoRaysHaveNoJumps) {
  for (const double frequency_hz : kFrequencies_hz) {
    TwoRayParameters parameters;
    parameters.frequency_hz = frequency_hz;
    parameters.effective_earth_radius_m = 6371000 * 4.0 / 3;
    parameters.ground = groundConstants(GroundKind::sea, frequency_hz);
    parameters.roughness_m = 0.2;
    const auto model = twoRayModel<double>(parameters);
    const auto over_range = [&](double range_m) { return twoRayExcessDb(model, range_m, 20.0, 60.0); };
    EXPECT_TRUE(jumpsOf(over_range, 200, 90e3, 20000, 0.1).empty()) << frequency_hz;
    const auto over_height = [&](double height_m) { return twoRayExcessDb(model, 40e3, 20.0, height_m); };
    EXPECT_TRUE(jumpsOf(over_height, 1, 5000, 20000, 0.1).empty()) << frequency_hz;
  }
}

/// P.528 has steps at its own transitions: less than a decibel between an antenna near the ground and an
/// aircraft.
TEST(ModelContinuityOverTheSea, P528StepsByLessThanADecibel) {
  for (const double frequency_hz : {2e8, 1e9, 1e10}) {
    const auto atmosphere = std::make_shared<const P528Atmosphere>(frequency_hz);
    const P528Curve curve(atmosphere, frequency_hz, 15, 10000);
    const auto jumps =
        jumpsOf([&](double range_m) { return curve.at(range_m, 50).loss_db; }, 10e3, 900e3, 900, 0.1);
    EXPECT_LE(jumps.size(), 4u) << frequency_hz;
    for (const Jump& jump : jumps)
      EXPECT_LT(std::abs(jump.size_db), 1) << frequency_hz << ", " << jump.before;
  }
}

TEST(ModelContinuityOverTheSea, GasesHaveNoJumpsOverHeight) {
  for (const double frequency_hz : {1e10, 2.2e10, 6e10}) {
    const auto loss = [&](double height_m) {
      return gasAttenuation(frequency_hz, standardAtmosphere(height_m)).total_db_per_km();
    };
    // the minimum mixing ratio of vapour, and the layers of the standard atmosphere, cause kinks
    EXPECT_TRUE(jumpsOf(loss, 0, 30e3, 3000, 1e-4 * loss(0)).empty()) << frequency_hz;
  }
}

}  // namespace
}  // namespace emscape::emfield
