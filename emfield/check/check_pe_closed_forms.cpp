/// The parabolic equation against closed forms: two rays, cell means, a beam, an edge, a sloped plane;
/// roughness.
#include <map>

#include "emfield/check/datasets.h"
#include "emfield/check/pe_figures.h"
#include "emfield/check/reference_table.h"
#include "emscape/base/cuda/device.h"
#include "propagation/parabolic_equation/march/march_step.h"

namespace emscape::emfield {

using namespace propagation;

namespace {

const RefractivityProfile kStraight = linearRefractivity(0);

RadialPath pathFrom(double source_height_m, RefractivityAlongPath air = kStraight) {
  RadialPath path;
  path.source.height_agl_m = source_height_m;
  path.air = std::move(air);
  return path;
}

/// Rows with equal values of some columns, in ascending order of range_m: one march each.
using Marches = std::map<std::vector<double>, std::vector<int>>;
Marches marchesOf(const ReferenceTable& cases, const std::vector<std::string_view>& columns) {
  Marches marches;
  for (int i = 0; i < cases.rows(); ++i) {
    std::vector<double> key;
    for (const std::string_view column : columns) key.push_back(cases.number(i, column));
    marches[key].push_back(i);
  }
  for (auto& [key, rows] : marches) {
    std::stable_sort(rows.begin(), rows.end(),
                     [&](int a, int b) { return cases.number(a, "range_m") < cases.number(b, "range_m"); });
  }
  return marches;
}

/// Where the reference is above -10 dB, below 4.5 degrees and up to 0.8 of the even part of the band.
template <class Real>
void checkTwoRayPe(const ReferenceTable& cases, std::vector<FigureCheck>& figures) {
  Differences low, high, narrow;
  for (const auto& [key, rows] : marchesOf(cases, {"frequency_hz", "source_height_m"})) {
    MarchGrid grid = peGrid(key[0], key[0] < 5e9 ? 14 : 8, 1000, 5, 200);
    if (std::is_same_v<Real, OnGpu> && !fitsGpu(grid)) continue;
    const double largest_rad = std::asin(0.8 * 0.6 * grid.maxSine());
    for (const PeForm form : {PeForm::wide, PeForm::narrow}) {
      grid.form = form;
      PeMarch<Real> march(grid, {pathFrom(key[1])});
      for (const int i : rows) {
        const double z = cases.number(i, "height_m"), range_m = cases.number(i, "range_m");
        const double expected = cases.number(i, form == PeForm::wide ? "F_exact_db" : "F_narrow_angle_pe_db");
        const double angle_rad = std::atan2(z + key[1], range_m);
        if (expected <= -10 || angle_rad > std::max(largest_rad, degToRad(4.5))) continue;
        marchTo(march, range_m);
        Differences& of = form == PeForm::narrow ? narrow : angle_rad <= degToRad(4.5) ? low : high;
        of.add(march.factorDb(0, z), expected, cases.location(i).line);
      }
    }
  }
  figures.push_back(low.figure(inPrecision<Real>("F to 4.5 degrees"), 1, 0.03));
  figures.push_back(high.figure(inPrecision<Real>("F, larger angles"), 1, 0.2));
  figures.push_back(narrow.figure(inPrecision<Real>("F, narrow form"), 1, 0.005));
}

template <class Real>
void checkCells(const ReferenceTable& cases, std::vector<FigureCheck>& figures) {
  FigureCheck mean{inPrecision<Real>("mean of F^2"), 0.05, "dB"};
  for (int i = 0; i < cases.rows(); ++i) {
    const MarchGrid grid = peGrid(cases.number(i, "frequency_hz"), 5, 600, 5, 500);
    PeMarch<Real> march(grid, {pathFrom(cases.number(i, "source_height_m"))});
    marchTo(march, cases.number(i, "range_m"));
    const double squared = march.meanSquaredFactor(0, cases.number(i, "z1_m"), cases.number(i, "z2_m"));
    mean.compare(10 * std::log10(squared), cases.number(i, "mean_power_F2_db"), cases.location(i).line);
  }
  figures.push_back(mean);
}

template <class Real>
void checkBeam(const ReferenceTable& cases, std::vector<FigureCheck>& figures) {
  FigureCheck centre{inPrecision<Real>("beam_centre_m"), 0.1, "m"};
  FigureCheck radius{inPrecision<Real>("beam_radius_1_e_m"), 0.002, "relative"};
  FigureCheck peak{inPrecision<Real>("peak_rel_source_db"), 0.01, "dB"};
  constexpr double kOffset_m = 2500;  // so that the beam does not reach the surface
  for (const auto& [key, rows] :
       marchesOf(cases, {"frequency_hz", "waist_m", "source_height_m", "dM_dz_per_m", "tilt_deg"})) {
    MarchGrid grid;
    grid.frequency_hz = key[0];
    grid.intervals = 8192;
    grid.top_m = 8192 * key[1] / 4;
    grid.range_step_m = 250;
    grid.form = PeForm::narrow;
    const double source_m = key[2] + kOffset_m;
    PeMarch<Real> march(grid, {pathFrom(source_m, linearRefractivity(key[3]))});
    std::vector<std::complex<double>> start(static_cast<std::size_t>(grid.intervals));
    const double p = 2 * kPi / wavelength_m(key[0]) * std::sin(degToRad(key[4]));
    for (std::size_t j = 0; j < start.size(); ++j) {
      const double z = static_cast<double>(j) * grid.heightStep_m() - source_m;
      start[j] = std::polar(std::exp(-z * z / (key[1] * key[1])), p * z);
    }
    march.setField(0, start);
    for (const int i : rows) {
      marchTo(march, cases.number(i, "range_m"));
      double sum = 0, first = 0, second = 0;
      for (int j = 0; j < grid.intervals; ++j) {
        const double z = j * grid.heightStep_m(), a = march.amplitude(0, z);
        sum += a * a;
        first += a * a * z;
        second += a * a * z * z;
      }
      const double at = first / sum;
      const int line = cases.location(i).line;
      centre.compare(at - kOffset_m, cases.number(i, "beam_centre_m"), line);
      radius.compareRelative(2 * std::sqrt(second / sum - at * at), cases.number(i, "beam_radius_1_e_m"),
                             line);
      peak.compare(20 * std::log10(march.amplitude(0, at)), cases.number(i, "peak_rel_source_db"), line);
    }
  }
  figures.insert(figures.end(), {centre, radius, peak});
}

/// An absorbing edge, high above the ground (free space) and on the ground.
template <class Real>
void checkEdge(const ReferenceTable& cases, std::vector<FigureCheck>& figures) {
  Differences differences;
  for (const auto& [key, rows] :
       marchesOf(cases, {"frequency_hz", "source_height_m", "edge_range_m", "edge_height_m"})) {
    for (const bool free_space : {true, false}) {
      const double offset_m = free_space ? 1000 : 0;
      MarchGrid grid = peGrid(key[0], key[0] < 5e9 ? 12 : 6, 1800, 2.5, 500);
      grid.form = PeForm::narrow;
      PeMarch<Real> march(grid, {pathFrom(key[1] + offset_m)});
      marchTo(march, key[2]);
      march.screenBelow(0, key[3] + offset_m);
      for (const int i : rows) {
        const double expected = cases.number(i, free_space ? "F_free_space_db" : "F_over_pec_ground_db");
        if (expected <= -25) continue;
        marchTo(march, cases.number(i, "range_m"));
        differences.add(march.factorDb(0, cases.number(i, "height_m") + offset_m), expected,
                        cases.location(i).line);
      }
    }
  }
  figures.push_back(differences.figure(inPrecision<Real>("F, median"), 0.5, 0.03));
  figures.push_back(differences.figure(inPrecision<Real>("F, 90 % of the cases"), 0.9, 0.1));
}

/// Where the reference is above -10 dB, from 2 km on. The march's columns are normal to the slope, those of
/// the table are vertical: each point is evaluated in the column of the march that contains it, relative to
/// the source's.
template <class Real>
void checkSlope(const ReferenceTable& cases, std::vector<FigureCheck>& figures) {
  Differences two, five, ten;
  for (int i = 0; i < cases.rows(); ++i) {
    const double slope_deg = cases.number(i, "slope_deg"), range_m = cases.number(i, "range_m");
    const double expected = cases.number(i, "F_exact_db");
    if (range_m < 2000 || expected <= -10) continue;
    const double slope_rad = degToRad(slope_deg), steepness_deg = std::fabs(slope_deg);
    const double source_m = cases.number(i, "source_height_m"), z = cases.number(i, "height_above_plane_m");
    const double column_m = range_m + (z - source_m) * std::sin(slope_rad) * std::cos(slope_rad);
    const MarchGrid grid =
        peGrid(cases.number(i, "frequency_hz"), 10, 600, 5, column_m / std::round(column_m / 50));
    RadialPath path = pathFrom(source_m);
    for (int step = 0; step <= 110; ++step) {
      path.ground_msl_m.push_back(step * grid.range_step_m * std::tan(slope_rad));
    }
    PeMarch<Real> march(grid, {path});
    marchTo(march, column_m);
    Differences& of = steepness_deg <= 2 ? two : steepness_deg <= 5 ? five : ten;
    of.add(march.factorDb(0, z), expected, cases.location(i).line);
  }
  figures.push_back(two.figure(inPrecision<Real>("F, median, to 2 deg"), 0.5, 0.1));
  figures.push_back(five.figure(inPrecision<Real>("F, median, 3 to 5 deg"), 0.5, 0.3));
  figures.push_back(ten.figure(inPrecision<Real>("F, median, 10 deg"), 0.5, 0.6));
}

}  // namespace

DatasetCheck checkPeTwoRay(const std::filesystem::path& file) {
  const ReferenceTable cases(
      file, {"frequency_hz", "source_height_m", "range_m", "height_m", "F_exact_db", "F_narrow_angle_pe_db"});
  DatasetCheck check{cases.rows(), {}};
  checkTwoRayPe<double>(cases, check.figures);
  checkTwoRayPe<float>(cases, check.figures);
  if (findDevice().usable) checkTwoRayPe<OnGpu>(cases, check.figures);
  return check;
}

DatasetCheck checkPeCells(const std::filesystem::path& file) {
  const ReferenceTable cases(
      file, {"frequency_hz", "source_height_m", "range_m", "z1_m", "z2_m", "mean_power_F2_db"});
  DatasetCheck check{cases.rows(), {}};
  checkCells<double>(cases, check.figures);
  checkCells<float>(cases, check.figures);
  if (findDevice().usable) checkCells<OnGpu>(cases, check.figures);
  return check;
}

DatasetCheck checkPeBeam(const std::filesystem::path& file) {
  const ReferenceTable cases(file, {"frequency_hz", "waist_m", "source_height_m", "dM_dz_per_m", "tilt_deg",
                                    "range_m", "beam_centre_m", "beam_radius_1_e_m", "peak_rel_source_db"});
  DatasetCheck check{cases.rows(), {}};
  checkBeam<double>(cases, check.figures);
  checkBeam<float>(cases, check.figures);
  return check;
}

DatasetCheck checkPeEdge(const std::filesystem::path& file) {
  const ReferenceTable cases(file, {"frequency_hz", "source_height_m", "edge_range_m", "edge_height_m",
                                    "range_m", "height_m", "F_free_space_db", "F_over_pec_ground_db"});
  DatasetCheck check{cases.rows(), {}};
  checkEdge<double>(cases, check.figures);
  checkEdge<float>(cases, check.figures);
  return check;
}

DatasetCheck checkPeSlope(const std::filesystem::path& file) {
  const ReferenceTable cases(file, {"frequency_hz", "source_height_m", "slope_deg", "range_m",
                                    "height_above_plane_m", "F_exact_db"});
  DatasetCheck check{cases.rows(), {}};
  checkSlope<double>(cases, check.figures);
  checkSlope<float>(cases, check.figures);
  if (findDevice().usable) checkSlope<OnGpu>(cases, check.figures);
  return check;
}

/// Its column angle_error_percent is half the square of the angle, which is not a result of a march.
DatasetCheck checkPeNarrowAngle(const std::filesystem::path& file) {
  const ReferenceTable cases(file, {"frequency_hz", "angle_deg", "phase_error_rad_per_10km"});
  FigureCheck phase{"phase_error_rad_per_10km", 1e-5, "relative"};
  for (int i = 0; i < cases.rows(); ++i) {
    const double k = 2 * kPi / wavelength_m(cases.number(i, "frequency_hz"));
    const double angle_rad = degToRad(cases.number(i, "angle_deg")), p = k * std::sin(angle_rad);
    const auto phaseOf = [&](bool wide, double q) { return stepExponent(wide, k, 10e3, {q * q, 0}).im; };
    const int line = cases.location(i).line;
    phase.compareRelative(phaseOf(false, p) - phaseOf(true, p), cases.number(i, "phase_error_rad_per_10km"),
                          line);
  }
  return {cases.rows(), {phase}};
}

DatasetCheck checkRoughness(const std::filesystem::path& file) {
  const ReferenceTable cases(file, {"frequency_hz", "sigma_h_m", "grazing_deg", "ament", "miller_brown"});
  FigureCheck ament{"ament", 2e-6, ""}, miller_brown{"miller_brown", 2e-6, ""};
  for (int i = 0; i < cases.rows(); ++i) {
    const double sine = std::sin(degToRad(cases.number(i, "grazing_deg")));
    const double sigma_m = cases.number(i, "sigma_h_m"),
                 wavelength = wavelength_m(cases.number(i, "frequency_hz"));
    const int line = cases.location(i).line;
    ament.compare(roughnessFactor(RoughnessModel::ament, sigma_m, sine, wavelength), cases.number(i, "ament"),
                  line);
    miller_brown.compare(roughnessFactor(RoughnessModel::miller_brown, sigma_m, sine, wavelength),
                         cases.number(i, "miller_brown"), line);
  }
  return {cases.rows(), {ament, miller_brown}};
}

}  // namespace emscape::emfield
