/// The parabolic equation against sums of modes: smooth earth, ducts, and NTIA's LFMF.
#include <map>
#include <tuple>

#include "emfield/check/datasets.h"
#include "emfield/check/pe_figures.h"
#include "emfield/check/reference_table.h"
#include "emfield/check/residue_series.h"
#include "emscape/base/cuda/device.h"

namespace emscape::emfield {

using namespace propagation;

namespace {

constexpr double kEffectiveEarth_m = 8.5e6;  // of smooth_earth_*.csv

/// Height of the domain in which the ray that just left the earth is absorbed: 30 of its vertical wavelengths
/// in an eighth of the domain.
double topOverEarth_m(double frequency_hz) {
  const double turn = std::sqrt(2 / kEffectiveEarth_m);
  return std::pow(8 * 30 * wavelength_m(frequency_hz) / turn, 2.0 / 3);
}

/// Rows of one march, by range.
using MarchesByRange = std::map<std::tuple<double, std::string, double>, std::multimap<double, int>>;

RefractivityProfile ductOf(const std::string& name) {
  if (name == "evap14_10ghz") return evaporationDuct(14);
  if (name == "evap24_3ghz") return evaporationDuct(24);
  if (name == "sbd300_3ghz") return trilinearRefractivity(200, 300, 40);
  return {};
}

MarchGrid ductGrid(double frequency_hz) {
  // the logarithm of the evaporation duct needs 0.25 m; the surface-based duct reaches 300 m
  return frequency_hz > 5e9 ? peGrid(frequency_hz, 4, 500, 1, 100) : peGrid(frequency_hz, 7, 1000, 1, 100);
}

template <class Real>
void checkEarth(const ReferenceTable& cases, std::vector<FigureCheck>& figures) {
  MarchesByRange marches;
  for (int i = 0; i < cases.rows(); ++i) {
    marches[{cases.number(i, "frequency_hz"), cases.text(i, "ground"), cases.number(i, "source_height_m")}]
        .emplace(cases.number(i, "range_m"), i);
  }
  FigureCheck horizontal{inPrecision<Real>("F_db > -60, H"), 0.1, "dB"};
  FigureCheck vertical{inPrecision<Real>("F_db > -60, V"), 0.3, "dB"};
  // float's rounding, about 100 dB below the strongest field, reaches 0.4 dB rms at -80 dB
  FigureCheck faint{inPrecision<Real>("F_db to -80"), std::is_same_v<Real, OnGpu> ? 1.0 : 0.5, "dB"};
  for (const auto& [key, rows] : marches) {
    const auto& [frequency_hz, ground, source_m] = key;
    RadialPath path;
    path.source.height_agl_m = source_m;
    path.air = linearRefractivity(1e6 / kEffectiveEarth_m);
    path.surface.perfect = ground == "pec_h";
    path.surface.ground = {70, 5};
    path.surface.polarization =
        ground == "sea_v" ? LinearPolarization::vertical : LinearPolarization::horizontal;
    // the error of the splitting grows with the frequency, that of float with the number of steps
    const double range_step_m = frequency_hz < 2e9 ? 1000 : 200;
    // the error of the mixed transform is of first order in the height step
    const double angle_deg = ground == "sea_v" && frequency_hz < 2e8 ? 15 : 3;
    PeMarch<Real> march(peGrid(frequency_hz, angle_deg, topOverEarth_m(frequency_hz), 10, range_step_m),
                        {path});
    for (const auto& [range_m, i] : rows) {
      const double expected = cases.number(i, "F_db");
      if (expected <= -80) continue;
      marchTo(march, range_m);
      FigureCheck& figure = expected <= -60 ? faint : ground == "sea_v" ? vertical : horizontal;
      figure.compare(march.factorDb(0, cases.number(i, "height_m")), expected, cases.location(i).line);
    }
  }
  figures.insert(figures.end(), {horizontal, vertical, faint});
}

/// Attenuation (dB/km) between two ranges far beyond the horizon, where only the first mode is left.
double decayDbPerKm(PeMarch<double>& march, double from_m, double to_m, double height_m) {
  marchTo(march, from_m);
  const double first = march.amplitude(0, height_m);
  marchTo(march, to_m);
  return 20 * std::log10(first / march.amplitude(0, height_m)) / (to_m - from_m) * 1000;
}

template <class Real>
void checkDucts(const ReferenceTable& cases, std::vector<FigureCheck>& figures) {
  MarchesByRange marches;
  for (int i = 0; i < cases.rows(); ++i) {
    marches[{cases.number(i, "frequency_hz"), cases.text(i, "case"), cases.number(i, "source_height_m")}]
        .emplace(cases.number(i, "range_m"), i);
  }
  std::map<std::string, std::pair<Differences, double>> ducts;  // and the largest difference allowed
  for (const auto& [key, rows] : marches) {
    const auto& [frequency_hz, name, source_m] = key;
    RadialPath path;
    path.source.height_agl_m = source_m;
    const RefractivityProfile profile = ductOf(name);
    if (profile.levels.empty())
      throw Error(ErrorCode::bad_input, cases.location(rows.begin()->second), "unknown duct " + name);
    path.air = profile;
    PeMarch<Real> march(ductGrid(frequency_hz), {path});
    auto& [differences, worst] = ducts[name];
    worst = name == "sbd300_3ghz" ? 0.1 : 0.2;
    for (const auto& [range_m, i] : rows) {
      const double expected = cases.number(i, "F_modes_db");
      if (expected <= -20) continue;
      marchTo(march, range_m);
      differences.add(march.factorDb(0, cases.number(i, "height_m")), expected, cases.location(i).line);
    }
  }
  for (const auto& [name, duct] : ducts) {
    figures.push_back(duct.first.figure(inPrecision<Real>(name + ", median"), 0.5, 0.02));
    figures.push_back(duct.first.figure(inPrecision<Real>(name), 1, duct.second));
  }
}

/// Effective radius of the earth (m) in LFMF, for the refractivity at the ground.
double lfmfEarth_m(double refractivity) {
  return 6370e3 / (1 - 0.04665 * std::exp(0.005577 * refractivity));
}

/// LFMF's loss is for antennas on the ground: 6.02 dB more.
double lfmfLossDb(const ReferenceTable& cases, int row) {
  return cases.number(row, "A_btl__db") - 20 * std::log10(2.0);
}

/// LFMF against a residue series of our own.
FigureCheck checkLfmfSeries(const ReferenceTable& cases) {
  FigureCheck loss{"loss, residue series", 0.01, "dB"};
  for (int i = 0; i < cases.rows(); ++i) {
    if (cases.number(i, "pol") != 1) continue;
    const double frequency_hz = 1e6 * cases.number(i, "f__mhz"), range_m = 1000 * cases.number(i, "d__km");
    const double field_db = groundWaveDb(frequency_hz, {cases.number(i, "epsilon"), cases.number(i, "sigma")},
                                         lfmfEarth_m(cases.number(i, "N_s")), range_m);
    loss.compare(20 * std::log10(4 * kPi * range_m / wavelength_m(frequency_hz)) - field_db,
                 lfmfLossDb(cases, i), cases.location(i).line);
  }
  return loss;
}

/// @param compared  rows that were compared
template <class Real>
FigureCheck checkLfmf(const ReferenceTable& cases, int& compared) {
  FigureCheck loss{inPrecision<Real>("loss, 30 MHz, F > -80"), 0.5, "dB"};
  std::map<std::tuple<double, double, double>, std::multimap<double, int>> marches;
  for (int i = 0; i < cases.rows(); ++i) {
    if (cases.number(i, "f__mhz") != 30 || cases.number(i, "pol") != 1) continue;
    marches[{cases.number(i, "epsilon"), cases.number(i, "sigma"), cases.number(i, "N_s")}].emplace(
        cases.number(i, "d__km") * 1000, i);
  }
  for (const auto& [key, rows] : marches) {
    const auto& [permittivity, conductivity, refractivity] = key;
    RadialPath path;
    path.air = linearRefractivity(1e6 / lfmfEarth_m(refractivity));
    path.surface.perfect = false;
    path.surface.ground = {permittivity, conductivity};
    path.surface.polarization = LinearPolarization::vertical;
    PeMarch<Real> march(peGrid(30e6, 50, topOverEarth_m(30e6), 6, 200), {path});
    for (const auto& [range_m, i] : rows) {
      const double expected = lfmfLossDb(cases, i);
      const double free_space = 20 * std::log10(4 * kPi * range_m / wavelength_m(30e6));
      if (free_space - expected <= -80) continue;
      marchTo(march, range_m);
      ++compared;
      loss.compare(free_space - march.factorDb(0, 0), expected, cases.location(i).line);
    }
  }
  return loss;
}

}  // namespace

DatasetCheck checkPeSmoothEarth(const std::filesystem::path& file) {
  const ReferenceTable cases(file,
                             {"frequency_hz", "ground", "source_height_m", "height_m", "range_m", "F_db"});
  DatasetCheck check{cases.rows(), {}};
  checkEarth<double>(cases, check.figures);
  checkEarth<float>(cases, check.figures);
  if (findDevice().usable) checkEarth<OnGpu>(cases, check.figures);
  return check;
}

/// Only in double: where only one mode is left, the field is below the noise of float.
DatasetCheck checkPeDecay(const std::filesystem::path& file) {
  const ReferenceTable cases(file, {"frequency_hz", "L_m", "first_mode_db_per_km"});
  FigureCheck decay{"first_mode_db_per_km, double", 0.005, "relative"};
  for (int i = 0; i < cases.rows(); ++i) {
    const double frequency_hz = cases.number(i, "frequency_hz"), scale_m = cases.number(i, "L_m");
    RadialPath path;
    path.source.height_agl_m = 10;
    path.air = linearRefractivity(1e6 / kEffectiveEarth_m);
    MarchGrid grid = peGrid(frequency_hz, 5, 2 * topOverEarth_m(frequency_hz), 10, 200);
    setAbsorber(grid, grid.top_m / 2);
    PeMarch<double> march(grid, {path});
    decay.compareRelative(
        decayDbPerKm(march, std::round(4 * scale_m / 200) * 200, std::round(5.5 * scale_m / 200) * 200, 10),
        cases.number(i, "first_mode_db_per_km"), cases.location(i).line);
  }
  return {cases.rows(), {decay}};
}

DatasetCheck checkPeDucts(const std::filesystem::path& file) {
  const ReferenceTable cases(
      file, {"case", "frequency_hz", "source_height_m", "height_m", "range_m", "F_modes_db"});
  DatasetCheck check{cases.rows(), {}};
  checkDucts<double>(cases, check.figures);
  checkDucts<float>(cases, check.figures);
  if (findDevice().usable) checkDucts<OnGpu>(cases, check.figures);
  return check;
}

/// The first mode of the evaporation ducts; those of the others do not decay.
DatasetCheck checkPeDuctModes(const std::filesystem::path& file) {
  const ReferenceTable cases(file, {"case", "mode", "attenuation_db_per_km"});
  FigureCheck decay{"mode 1 of evaporation ducts", 0.005, "relative"};
  int checked = 0;
  for (int i = 0; i < cases.rows(); ++i) {
    const std::string& name = cases.text(i, "case");
    if (cases.integer(i, "mode") != 1 || name.substr(0, 4) != "evap") continue;
    RadialPath path;
    path.source.height_agl_m = 10;
    path.air = ductOf(name);
    PeMarch<double> march(ductGrid(name == "evap14_10ghz" ? 10e9 : 3e9), {path});
    decay.compareRelative(decayDbPerKm(march, 150e3, 250e3, 10), cases.number(i, "attenuation_db_per_km"),
                          cases.location(i).line);
    ++checked;
  }
  return {checked, {decay}};
}

DatasetCheck checkPeLfmf(const std::filesystem::path& file) {
  const ReferenceTable cases(file, {"f__mhz", "N_s", "d__km", "epsilon", "sigma", "pol", "A_btl__db"});
  int in_double = 0, in_float = 0;
  std::vector<FigureCheck> figures = {checkLfmfSeries(cases), checkLfmf<double>(cases, in_double),
                                      checkLfmf<float>(cases, in_float)};
  if (findDevice().usable) figures.push_back(checkLfmf<OnGpu>(cases, in_float));
  return {cases.rows(), std::move(figures)};
}

}  // namespace emscape::emfield
