/// Detection statistics, the radar equation and free-space conversions.

#include "emfield/check/datasets.h"
#include "emfield/check/reference_table.h"
#include "emfield/radar/detection.h"
#include "emfield/radar/detection_losses.h"
#include "emfield/radar/equation.h"
#include "emscape/base/error.h"
#include "emscape/scenario/model/waveform.h"

namespace emscape::emfield {
namespace {

Detector detectorOf(const ReferenceTable& cases, int row, std::string_view swerling) {
  Detector detector;
  detector.swerling = swerlingOfCase(cases.integer(row, swerling));
  detector.pulses = cases.integer(row, "n_pulses");
  detector.false_alarm_probability = cases.number(row, "pfa");
  return detector;
}

}  // namespace

DatasetCheck checkSwerling(const std::filesystem::path& file) {
  const ReferenceTable cases(file, {"swerling_case", "n_pulses", "pfa", "pd", "threshold_T",
                                    "snr_required_exact_dB", "snr_albersheim_dB", "snr_shnidman_dB"});
  FigureCheck exact{"snr_required_exact_dB", 1e-3, "dB"};
  FigureCheck threshold{"threshold_T", 1e-6, ""};
  FigureCheck albersheim{"snr_albersheim_dB", 1e-3, "dB"};
  FigureCheck shnidman{"snr_shnidman_dB", 1e-3, "dB"};
  for (int i = 0; i < cases.rows(); ++i) {
    const Detector detector = detectorOf(cases, i, "swerling_case");
    const double pd = cases.number(i, "pd");
    const int line = cases.location(i).line;
    exact.compare(requiredSnrDb(detector, pd), cases.number(i, "snr_required_exact_dB"), line);
    threshold.compare(detectionThreshold(detector), cases.number(i, "threshold_T"), line);
    shnidman.compare(shnidmanSnrDb(detector, pd), cases.number(i, "snr_shnidman_dB"), line);
    if (cases.has(i, "snr_albersheim_dB")) {
      albersheim.compare(albersheimSnrDb(detector, pd), cases.number(i, "snr_albersheim_dB"), line);
    }
  }
  return {cases.rows(), {exact, threshold, albersheim, shnidman}};
}

DatasetCheck checkDetectionProbability(const std::filesystem::path& file) {
  const ReferenceTable cases(file, {"pfa", "snr_dB", "n_pulses", "swerling_case", "pd_exact_derived"});
  FigureCheck probability{"pd_exact_derived", 1e-4, ""};
  for (int i = 0; i < cases.rows(); ++i) {
    const Detector detector = detectorOf(cases, i, "swerling_case");
    probability.compare(
        detectionProbability(detector, detectionThreshold(detector), dbToRatio(cases.number(i, "snr_dB"))),
        cases.number(i, "pd_exact_derived"), cases.location(i).line);
  }
  return {cases.rows(), {probability}};
}

DatasetCheck checkRadarEquation(const std::filesystem::path& file) {
  const ReferenceTable cases(file, {"function", "f_GHz", "Pt_W", "tau_s", "G_dB_each", "RCS_m2", "loss_dB",
                                    "Ts_K", "SNR_dB", "R_m", "expected"});
  FigureCheck expected{"expected", 5e-5, "relative"};  // published to 5 digits
  for (int i = 0; i < cases.rows(); ++i) {
    RadarLink radar;
    radar.power_w = 1;
    radar.frequency_hz = cases.number(i, "f_GHz") * 1e9;
    radar.gain_dbi = cases.number(i, "G_dB_each");
    radar.losses_db = cases.number(i, "loss_dB");
    radar.bandwidth_hz = 1 / cases.number(i, "tau_s");
    radar.noise_temperature_k = cases.number(i, "Ts_K");
    const double rcs_m2 = cases.number(i, "RCS_m2");
    const double snr_db = cases.number(i, "SNR_dB");
    const std::string& function = cases.text(i, "function");
    double computed = 0;
    if (function == "max range") {
      radar.power_w = cases.number(i, "Pt_W");
      computed = radarRange_m(radar, rcs_m2, snr_db);
    } else if (function == "peak power") {
      computed = dbToRatio(snr_db - radarSnrDb(radar, rcs_m2, cases.number(i, "R_m")));
    } else {
      throw Error(ErrorCode::bad_input, cases.location(i),
                  "function: '" + function + "' is not one of: max range, peak power");
    }
    expected.compareRelative(computed, cases.number(i, "expected"), cases.location(i).line);
  }
  return {cases.rows(), {expected}};
}

DatasetCheck checkDetectionLosses(const std::filesystem::path& file) {
  const ReferenceTable cases(
      file, {"figure", "cells", "pfa", "planes", "prf_hz", "beamwidth_deg", "rate_rpm", "expected"});
  FigureCheck cfar{"cfar_loss_db", 1e-5, "dB"}, blake{"blake_beam_shape_loss_db", 1e-9, "dB"},
      barton{"barton_beam_shape_loss_db", 0.05, "dB"}, range{"unambiguous_range_m", 1e-3, "m"},
      hits{"hits_per_scan", 1e-9, ""};
  for (int i = 0; i < cases.rows(); ++i) {
    const std::string& figure = cases.text(i, "figure");
    const int line = cases.location(i).line;
    const double expected = cases.number(i, "expected");
    if (figure == cfar.figure) {
      const Detector detector{Swerling::slow_exponential, 1, cases.number(i, "pfa")};
      cfar.compare(cfarLossDb(detector, cases.integer(i, "cells")), expected, line);
    } else if (figure == blake.figure) {
      blake.compare(beamShapeLossDb(scenario::BeamShapeLoss::blake, cases.integer(i, "planes")), expected,
                    line);
    } else if (figure == barton.figure) {
      barton.compare(beamShapeLossDb(scenario::BeamShapeLoss::barton, cases.integer(i, "planes")), expected,
                     line);
    } else if (figure == range.figure) {
      range.compare(scenario::Waveform{cases.number(i, "prf_hz"), 1e-6, {}}.unambiguousRange_m(), expected,
                    line);
    } else if (figure == hits.figure) {
      scenario::ScanSpec scan;
      scan.kind = scenario::ScanKind::rotate;
      scan.rate_rpm = cases.number(i, "rate_rpm");
      const auto computed =
          scenario::hitsPerScan(scan, cases.number(i, "beamwidth_deg"), cases.number(i, "prf_hz"));
      hits.compare(computed.value_or(0), expected, line);
    } else {
      throw Error(ErrorCode::bad_input, cases.location(i), "figure: '" + figure + "' is not known");
    }
  }
  return {cases.rows(), {cfar, blake, barton, range, hits}};
}

DatasetCheck checkFreeSpaceConversions(const std::filesystem::path& file) {
  const ReferenceTable cases(
      file, {"f_MHz", "d_km", "EIRP_dBW", "Lbf_dB", "S_dBW_m2", "E_dBuV_m", "Pr_isotropic_dBW"});
  FigureCheck loss{"Lbf_dB", 1e-5, "dB"}, density{"S_dBW_m2", 1e-5, "dB"}, field{"E_dBuV_m", 1e-5, "dB"},
      received{"Pr_isotropic_dBW", 1e-5, "dB"};
  for (int i = 0; i < cases.rows(); ++i) {
    const double distance_m = cases.number(i, "d_km") * 1000;
    const double eirp_dbw = cases.number(i, "EIRP_dBW");
    const int line = cases.location(i).line;
    // P.525 eq. (3): loss between isotropic antennas
    const double loss_db = 2 * ratioToDb(4 * kPi * distance_m / wavelength_m(cases.number(i, "f_MHz") * 1e6));
    const double density_dbwm2 = eirp_dbw - ratioToDb(4 * kPi * distance_m * distance_m);
    loss.compare(loss_db, cases.number(i, "Lbf_dB"), line);
    density.compare(density_dbwm2, cases.number(i, "S_dBW_m2"), line);
    field.compare(density_dbwm2 + kFieldStrengthOfPowerDensity_db, cases.number(i, "E_dBuV_m"), line);
    received.compare(eirp_dbw - loss_db, cases.number(i, "Pr_isotropic_dBW"), line);
  }
  return {cases.rows(), {loss, density, field, received}};
}

}  // namespace emscape::emfield
