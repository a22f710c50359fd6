// The march against a simple one of a few lines, and against the same with a fault: figures that do not
// reveal a plausible fault would prove nothing.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <vector>

#include "emscape/base/units.h"
#include "propagation/parabolic_equation/march/march.h"
#include "propagation/parabolic_equation/march/sine_transform.h"
#include "propagation/parabolic_equation/march/source.h"
#include "tests/support/errors.h"

namespace emscape::propagation {
namespace {

using Cx = std::complex<double>;

constexpr double kSource_m = 5;

MarchGrid grid() {
  MarchGrid grid;
  grid.frequency_hz = 10e9;
  grid.intervals = 2048;
  grid.top_m = 204.8;
  grid.range_step_m = 200;
  setAbsorber(grid);
  return grid;
}

struct Point {
  double range_m, height_m;
};
/// At the band's largest angles, and in the duct beyond the horizon.
const std::vector<Point> kPoints{{1000, 70}, {1000, 78}, {1000, 82}, {20e3, 5},
                                 {20e3, 15}, {20e3, 40}, {40e3, 10}, {40e3, 25}};

enum class Fault {
  none,
  propagator_conjugate,  ///< the sign of i in D
  screen_conjugate,      ///< the sign of i in S
  half_screens,          ///< the square root of S on one side of D alone
  k_factor_on_top,       ///< the earth is flattened with 4/3 of its radius, and the air bends rays again
  image_sign,            ///< the source's image has the sign of the source
  no_slant               ///< field relative to free space at the range, not the slant range
};

/// The sine transform of single values.
std::vector<Cx> transformed(const std::vector<Cx>& values) {
  SineTransform<double, 1> transform(int(values.size()));
  std::vector<LaneComplex<double, 1>> in(values.size()), out(values.size());
  for (std::size_t i = 1; i < values.size(); ++i) in[i] = {{values[i].real()}, {values[i].imag()}};
  transform(in.data(), out.data());
  std::vector<Cx> found(values.size());
  for (std::size_t i = 1; i < values.size(); ++i) found[i] = {out[i].re[0], out[i].im[0]};
  return found;
}

/// F (dB) at the points, marched plainly over a perfect conductor at horizontal polarisation.
std::vector<double> plainFactorsDb(const RefractivityProfile& air, Fault fault) {
  const MarchGrid g = grid();
  const auto n = std::size_t(g.intervals);
  const double k = 2 * kPi / wavelength_m(g.frequency_hz), dz = g.top_m / g.intervals, p_max = kPi / dz;
  std::vector<Cx> field(n), screen(n), propagator(n);
  for (std::size_t i = 1; i < n; ++i) {
    const double p = kPi * double(i) / g.top_m, sine = p / k;
    const Cx image = (fault == Fault::image_sign ? -1.0 : 1.0) * std::polar(1.0, p * kSource_m);
    const Cx coefficient =
        Cx(0, 1) * (std::polar(1.0, -p * kSource_m) - image) / std::pow(1 - sine * sine, 0.25);
    field[i] = bandTaper(p / p_max) * coefficient / g.top_m;
    const double turn = g.range_step_m * (std::sqrt(k * k - p * p) - k);
    propagator[i] = std::polar(1.0, fault == Fault::propagator_conjugate ? -turn : turn);
  }
  for (std::size_t j = 0; j < n; ++j) {
    const double z = double(j) * dz, t = (z - g.usableTop_m()) / g.absorber_m;
    double m_units = air.at(z) - air.at(0);
    if (fault == Fault::k_factor_on_top) m_units -= kFlatteningGradient_m / 4 * z;
    const double phase = k * g.range_step_m / 2 * 1e-6 * m_units;
    const double rate = t > 0 ? g.absorber_per_m * t * t * t : 0;
    screen[j] =
        std::polar(std::exp(-rate * g.range_step_m / 2), fault == Fault::screen_conjugate ? -phase : phase);
  }
  field = transformed(field);
  std::vector<double> factors_db;
  double range_m = 0;
  for (const Point& point : kPoints) {
    for (; range_m < point.range_m; range_m += g.range_step_m) {
      for (std::size_t j = 0; j < n; ++j) field[j] *= screen[j];
      field = transformed(field);
      for (std::size_t i = 0; i < n; ++i) field[i] *= propagator[i] * (2.0 / double(n));
      field = transformed(field);
      if (fault == Fault::half_screens) continue;
      for (std::size_t j = 0; j < n; ++j) field[j] *= screen[j];
    }
    const std::vector<Cx> spectrum = transformed(field);
    Cx received = 0;
    for (std::size_t i = 1; i < n; ++i) {
      const double p = kPi * double(i) / g.top_m, sine = p / k;
      received += bandTaper(p / p_max) / std::pow(1 - sine * sine, 0.25) * std::sin(p * point.height_m) *
                  spectrum[i] * (2.0 / double(n));
    }
    const double slant = std::hypot(1, (point.height_m - kSource_m) / range_m);
    factors_db.push_back(
        20 * std::log10(std::abs(received)) +
        10 * std::log10(wavelength_m(g.frequency_hz) * range_m * (fault == Fault::no_slant ? 1 : slant)));
  }
  return factors_db;
}

TEST(RadialMarch, EqualsPlainMarch) {
  const RefractivityProfile air = evaporationDuct(14);
  RadialPath path;
  path.source.height_agl_m = kSource_m;
  path.air = air;
  RadialMarch<double, 1> march(grid(), {path});
  std::vector<double> factors_db;
  for (const Point& point : kPoints) {
    while (march.range_m() < point.range_m - 1e-3) march.advance();
    factors_db.push_back(march.factorDb(0, point.height_m));
  }
  const auto worstDb = [&](Fault fault) {
    const std::vector<double> plain_db = plainFactorsDb(air, fault);
    double worst_db = 0;
    for (std::size_t i = 0; i < plain_db.size(); ++i)
      worst_db = std::max(worst_db, std::fabs(plain_db[i] - factors_db[i]));
    return worst_db;
  };
  EXPECT_LT(worstDb(Fault::none), 0.002);
  EXPECT_GT(worstDb(Fault::propagator_conjugate), 1);
  EXPECT_GT(worstDb(Fault::screen_conjugate), 1);
  EXPECT_GT(worstDb(Fault::half_screens), 1);
  EXPECT_GT(worstDb(Fault::k_factor_on_top), 0.1);
  EXPECT_GT(worstDb(Fault::image_sign), 1);
  EXPECT_GT(worstDb(Fault::no_slant), 0.01);
}

// smooth_earth_modes.csv: vertical polarisation over the sea, 100 MHz, 30 to 10 m, 40 km.
TEST(RadialMarch, HasTheSignOfTheSurfaceImpedance) {
  const auto factorDb = [](double conductivity_s_m) {
    MarchGrid of_waves;
    of_waves.frequency_hz = 100e6;
    of_waves.intervals = 1024;
    of_waves.top_m = 3072;
    of_waves.range_step_m = 200;
    setAbsorber(of_waves);
    RadialPath path;
    path.source.height_agl_m = 30;
    path.air = linearRefractivity(1e6 / 8.5e6);
    path.surface.perfect = false;
    path.surface.polarization = LinearPolarization::vertical;
    path.surface.ground = {70, conductivity_s_m};
    RadialMarch<double, 1> march(of_waves, {path});
    while (march.range_m() < 40e3 - 1e-3) march.advance();
    return march.factorDb(0, 10);
  };
  EXPECT_NEAR(factorDb(5), -36.2076, 0.3);
  EXPECT_THAT(test::errorOf([&] { factorDb(-5); }, ErrorCode::bad_input),  // alpha of the other sign
              ::testing::HasSubstr("|r| of the surface is 1.1"));
}

// The splitting of a step is symmetric: its error is of second order. Next to the steep gradient of an
// evaporation duct that holds for shorter steps only.
TEST(RadialMarch, ConvergesWithTheSquareOfTheRangeStep) {
  const auto amplitudesOf = [](double range_step_m) {
    MarchGrid finer = grid();
    finer.range_step_m = range_step_m;
    finer.top_m *= 2;
    setAbsorber(finer);
    RadialPath path;
    path.source.height_agl_m = 15;
    RadialMarch<double, 1> march(finer, {path});
    while (march.range_m() < 40e3 - 1e-3) march.advance();
    std::vector<double> amplitudes;
    for (double height_m = 4; height_m < 60; height_m += 4)
      amplitudes.push_back(march.amplitude(0, height_m));
    return amplitudes;
  };
  const std::vector<double> coarse = amplitudesOf(200), middle = amplitudesOf(100), fine = amplitudesOf(50);
  double first = 0, second = 0;
  for (std::size_t i = 0; i < fine.size(); ++i) {
    first += std::fabs(coarse[i] - middle[i]);
    second += std::fabs(middle[i] - fine[i]);
  }
  EXPECT_GT(first / second, 3.5);
  EXPECT_LT(first / second, 4.5);
}

// M is read at the heights of the steps: in the steep gradient of an evaporation duct the error is of second
// order from 0.25 m on, and up to 0.2 dB with steps of 1 m (10 GHz, 14 m, 100 km).
TEST(RadialMarch, SLOW_ConvergesWithTheSquareOfTheHeightStep) {
  const auto factorsDb = [](int intervals) {
    MarchGrid finer = grid();
    finer.intervals = intervals;
    finer.top_m = 512;
    finer.range_step_m = 200;
    setAbsorber(finer);
    RadialPath path;
    path.source.height_agl_m = 10;
    path.air = evaporationDuct(14);
    RadialMarch<double, 1> march(finer, {path});
    while (march.range_m() < 100e3 - 1e-3) march.advance();
    std::vector<double> factors_db;
    for (double height_m = 2; height_m < 40; height_m += 2) factors_db.push_back(march.factorDb(0, height_m));
    return factors_db;
  };
  const std::vector<double> coarsest = factorsDb(512), coarse = factorsDb(2048), middle = factorsDb(4096),
                            fine = factorsDb(8192);
  double worst = 0, first = 0, second = 0;
  for (std::size_t i = 0; i < fine.size(); ++i) {
    worst = std::max(worst, std::fabs(coarsest[i] - fine[i]));
    first += std::fabs(coarse[i] - middle[i]);
    second += std::fabs(middle[i] - fine[i]);
  }
  EXPECT_LT(worst, 0.2);
  EXPECT_GT(first / second, 3.5);
  EXPECT_LT(first / second, 5);
}

}  // namespace
}  // namespace emscape::propagation
