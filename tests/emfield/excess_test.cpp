// Excess loss in the field: storage, and diffraction compared with the model path by path.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "emfield/columns/excess_code.h"
#include "emfield/geometry/emitter_geometry.h"
#include "emscape/base/error.h"
#include "propagation/diffraction/diffraction.h"
#include "scenario/terrain/view.h"
#include "tests/emfield/excess_paths.h"

namespace emscape::emfield {
namespace {

using namespace emscape::emfield::testing;
using namespace propagation;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(ExcessCode, KeepsDecibelsToHalfAStepAndSaturates) {
  for (const float db : {-12.34f, -0.003f, 0.0f, 0.5f, 99.991f, 255.9f}) {
    EXPECT_NEAR(excessDb(excessCode(db)), db, 1 / 256.0 + 1e-5) << db;
    EXPECT_NEAR(-ratioToDb(static_cast<double>(excessFactor(excessCode(db)))), db, 1 / 256.0 + 1e-4) << db;
  }
  EXPECT_EQ(excessDb(excessCode(1000.0f)), kMaxExcess_db);
  EXPECT_EQ(excessDb(excessCode(-1000.0f)), -kMaxExcess_db);
  EXPECT_EQ(excessDb(excessCode(HUGE_VALF)), kMaxExcess_db);
  EXPECT_EQ(excessCode(NAN), kUnknownExcess);
  EXPECT_EQ(excessFactor(kUnknownExcess), 0.0f);
}

TEST(Excess, DiffractionInTheFieldAgreesWithTheModelPathByPathOverRealTerrain) {
  const scenario::TerrainPtr terrain = whiteMountainsTile();
  for (const FrameKind frame : {FrameKind::altitude, FrameKind::enu}) {
    for (const double frequency_hz : {100e6, 1e9, 10e9}) {
      SCOPED_TRACE(::testing::Message() << toString(frame) << ", " << frequency_hz << " Hz");
      const auto scenario = whiteMountains(frequency_hz, 15, frame);
      const auto volume = solve(scenario, terrain);
      const scenario::EmitterState state = scenario::snapshotAt(scenario, terrain.get(), 0).emitters[0];
      DiffractionParameters parameters;
      parameters.frequency_hz = frequency_hz;
      parameters.effective_earth_radius_m = kEffectiveEarth_m;
      parameters.polarization = LinearPolarization::vertical;
      parameters.land = groundConstants(scenario->ground, frequency_hz);
      const auto model = diffractionModel<double>(parameters);
      const GeoFrame geo(volume->grid.frame);

      std::mt19937 random(7);
      Spread spread;
      while (spread.size() < 400) {
        const int i = int(random() % 50), j = int(random() % 50), k = int(random() % 40);
        const Vec3d center = volume->grid.center_m(i, j, k);
        const GeodeticPosition to = geo.toGeodetic(center);
        const double to_msl_m = geo.heightMsl_m(center);
        if (to_msl_m < terrain->heightMsl_m(to.latitude_deg, to.longitude_deg) + 1) continue;
        const ProfileData profile = profileTo(*terrain, state.position, to, true);
        const double expected = deltaBullington(model, profile.view(), state.height_msl_m, to_msl_m).loss_db;
        spread.add(excessIn(*volume, i, j, k, state.position) - expected);
      }
      EXPECT_LT(spread.quantile(0.9), 0.01);
      EXPECT_LT(spread.quantile(0.99), 0.1);
      EXPECT_LT(spread.largest(), 0.5);
    }
  }
}

TEST(Excess, SmoothEarthBeyondTheHorizonHasTheSphericalEarthsLoss) {
  for (const double frequency_hz : {100e6, 3e9}) {
    const auto scenario = smoothEarth(PropagationModel::diffraction, frequency_hz, 10, 200e3);
    const auto volume = solve(scenario);
    const GeodeticPosition from = scenario::snapshotAt(scenario, nullptr, 0).emitters[0].position;
    SphericalEarth<double> earth;
    earth.earth_radius_m = kEffectiveEarth_m;
    earth.wavelength_m = wavelength_m(frequency_hz);
    earth.sea_fraction = 0;
    earth.land = firstTermGround<double>(frequency_hz, groundConstants(scenario->ground, frequency_hz),
                                         LinearPolarization::vertical);
    int beyond = 0;
    for (int i = 0; i < 20; ++i) {
      for (int j = 0; j < 21; ++j) {
        const Vec3d center = volume->grid.center_m(i, j, 0);
        const double range_m = std::hypot(center.x, center.y);
        if (range_m < 1.2 * std::sqrt(2 * kEffectiveEarth_m) * (std::sqrt(10) + std::sqrt(center.z)))
          continue;
        ++beyond;
        const double expected = earth.firstTermDb(range_m, 10, center.z, kEffectiveEarth_m);
        EXPECT_NEAR(excessIn(*volume, i, j, 0, from), expected, 0.3 + 2e-3 * expected) << range_m;
      }
    }
    EXPECT_GT(beyond, 20);
  }
}

TEST(Excess, TakesMemoryOnlyWhereAModelHasOne) {
  auto scenario = smoothEarth(PropagationModel::free_space, 1e9, 20);
  const std::size_t columns = 20 * 21;
  const auto bytesOf = [&] {
    return EmitterGeometry::bytesOf(*scenario, scenario->emitters[0], columns, 32);
  };
  for (const auto model : {PropagationModel::free_space, PropagationModel::horizon}) {
    scenario->emitters[0].propagation.model = model;
    EXPECT_EQ(bytesOf(), columns * 40);
    scenario->atmosphere.rain_mm_h = 5;
    EXPECT_EQ(bytesOf(), columns * (40 + 2 * 32));
    scenario->atmosphere.rain_mm_h = 0;
  }
  scenario->emitters[0].propagation.model = PropagationModel::diffraction;
  EXPECT_EQ(bytesOf(), columns * (40 + 2 * 32));
  addEmitter(*scenario, {52, 5, 100}, plainEmitter("free", 0));
  SolvedField solver(scenario);
  EXPECT_EQ(solver.memoryUse().bytes_per_voxel_and_emitter, 1) << "one of two";
}

TEST(Excess, AnEmitterBeyondTheMemoryBoundHasTheSameField) {
  const auto scenario = smoothEarth(PropagationModel::diffraction, 1e9, 20, 100e3);
  FieldOptions options;
  options.cache_bytes = 100;
  EXPECT_EQ(solve(scenario)->values, solve(scenario, nullptr, options)->values);
}

TEST(Excess, TurningBeamIsCombinedAndMovingOneComputedAgain) {
  const auto scenario = smoothEarth(PropagationModel::diffraction, 1e9, 20, 100e3);
  scenario->emitters[0].antenna = scenario::makeGaussian(30, 5, 10, -40);
  scenario->emitters[0].scan.kind = scenario::ScanKind::rotate;
  scenario->emitters[0].scan.rate_rpm = 10;
  FieldSolver solver(scenario, nullptr, {});
  scenario::Snapshot snapshot = scenario::snapshotAt(scenario, nullptr, 0);
  solver.update(snapshot);
  EXPECT_GT(solver.stageTimes().excess_ms, 0);

  const FieldChanged turned = solver.update(scenario::snapshotAt(scenario, nullptr, 1));
  EXPECT_THAT(turned.moved, IsEmpty());
  EXPECT_THAT(turned.turned, ElementsAre(0));
  EXPECT_EQ(solver.stageTimes().excess_ms, 0);
  EXPECT_EQ(solver.stageTimes().columns_ms, 0);

  snapshot = scenario::snapshotAt(scenario, nullptr, 1);
  snapshot.emitters[0].position.latitude_deg += 0.01;
  EXPECT_THAT(solver.update(snapshot).moved, ElementsAre(0));
  EXPECT_GT(solver.stageTimes().excess_ms, 0);
}

TEST(Excess, CountsOnceInPowerDensityAndTwiceInRadarSnr) {
  const auto scenario = smoothEarth(PropagationModel::free_space, 10e9, 20);
  scenario->emitters[0].kind = scenario::EmitterKind::radar;
  const auto solved = [&](const char* quantity) {
    scenario->output.quantities = {quantity};
    return solve(scenario)->values;
  };
  const auto clear_power = solved("power_density_dbwm2"), clear_snr = solved("snr_db");
  scenario->atmosphere.rain_mm_h = 20;
  const auto rainy_power = solved("power_density_dbwm2"), rainy_snr = solved("snr_db");
  for (std::size_t v = 0; v < clear_power.size(); v += 37) {
    EXPECT_NEAR(clear_snr[v] - rainy_snr[v], 2 * (clear_power[v] - rainy_power[v]), 1e-3);
  }
}

/// Flat ground at 0 m, with a hole south of a parallel.
class GroundWithAHole : public scenario::Terrain {
 public:
  explicit GroundWithAHole(double hole_south_deg, double hole_north_deg)
      : south_deg_(hole_south_deg), north_deg_(hole_north_deg) {
    constexpr int kPosts = 201;
    heights_.assign(kPosts * kPosts, 0.0f);
    raster_.columns = raster_.rows = kPosts;
    raster_.south_rad = degToRad(51.5);
    raster_.west_rad = degToRad(4.5);
    raster_.posts_per_rad_lat = raster_.posts_per_rad_lon = (kPosts - 1) / degToRad(1.0);
    raster_.last_column = raster_.last_row = kPosts - 1;
    for (int row = 0; row < kPosts; ++row) {
      const double latitude_deg = 51.5 + row / 200.0;
      if (latitude_deg < south_deg_ || latitude_deg > north_deg_) continue;
      std::fill_n(heights_.begin() + row * kPosts, kPosts, NAN);
    }
    raster_.heights_msl_m = heights_.data();
  }
  double heightMsl_m(double latitude_deg, double longitude_deg) const override {
    return static_cast<double>(raster_.heightAt(degToRad(latitude_deg), degToRad(longitude_deg)));
  }
  scenario::TerrainView view() const override { return {&raster_, 1}; }
  double postSpacing_m() const override { return 350; }
  long long voidPosts() const override { return 0; }
  double uncoveredFraction() const override { return 0; }
  scenario::GeoBox box() const override { return {51.5, 52.5, 4.5, 5.5}; }
  scenario::GeoBox coverage() const override { return box(); }
  double lowest_m() const override { return 0; }
  double highest_m() const override { return 0; }

 private:
  double south_deg_, north_deg_;
  std::vector<float> heights_;
  scenario::TerrainRaster raster_;
};

TEST(Excess, MissingTerrainIsAnErrorOrAHoleAndNeverSeaLevel) {
  for (const auto model : {PropagationModel::diffraction, PropagationModel::itm}) {
    const auto scenario = smoothEarth(model, 1e9, 20);
    scenario->terrain = scenario::TerrainSpec{};
    const auto terrain = std::make_shared<GroundWithAHole>(51.9, 51.92);
    EXPECT_THROW(solve(scenario, terrain), Error);
    FieldOptions options;
    options.allow_missing_terrain = true;
    SolvedField solver(scenario, terrain, options);
    const auto volume = solver.volumes().front().host();
    ASSERT_FALSE(volume->first_valid_k.empty());
    EXPECT_EQ(volume->first_valid_k[10], 32) << "beyond the hole nothing is known";
    EXPECT_LT(volume->first_valid_k[20 * 20 + 10], 32) << "on the emitter's side all is";
    EXPECT_EQ(valueAt(*volume, 10, 0, 10), scenario->output.floor);
    EXPECT_THAT(solver.warnings(), ::testing::Contains(HasSubstr("seen across missing terrain")));
  }
}

}  // namespace
}  // namespace emscape::emfield
