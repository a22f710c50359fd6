// The parabolic equation: transform, air, steps, conservation, reciprocity, terrain, lanes, cells. The
// figures of closed forms and modes are those of `emscape check`.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <vector>

#include "propagation/parabolic_equation/air/path_air.h"
#include "propagation/parabolic_equation/air/refractivity.h"
#include "propagation/parabolic_equation/march/march.h"
#include "propagation/parabolic_equation/march/march_azimuths.h"
#include "propagation/parabolic_equation/march/march_cells.h"
#include "propagation/parabolic_equation/march/march_grid.h"
#include "propagation/parabolic_equation/march/march_step.h"
#include "propagation/parabolic_equation/march/sine_transform.h"
#include "tests/support/errors.h"

namespace emscape::propagation {
namespace {

using testing::HasSubstr;
using Cx = std::complex<double>;

MarchGrid gridOf(double frequency_hz, double height_step_m, int intervals, double range_step_m) {
  MarchGrid grid;
  grid.frequency_hz = frequency_hz;
  grid.intervals = intervals;
  grid.top_m = height_step_m * intervals;
  grid.range_step_m = range_step_m;
  setAbsorber(grid);
  return grid;
}

RadialPath pathOf(double source_m, RefractivityAlongPath air = {}) {
  RadialPath path;
  path.source.height_agl_m = source_m;
  path.air = std::move(air);
  return path;
}

template <class Real>
void marchTo(RadialMarch<Real, 1>& march, double range_m) {
  while (march.range_m() < range_m - 1e-3) march.advance();
}

TEST(SineTransform, EqualsSumOfSinesAndIsSelfInverse) {
  for (const int n : {2, 4, 8, 16, 32, 128}) {
    SineTransform<double, 1> transform(n);
    std::vector<LaneComplex<double, 1>> in(n), out(n), back(n);
    std::vector<Cx> u(n);
    for (int j = 1; j < n; ++j) {
      u[j] = {std::sin(1.0 * j * j), std::cos(3.0 * j)};
      in[j] = {{u[j].real()}, {u[j].imag()}};
    }
    transform(in.data(), out.data());
    for (int k = 1; k < n; ++k) {
      Cx sum = 0;
      for (int j = 1; j < n; ++j) sum += u[j] * std::sin(kPi * j * k / n);
      EXPECT_NEAR(std::abs(sum - Cx(out[k].re[0], out[k].im[0])), 0, 1e-12) << n << ' ' << k;
    }
    transform(out.data(), back.data());
    for (int j = 1; j < n; ++j) EXPECT_NEAR(back[j].re[0] * 2 / n, u[j].real(), 1e-13);
  }
}

TEST(SineTransform, OfFloatIsPreciseToItsRounding) {
  constexpr int kN = 4096;
  SineTransform<float, 1> transform(kN);
  SineTransform<double, 1> exact(kN);
  std::vector<LaneComplex<float, 1>> in(kN), out(kN);
  std::vector<LaneComplex<double, 1>> exact_in(kN), exact_out(kN);
  for (int j = 1; j < kN; ++j) {
    in[j] = {{float(std::sin(0.37 * j * j))}, {float(std::cos(1.1 * j))}};
    exact_in[j] = {{in[j].re[0]}, {in[j].im[0]}};
  }
  transform(in.data(), out.data());
  exact(exact_in.data(), exact_out.data());
  double error = 0, size = 0;
  for (int k = 1; k < kN; ++k) {
    error += std::pow(out[k].re[0] - exact_out[k].re[0], 2) + std::pow(out[k].im[0] - exact_out[k].im[0], 2);
    size += std::pow(exact_out[k].re[0], 2) + std::pow(exact_out[k].im[0], 2);
  }
  EXPECT_LT(std::sqrt(error / size), 4e-7);
}

TEST(Refractivity, IsLinearBetweenLevelsAndContinuesOutside) {
  const RefractivityProfile profile = profileOfLevels({{10, 330}, {20, 320}, {40, 330}});
  EXPECT_DOUBLE_EQ(profile.at(15), 325);
  EXPECT_DOUBLE_EQ(profile.at(30), 325);
  EXPECT_DOUBLE_EQ(profile.at(0), 340);
  EXPECT_DOUBLE_EQ(profile.at(140), 330 + 11.8);
  EXPECT_TRUE(profile.traps());
  EXPECT_FALSE(standardRefractivity().traps());
  EXPECT_NEAR(linearRefractivity(0.2, 300).at(100), 320, 1e-12);
}

TEST(Refractivity, OfTheEvaporationDuctFollowsItsFormula) {
  const RefractivityProfile profile = evaporationDuct(14, 339);
  for (double z = 1e-5; z < 1000; z *= 1.07) {
    EXPECT_NEAR(profile.at(z), 339 + 0.125 * (z - 14 * std::log((z + 1.5e-4) / 1.5e-4)), 1e-3) << z;
  }
  EXPECT_NEAR(profile.at(0) - profile.at(14), 18.3, 0.05);
  EXPECT_NEAR(profile.at(0) - profile.at(1), 15.3, 0.05);
  EXPECT_TRUE(profile.traps());
}

TEST(Refractivity, OfLayersHasTheirDeficit) {
  const RefractivityProfile based = trilinearRefractivity(200, 300, 40, 330);
  EXPECT_NEAR(based.at(200), 353.6, 1e-9);
  EXPECT_NEAR(based.at(300), 313.6, 1e-9);
  EXPECT_NEAR(based.at(400), 313.6 + 11.8, 1e-9);
  const RefractivityProfile surface = surfaceDuct(50, 10, 330);
  EXPECT_NEAR(surface.at(25), 325, 1e-9);
}

TEST(Refractivity, MovesADuctBetweenTwoProfiles) {
  const RefractivityAlongPath levels({0, 1000}, {surfaceDuct(20, 10), surfaceDuct(40, 10)});
  EXPECT_FALSE(levels.pointwise());
  EXPECT_NEAR(levels.at(500).at(30), kSurface_m_units - 10, 1e-9);
  EXPECT_NEAR(levels.at(2000).at(40), kSurface_m_units - 10, 1e-9);
  const RefractivityAlongPath unequal({0, 1000}, {standardRefractivity(), surfaceDuct(40, 10)});
  EXPECT_TRUE(unequal.pointwise());
  EXPECT_NEAR(unequal.at(500).at(40), kSurface_m_units + (0.118 * 40 - 10) / 2, 1e-9);
}

TEST(Refractivity, RefusesInvalidProfiles) {
  const auto refused = [](const std::function<void()>& call) {
    return test::errorOf(call, ErrorCode::bad_input);
  };
  EXPECT_THAT(refused([] { evaporationDuct(61); }), HasSubstr("duct height: 61 m is not in 0 .. 60 m"));
  EXPECT_THAT(refused([] { evaporationDuct(std::nan("")); }), HasSubstr("duct height: nan m"));
  EXPECT_THAT(refused([] { surfaceDuct(0, 10); }),
              HasSubstr("top of the layer: 0 m is not above its base of 0 m"));
  EXPECT_THAT(refused([] { trilinearRefractivity(1, 2, 0); }), HasSubstr("deficit of the layer: 0 M-units"));
  EXPECT_THAT(refused([] { profileOfLevels({{0, 330}}); }), HasSubstr("1 levels; expected 2 .. 256"));
  EXPECT_THAT(refused([] {
                profileOfLevels({{0, 330}, {0, 331}});
              }),
              HasSubstr("level 2: height: 0 m is not above"));
  EXPECT_THAT(refused([] {
                RefractivityAlongPath({1, 1}, {standardRefractivity(), standardRefractivity()});
              }),
              HasSubstr("range 1 m is not above 1 m"));
}

TEST(AutomaticGrid, ContainsRequestedHeightsAndAngleWithReason) {
  MarchNeeds needs;
  needs.frequency_hz = 10e9;
  needs.max_height_m = 300;
  needs.traps = true;
  const AutomaticGrid sea = automaticGrid(needs);
  EXPECT_DOUBLE_EQ(sea.grid.range_step_m, 200);
  EXPECT_GE(0.8 * sea.grid.usableTop_m(), 300);
  EXPECT_GE(0.6 * sea.grid.maxSine(), std::sin(needs.max_angle_rad) * (1 - 1e-12));
  ASSERT_EQ(sea.choices.size(), 4u);
  EXPECT_EQ(sea.choices[3].name, "range step");
  EXPECT_EQ(sea.choices[3].text, "200 m: error of the splitting where a layer traps");
  needs.post_spacing_m = 90;
  EXPECT_EQ(automaticGrid(needs).choices[3].text, "90 m: the terrain's posts");
  needs.post_spacing_m = 30;
  EXPECT_DOUBLE_EQ(automaticGrid(needs).grid.range_step_m, 50);
}

TEST(AutomaticGrid, RefusesExcessiveHeightsAndAngles) {
  const auto refused = [](const MarchNeeds& needs) {
    return test::errorOf([&] { automaticGrid(needs); }, ErrorCode::bad_input);
  };
  MarchNeeds needs;
  needs.frequency_hz = 10e9;
  needs.max_height_m = 20000;
  EXPECT_THAT(refused(needs), HasSubstr("at most 32768, which afford"));
  needs.max_height_m = 100;
  needs.frequency_hz = 10e6;
  EXPECT_THAT(refused(needs), HasSubstr("frequency 10 MHz is outside 30..40000 MHz"));
  needs.frequency_hz = 1e9;
  needs.max_angle_rad = degToRad(40.0);
  EXPECT_THAT(refused(needs), HasSubstr("largest angle 40 degrees is outside"));
  MarchGrid grid = gridOf(1e9, 1, 1000, 100);
  EXPECT_THAT(test::errorOf([&] { checkGrid(grid); }),
              HasSubstr("1000 height steps; expected a power of two"));
  grid = gridOf(1e9, 1, 1024, 100);
  EXPECT_THAT(test::errorOf([&] { RadialMarch<double, 1>(grid, {pathOf(2000)}); }),
              HasSubstr("antenna 2000 m above the ground; expected above 0, up to 896 m"));
  EXPECT_THAT(test::errorOf([&] { RadialMarch<double, 1>(grid, {pathOf(0)}); }),
              HasSubstr("antenna 0 m above"));
  RadialPath holed = pathOf(10);
  holed.ground_msl_m = {1, 2, std::nan("")};
  EXPECT_THAT(test::errorOf([&] { RadialMarch<double, 1>(grid, {holed}); }),
              HasSubstr("no terrain 200 m from"));
}

template <class Real>
double energyRatioAfter1000Steps() {
  MarchGrid grid = gridOf(3e9, 0.5, 512, 100);
  grid.absorber_m = grid.absorber_per_m = 0;
  RadialMarch<Real, 1> march(grid, {pathOf(30, evaporationDuct(14))});
  const double before = march.energy(0);
  for (int i = 0; i < 1000; ++i) march.advance();
  return march.energy(0) / before;
}

TEST(RadialMarch, ConservesEnergyWithoutAbsorber) {
  EXPECT_NEAR(energyRatioAfter1000Steps<double>(), 1, 1e-12);
  EXPECT_NEAR(energyRatioAfter1000Steps<float>(), 1, 1e-4);
}

/// Energy (dB) that a beam of 15 m keeps on its way up into the absorber and back; 10 GHz, 512 m, steps of
/// 200 m.
double returnedDb(double absorber_m, double per_m, double elevation_deg) {
  MarchGrid grid = gridOf(10e9, 0.25, 2048, 200);
  grid.absorber_m = absorber_m;
  grid.absorber_per_m = per_m;
  RadialMarch<double, 1> march(grid, {pathOf(200, linearRefractivity(0))});
  constexpr double kMiddle_m = 220, kRadius_m = 15;
  const double elevation_rad = degToRad(elevation_deg), p = grid.wavenumber() * std::sin(elevation_rad);
  std::vector<Cx> beam(std::size_t(grid.intervals));
  for (std::size_t j = 1; j < beam.size(); ++j) {
    const double z = double(j) * grid.heightStep_m() - kMiddle_m;
    beam[j] = std::polar(std::exp(-z * z / (kRadius_m * kRadius_m)), p * z);
  }
  march.setField(0, beam);
  const double before = march.energy(0);
  marchTo(march, 200 * std::ceil(2 * (grid.top_m - kMiddle_m) / std::tan(elevation_rad) / 200));
  return 10 * std::log10(march.energy(0) / before);
}

TEST(RadialMarch, ReturnsAsLittleFromTheTopAsAnotherProgram) {
  // absorbers of 64 m with 0.02 and 0.005 / m: marched by another program
  EXPECT_NEAR(returnedDb(64, 0.02, 3), -106, 3);
  EXPECT_NEAR(returnedDb(64, 0.005, 3), -26, 3);
  EXPECT_NEAR(returnedDb(64, 0.005, 2), -40, 3);
  EXPECT_NEAR(returnedDb(64, 0.005, 1), -78, 3);
  // below that the beam's own tails count
  EXPECT_LT(returnedDb(64, 0.02, 2), -125);
  EXPECT_LT(returnedDb(64, 0.02, 1), -125);
  EXPECT_LT(returnedDb(64, 0.02, 0.5), -125);
}

TEST(RadialMarch, IsReciprocalOverFlatGround) {
  const MarchGrid grid = gridOf(1e9, 1, 1024, 200);
  RadialPath up = pathOf(10, surfaceDuct(60, 15)), down = pathOf(45, surfaceDuct(60, 15));
  for (const bool perfect : {true, false}) {
    for (RadialPath* path : {&up, &down}) {
      path->surface.perfect = perfect;
      path->surface.polarization = LinearPolarization::vertical;
      path->surface.ground = {70, 5};
    }
    RadialMarch<double, 1> from_below(grid, {up}), from_above(grid, {down});
    marchTo(from_below, 40e3);
    marchTo(from_above, 40e3);
    EXPECT_NEAR(from_below.factorDb(0, 45), from_above.factorDb(0, 10), 0.01) << perfect;
  }
}

TEST(RadialMarch, MeetsTheFieldOfAnEvaporationDuctAt3GHz) {
  RadialMarch<double, 1> march(gridOf(3e9, 0.25, 4096, 100), {pathOf(25, evaporationDuct(24))});
  marchTo(march, 100e3);
  EXPECT_NEAR(march.factorDb(0, 25), -0.02, 0.1);  // sum of 240 modes
}

/// Over a hill of H/2 (1 + cos(pi (x - middle) / 4 km)), 100 m high; 3 GHz, standard air.
double overHillDb(double range_step_m, double middle_m, double source_m, double range_m, double height_m) {
  RadialPath path = pathOf(source_m);
  for (double x = 0; x <= 30e3; x += range_step_m) {
    const double off_m = x - middle_m;
    path.ground_msl_m.push_back(std::fabs(off_m) < 4e3 ? 50 * (1 + std::cos(kPi * off_m / 4e3)) : 0);
  }
  RadialMarch<double, 1> march(gridOf(3e9, 0.25, 4096, range_step_m), {path});
  marchTo(march, range_m);
  return march.factorDb(0, height_m);
}

TEST(RadialMarch, SLOW_OverAHillConvergesAndIsReciprocal) {
  EXPECT_NEAR(overHillDb(50, 10e3, 30, 8e3, 20), 8.6, 0.3);  // marched with 10 m by another program
  EXPECT_NEAR(overHillDb(50, 10e3, 30, 10e3, 20), -6.3, 0.3);
  const double behind_db = overHillDb(50, 10e3, 30, 30e3, 20);
  EXPECT_NEAR(behind_db, overHillDb(25, 10e3, 30, 30e3, 20), 0.05);
  EXPECT_NEAR(behind_db, overHillDb(50, 20e3, 20, 30e3, 30), 0.05);  // the path from its other end
}

TEST(RadialMarch, PlateauEqualsSmoothEarthAtItsHeight) {
  RadialPath high = pathOf(20, linearRefractivity(0.118, 330)), low = high;
  high.ground_msl_m.assign(2, 250);
  const MarchGrid grid = gridOf(3e9, 0.5, 1024, 200);
  RadialMarch<double, 1> above(grid, {high}), below(grid, {low});
  marchTo(above, 20e3);
  marchTo(below, 20e3);
  EXPECT_DOUBLE_EQ(above.ground_m(0), 250);
  EXPECT_NEAR(above.factorDb(0, 30), below.factorDb(0, 30), 1e-6);
}

// The lobes are 1.7 height steps apart; a line between the heights is 1 dB below their maxima.
TEST(RadialMarch, PointsBetweenTheHeightsEqualTwoRays) {
  constexpr double kSource_m = 1500, kRange_m = 50e3;
  const MarchGrid grid = gridOf(3e8, 5.73, 2048, 500);
  RadialMarch<double, 1> march(grid, {pathOf(kSource_m, linearRefractivity(0))});
  marchTo(march, kRange_m);
  for (double z = 270; z < 330; z += 3) {
    const double direct_m = std::hypot(kRange_m, z - kSource_m);
    const double reflected_m = std::hypot(kRange_m, z + kSource_m);
    const std::complex<double> field =
        1.0 - std::sqrt(direct_m / reflected_m) *
                  std::polar(1.0, 2 * kPi / wavelength_m(3e8) * (reflected_m - direct_m));
    if (std::abs(field) < 0.2) continue;
    EXPECT_NEAR(march.factorDb(0, z), 20 * std::log10(std::abs(field)), 0.05) << z;
  }
}

TEST(RadialMarch, TakesACliffAsAStepAndCountsIt) {
  RadialPath path = pathOf(80, linearRefractivity(0));
  path.ground_msl_m.assign(100, 0);
  for (int i = 50; i < 53; ++i) path.ground_msl_m[i] = 60;  // a wall of 60 m from 5 km on
  RadialMarch<double, 1> march(gridOf(1e9, 1, 1024, 100), {path});
  marchTo(march, 5e3);
  EXPECT_EQ(march.ground_m(0), 60);
  EXPECT_EQ(march.amplitude(0, 0), 0);
  marchTo(march, 9e3);
  EXPECT_DOUBLE_EQ(staircasePart(path.ground_msl_m.data(), 99, 100.0, march.grid().maxSine(), 1), 2.0 / 99);
  EXPECT_EQ(march.ground_m(0), 0);
  EXPECT_LT(march.factorDb(0, 5), -15);  // in the shadow
  EXPECT_GT(march.factorDb(0, 150), -6);
}

TEST(RadialMarch, FloatIsCloseToDouble) {
  const MarchGrid grid = gridOf(10e9, 0.25, 2048, 100);
  for (const RefractivityProfile& air : {standardRefractivity(), evaporationDuct(14)}) {
    RadialMarch<double, 1> exact(grid, {pathOf(20, air)});
    RadialMarch<float, 1> single(grid, {pathOf(20, air)});
    for (const double range_m : {20e3, 60e3}) {
      marchTo(exact, range_m);
      marchTo(single, range_m);
      for (double z = 2; z < 300; z += 3.75) {
        if (exact.factorDb(0, z) < -60) continue;
        EXPECT_NEAR(single.factorDb(0, z), exact.factorDb(0, z), 0.1) << range_m << ' ' << z;
      }
    }
  }
}

TEST(RadialMarch, HalvedHeightsKeepTheField) {
  MarchGrid grid = gridOf(10e9, 0.2, 2048, 200);
  const auto fields = [&](bool sea_v) {
    std::vector<double> found_db;
    for (const bool halving : {false, true}) {
      grid.halving = halving;
      RadialPath path = pathOf(20);
      path.surface.perfect = !sea_v;
      path.surface.polarization = LinearPolarization::vertical;
      path.surface.ground = {50, 15};
      RadialMarch<double, 1> march(grid, {path});
      marchTo(march, 40e3);
      EXPECT_EQ(march.intervals() < 2048, halving);
      for (const double z : {20.0, 48.0, 100.0, 200.0}) found_db.push_back(march.factorDb(0, z));
    }
    return found_db;
  };
  for (const bool sea_v : {false, true}) {
    const std::vector<double> found_db = fields(sea_v);
    for (int i = 0; i < 4; ++i)
      EXPECT_NEAR(found_db[i], found_db[i + 4], sea_v ? 0.1 : 0.02) << sea_v << ' ' << i;
  }
}

TEST(RadialMarch, EqualProfilesAlongRangeEqualOneProfile) {
  const MarchGrid grid = gridOf(3e9, 0.5, 512, 100);
  const RefractivityProfile duct = surfaceDuct(40, 10);
  RadialMarch<double, 1> one(grid, {pathOf(20, duct)});
  RadialMarch<double, 1> two(grid, {pathOf(20, RefractivityAlongPath({0, 5e3}, {duct, duct}))});
  RadialMarch<double, 1> ending(grid,
                                {pathOf(20, RefractivityAlongPath({0, 5e3}, {duct, surfaceDuct(40, 0.1)}))});
  for (auto* march : {&one, &two, &ending}) marchTo(*march, 30e3);
  EXPECT_NEAR(one.factorDb(0, 20), two.factorDb(0, 20), 1e-9);
  EXPECT_GT(one.factorDb(0, 20), ending.factorDb(0, 20) + 3);  // the duct ends
}

// Rays that a break of slope turns out of the band would come back mirrored, and fill the shadow.
TEST(RadialMarch, EnergyOutsideTheBandDoesNotReachBehindRoughMountain) {
  const auto shadowDb = [](double max_angle_deg) {
    MarchNeeds needs;
    needs.frequency_hz = 3e8;
    needs.max_height_m = 1500;
    needs.max_angle_rad = degToRad(max_angle_deg);
    needs.post_spacing_m = 90;
    RadialPath path = pathOf(30);
    for (int i = 0; i < 160; ++i) {
      const double x_m = 90.0 * i, flank = (x_m - 6000) / 1800;
      path.ground_msl_m.push_back(std::exp(-flank * flank) * (600 + 50 * std::sin(x_m / 170)));
    }
    RadialMarch<double, 1> march(automaticGrid(needs).grid, {path});
    double sum_db = 0;
    int count = 0;
    while (march.range_m() < 14e3) {
      march.advance();
      if (march.range_m() < 9e3) continue;
      for (double z = 10; z < 150; z += 20, ++count)
        sum_db += 10 * std::log10(march.meanSquaredFactor(0, z, z + 20));
    }
    return sum_db / count;
  };
  const double shadow_db = shadowDb(9);
  EXPECT_LT(shadow_db, -62);  // -51 without absorption in every step
  EXPECT_NEAR(shadow_db, shadowDb(14), 9);
  EXPECT_NEAR(shadowDb(14), shadowDb(30), 3);
}

TEST(DuctOverLand, IsAbsentBetweenShores) {
  const RefractivityAlongPath air(evaporationDuct(14, 339));
  const std::vector<float> ground_msl_m{0, 0, 3, 5, 0, 0, 100, 100};
  const RefractivityAlongPath over = withoutDuctOverLand(air, ground_msl_m.data(), ground_msl_m.size(), 100);
  EXPECT_FALSE(over.pointwise());
  const auto strength = [&](double range_m) { return over.at(range_m).at(0) - over.at(range_m).at(14); };
  for (const double range_m : {0.0, 100.0, 400.0, 500.0, 900.0}) EXPECT_NEAR(strength(range_m), 18.3, 0.1);
  for (const double range_m : {200.0, 250.0, 300.0})
    EXPECT_NEAR(strength(range_m), -14 * kStandardGradient_m, 0.1);
  EXPECT_NEAR(over.at(250).at(50), air.at(250).at(50), 1e-9);
  const std::vector<float> sea(8, 0.0F);
  EXPECT_EQ(withoutDuctOverLand(air, sea.data(), sea.size(), 100), air);
  EXPECT_FALSE(withoutDuctOverLand(air).traps());
  EXPECT_EQ(withoutDuctOverLand(RefractivityAlongPath(surfaceDuct(40, 10))), surfaceDuct(40, 10));
}

TEST(RadialMarch, DirectionsThatThePatternDoesNotRadiateAreAbsent) {
  RadialPath path = pathOf(20, linearRefractivity(0));
  path.source.pattern = [](double elevation_rad) { return elevation_rad > 0 ? 1.0 : 0.0; };
  RadialMarch<double, 1> march(gridOf(3e9, 0.25, 2048, 200), {path});
  marchTo(march, 10e3);
  // no reflected ray: no lobes well above the source
  for (double z = 150; z < 350; z += 5) EXPECT_NEAR(march.factorDb(0, z), 0, 1.0) << z;
}

// The direct ray and the image's, each with the pattern at its own angle.
TEST(RadialMarch, PatternWeightsBothRaysByTheirAngles) {
  constexpr double kRange_m = 10e3, kSource_m = 40;
  struct Beam {
    double width_deg, tilt_deg;
  };
  for (const Beam beam : {Beam{1, 0}, Beam{2, 1}, Beam{2, -1}, Beam{5, 0.5}, Beam{20, 2}}) {
    SCOPED_TRACE(beam.width_deg);
    RadialPath path = pathOf(kSource_m, linearRefractivity(0));
    path.source.pattern = [beam](double elevation_rad) {
      const double off = (radToDeg(elevation_rad) - beam.tilt_deg) / beam.width_deg;
      return std::exp(-2 * std::log(2.0) * off * off);
    };
    const MarchGrid grid = gridOf(3e9, 0.25, 2048, 200);
    RadialMarch<double, 1> march(grid, {path});
    marchTo(march, kRange_m);
    double largest_db = -1e9;
    for (double z = 2; z < 350; z += 3.25) largest_db = std::max(largest_db, march.factorDb(0, z));
    for (double z = 2; z < 350; z += 3.25) {
      const double direct_m = std::hypot(kRange_m, z - kSource_m),
                   image_m = std::hypot(kRange_m, z + kSource_m);
      const Cx direct = path.source.pattern(std::atan2(z - kSource_m, kRange_m));
      const Cx image = path.source.pattern(-std::atan2(z + kSource_m, kRange_m)) * direct_m / image_m *
                       std::polar(1.0, grid.wavenumber() * (image_m - direct_m));
      const double expected_db = 20 * std::log10(std::abs(direct - image));
      if (expected_db < largest_db - 30) continue;
      EXPECT_NEAR(march.factorDb(0, z), expected_db, 0.1) << z;
    }
  }
}

TEST(RadialMarch, RefusesASurfaceOutsideTheMixedTransform) {
  RadialPath path = pathOf(10);
  path.surface.perfect = false;
  path.surface.polarization = LinearPolarization::vertical;
  path.surface.ground = {1, 1e9};  // all but a perfect conductor, R = +1
  EXPECT_THAT(
      test::errorOf([&] { RadialMarch<double, 1>(gridOf(1e9, 1, 1024, 200), {path}); }, ErrorCode::bad_input),
      HasSubstr("the mixed transform holds up to 0.999"));
}

// An absorber that is thin for rays that graze the earth would fill the shadow with its reflections.
TEST(AutomaticGrid, LowDomainsHaveTheShadowOfHighOnes) {
  for (const double frequency_hz : {1e9, 3e9, 10e9}) {
    const auto shadowOf = [&](double max_height_m, double max_angle_deg) {
      MarchNeeds needs;
      needs.frequency_hz = frequency_hz;
      needs.max_height_m = max_height_m;
      needs.max_angle_rad = degToRad(max_angle_deg);
      RadialPath path;
      path.source.height_agl_m = 10;
      path.air = standardRefractivity();
      RadialMarch<double, 1> march(automaticGrid(needs).grid, {path});
      while (march.range_m() < 50e3) march.advance();
      return march.factorDb(0, 10 * 50e3 / march.range_m());
    };
    const double expected = shadowOf(1000, 3);
    EXPECT_LT(expected, -40);
    for (const double max_height_m : {15, 60, 250}) {
      EXPECT_NEAR(shadowOf(max_height_m, 3), expected, 1) << frequency_hz << ' ' << max_height_m;
      EXPECT_NEAR(shadowOf(max_height_m, 1), expected, 1) << frequency_hz << ' ' << max_height_m;
    }
  }
}

TEST(MarchCells, HoldMeansOverHeightsAndRangeSteps) {
  const MarchGrid grid = gridOf(3e9, 0.5, 1024, 100);
  RadialMarch<float, 1> march(grid, {pathOf(20)}), again(grid, {pathOf(20)});
  const RadialCells cells{500, 20, -50, 25, 30};
  const std::vector<float> excess_db = marchCells(march, cells)[0];
  ASSERT_EQ(excess_db.size(), 600u);
  EXPECT_DOUBLE_EQ(march.range_m(), 10e3);
  double sum = 0;
  for (int step = 1; step <= 100; ++step) {
    again.advance();
    if (step > 95) sum += again.meanSquaredFactor(0, 50, 75);
  }
  EXPECT_NEAR(excess_db[19 * 30 + 4], -10 * std::log10(sum / 5), 1e-5);
  EXPECT_TRUE(std::isnan(excess_db[19 * 30 + 1]));   // below the ground
  EXPECT_TRUE(std::isnan(excess_db[19 * 30 + 29]));  // in the absorber
  EXPECT_FALSE(std::isnan(excess_db[19 * 30 + 2]));

  // Cells of 200 m and 50 m, 100 m and 25 m apart.
  RadialCells overlapping{100, 20, -50, 25, 30};
  overlapping.overlap = true;
  overlapping.mean_height_m = 50;
  RadialMarch<float, 1> finer(grid, {pathOf(20)}), of_steps(grid, {pathOf(20)});
  const std::vector<float> overlapping_db = marchCells(finer, overlapping)[0];
  double before = 0;
  for (int i = 0; i < 20; ++i) {
    of_steps.advance();
    const double here = of_steps.meanSquaredFactor(0, 37.5, 87.5);
    EXPECT_NEAR(overlapping_db[std::size_t(i * 30 + 4)],
                -10 * std::log10(i == 0 ? here : (before + here) / 2), 1e-5)
        << i;
    before = here;
  }
  EXPECT_FALSE(std::isnan(overlapping_db[19 * 30 + 1]));  // a quarter of it is above the ground

  RadialCells points = cells;
  points.are_points = true;
  RadialMarch<float, 1> once_more(grid, {pathOf(20)});
  EXPECT_NEAR(marchCells(once_more, points)[0][19 * 30 + 4], -again.factorDb(0, 62.5), 0.05);
  EXPECT_THAT(test::errorOf([&] {
                marchCells(march, RadialCells{50, 1, 0, 25, 4});
              }),
              HasSubstr("cells of 50 m in range; expected at least the range step of 100 m"));
}

TEST(MarchAzimuths, EqualSingleMarches) {
  AzimuthMarch all;
  all.grid = gridOf(3e9, 0.5, 512, 50);
  all.source = pathOf(20).source;
  all.surface = pathOf(20).surface;
  all.cells = {500, 10, -50, 25, 20};
  all.azimuths = 11;  // more than the lanes of a group, not a multiple
  all.air = {standardRefractivity()};
  all.ground_steps = 101;
  for (int a = 0; a < all.azimuths; ++a) {
    for (std::size_t i = 0; i < all.ground_steps; ++i) {
      all.ground_msl_m.push_back(float(5 + a) * float(1 - std::cos(0.1 * double(i))));
    }
  }
  std::vector<float> excess_db(all.cellCount());
  marchAzimuths(all, excess_db.data());
  for (const int a : {0, 7, 10}) {
    RadialPath path = pathOf(20);
    path.air = standardRefractivity();
    const auto first = all.ground_msl_m.begin() + a * int(all.ground_steps);
    path.ground_msl_m.assign(first, first + int(all.ground_steps));
    RadialMarch<float, 1> march(all.grid, {path});
    const std::vector<float> alone = marchCells(march, all.cells)[0];
    for (std::size_t i = 0; i < alone.size(); ++i) {
      const float here = excess_db[std::size_t(a) * alone.size() + i];
      ASSERT_EQ(std::isnan(here), std::isnan(alone[i])) << a << ' ' << i;
      if (std::isnan(here)) continue;
      if (alone[i] > 60) continue;  // rounding of float
      ASSERT_NEAR(here, alone[i], 0.01) << a << ' ' << i;
    }
  }
  all.air.resize(2);
  EXPECT_THAT(test::errorOf([&] { marchAzimuths(all, excess_db.data()); }), HasSubstr("one per azimuth"));
}

}  // namespace
}  // namespace emscape::propagation
