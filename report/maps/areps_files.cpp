#include "report/maps/areps_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <ostream>

#include "base/files/folder.h"
#include "base/files/whole_file.h"
#include "emfield/radar/receiver.h"
#include "emscape/base/units.h"

namespace emscape::report {
namespace {

using study::VerticalCut;
using study::VerticalDiagram;

constexpr double kAlmostCertain = 0.999;
/// Values of points below the ground, and of those without a field.
constexpr int kGround = -32766, kInvalid = -32767;
constexpr double kLargest_cb = 32000;

/// Effective radiated power on the boresight (dBW).
double radiated_dbw(const scenario::Emitter& emitter) {
  return ratioToDb(emitter.power_w) + emitter.antenna->gain_dbi - emitter.losses_db;
}

/// Loss (dB) at a power density: free space has (4 pi R / lambda)^2.
double lossOf_db(const scenario::Emitter& emitter, double density_dbwm2) {
  const double wave_m = wavelength_m(emitter.frequency_hz);
  return radiated_dbw(emitter) - density_dbwm2 - ratioToDb(wave_m * wave_m / (4 * kPi));
}

/// 20 lg c of a radar's SNR = (c S)^2 at a power density S.
double echoRoot_db(const scenario::Emitter& radar) {
  return 2 * ratioToDb(emfield::echoRoot_m2_w(radar));
}

void writeDetection(std::ostream& out, const scenario::Emitter& radar) {
  const emfield::Detector detector = emfield::detectorOf(radar.receiver);
  out << "[Probability of detection]\n# largest one-way loss (dB) for 1 to 100 %\n";
  for (int percent = 1; percent <= 100; ++percent) {
    const double probability =
        std::max(std::min(percent / 100.0, kAlmostCertain), 2 * detector.false_alarm_probability);
    const double snr_db = emfield::requiredSnrDb(detector, probability);
    const double loss_db = std::max(lossOf_db(radar, (snr_db - echoRoot_db(radar)) / 2), 0.0);
    out << fmt::format("{:.2f}{}", loss_db, percent % 10 == 0 ? "\n" : " ");
  }
}

/// @param valueAt  value (dB) of a range and height index
template <class ValueAt>
void writeTable(std::ostream& out, const char* name, const VerticalDiagram& diagram, const VerticalCut& cut,
                const ValueAt& valueAt) {
  out << fmt::format(
      "[{}]\nInvalidValue = {}\nGroundValue = {}\n# centibels: a line for each Height(m), from Rmax / "
      "Nrout to Rmax\n",
      name, kInvalid, kGround);
  const std::size_t width = diagram.ranges_m.size();
  for (std::size_t k = 0; k < diagram.heights_m.size(); ++k) {
    for (std::size_t i = 0; i < width; ++i) {
      const bool is_below = !cut.ground_msl_m.empty() && diagram.heights_m[k] < cut.ground_msl_m[i];
      const double value_db = valueAt(i, k);
      const long value = std::isfinite(value_db)
                             ? std::lround(std::clamp(10 * value_db, -kLargest_cb, kLargest_cb))
                             : (is_below ? kGround : kInvalid);
      out << value << (i + 1 < width ? " " : "\n\n");
    }
  }
}

}  // namespace

std::string arepsFile(const std::filesystem::path& folder, const std::string& emitter, double azimuth_deg) {
  std::string name;
  for (const char c : emitter.substr(0, 60))
    name += std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' ? c : '_';
  return folder / fmt::format("{}_APM_{:g}.txt", name, std::fmod(azimuth_deg + 360, 360));
}

scenario::Quantity arepsQuantity(const scenario::Emitter& emitter) {
  return emitter.kind == scenario::EmitterKind::radar ? scenario::Quantity::snr_db
                                                      : scenario::Quantity::power_density_dbwm2;
}

double arepsLoss_db(const VerticalDiagram& diagram, const scenario::Scenario& scenario, double value) {
  const scenario::Emitter& emitter = scenario.emitters[static_cast<std::size_t>(diagram.request.emitter)];
  const bool is_radar = emitter.kind == scenario::EmitterKind::radar;
  return lossOf_db(emitter, is_radar ? (value - echoRoot_db(emitter)) / 2 : value);
}

std::vector<std::string> writeAreps(const VerticalDiagram& diagram, const scenario::Scenario& scenario,
                                    const std::filesystem::path& folder) {
  const scenario::Emitter& emitter = scenario.emitters[static_cast<std::size_t>(diagram.request.emitter)];
  const bool is_radar = emitter.kind == scenario::EmitterKind::radar;
  makeFolder(folder);
  std::vector<std::string> files;
  for (const VerticalCut& cut : diagram.cuts) {
    const double azimuth_deg = std::fmod(cut.azimuth_deg + 360, 360);
    const std::string file = arepsFile(folder, emitter.name, azimuth_deg);
    const std::size_t width = diagram.ranges_m.size();
    const auto loss_db = [&](std::size_t i, std::size_t k) {
      return arepsLoss_db(diagram, scenario, cut.values[k * width + i]);
    };
    writeWhole(file, [&](std::ostream& out) {
      out << fmt::format(
          "# {} of {} by Emscape; heights above mean sea level\nBearing angle = {:.4f}\nFreq = "
          "{:.6f}\nAntGain = "
          "{:.2f}\nAntHt = {:.2f}\nHorBw = {:.3f}\nTransPower = {:.6f}\nSysLoss = {:.2f}\n",
          emitter.name, diagram.scenario, azimuth_deg, emitter.frequency_hz / 1e6, emitter.antenna->gain_dbi,
          diagram.station_agl_m, emitter.antenna->beamwidth_az_deg, emitter.power_w / 1000,
          emitter.losses_db + (is_radar ? emitter.receiver.losses_db : 0));
      if (is_radar) {
        const double pulse_s =
            emitter.waveform ? emitter.waveform->pulse_width_s : 1 / emitter.receiver.bandwidth_hz;
        out << fmt::format("Noise = {:.2f}\nPulseWidth = {:.4f}\n", emitter.receiver.noise_figure_db,
                           1e6 * pulse_s);
      }
      out << fmt::format("Hmin = {:.3f}\nHmax = {:.3f}\nNzout = {}\nRmax = {:.3f}\nNrout = {}\n",
                         diagram.heights_m.front(), diagram.heights_m.back(), diagram.heights_m.size() - 1,
                         diagram.ranges_m.back(), width);
      if (is_radar) writeDetection(out, emitter);
      writeTable(out, "Apm Loss Data", diagram, cut, loss_db);
      writeTable(out, "Apm Factor Data", diagram, cut, [&](std::size_t i, std::size_t k) {
        const double path_m = diagram.slantRange_m(diagram.ranges_m[i], diagram.heights_m[k]);
        return 2 * ratioToDb(4 * kPi * path_m / wavelength_m(emitter.frequency_hz)) - loss_db(i, k);
      });
    });
    files.push_back(file);
  }
  return files;
}

}  // namespace emscape::report
