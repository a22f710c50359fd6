/// Reflectivity of the sea, Doppler filters, and figures of a pulse train.
#include <cmath>
#include <map>

#include "emfield/check/datasets.h"
#include "emfield/check/reference_table.h"
#include "emfield/clutter/mti.h"
#include "emfield/clutter/reflectivity.h"
#include "emscape/base/error.h"
#include "emscape/scenario/model/waveform.h"

namespace emscape::emfield {
namespace {

double seaDb(const ReferenceTable& cases, int row, double frequency_hz) {
  const bool is_horizontal = cases.text(row, "polarization") == "horizontal";
  return seaReflectivityDb(seaConstants(is_horizontal), frequency_hz / 1e9, cases.number(row, "sea_state"),
                           std::sin(degToRad(cases.number(row, "grazing_deg"))));
}

}  // namespace

/// The sea model is fitted to Nathanson's tables, with a published mean deviation of 2.64 dB (horizontal) and
/// 2.54 dB (vertical), up to 60 degrees.
DatasetCheck checkSeaClutter(const std::filesystem::path& file) {
  const ReferenceTable cases(file,
                             {"polarization", "frequency_ghz", "sea_state", "grazing_deg", "sigma0_db"});
  struct Mean {
    double sum_db = 0;
    int count = 0;
  };
  std::map<std::string, Mean> deviations;
  for (int i = 0; i < cases.rows(); ++i) {
    Mean& mean = deviations[cases.text(i, "polarization")];
    mean.sum_db +=
        std::fabs(seaDb(cases, i, cases.number(i, "frequency_ghz") * 1e9) - cases.number(i, "sigma0_db"));
    ++mean.count;
  }
  FigureCheck horizontal{"mean deviation, horizontal", 0.005, "dB"},
      vertical{"mean deviation, vertical", 0.005, "dB"};
  const auto meanOf = [&](const char* polarization) {
    const Mean& mean = deviations[polarization];
    return mean.sum_db / mean.count;
  };
  horizontal.compare(meanOf("horizontal"), 2.64, 1);
  vertical.compare(meanOf("vertical"), 2.54, 1);
  return {cases.rows(), {horizontal, vertical}};
}

DatasetCheck checkClutterExamples(const std::filesystem::path& file) {
  const ReferenceTable cases(
      file, {"function", "pulses", "frequency_hz", "prf_hz", "spread_mps", "radial_speed_mps", "polarization",
             "sea_state", "grazing_deg", "expected"});
  FigureCheck expected{"expected", 5e-5, "relative"};
  for (int i = 0; i < cases.rows(); ++i) {
    const std::string& function = cases.text(i, "function");
    const auto value = [&](const char* column) { return cases.number(i, column); };
    const auto filter = [&] {
      MtiFilter made;
      made.mti.pulses = cases.integer(i, "pulses");
      made.prf_hz = value("prf_hz");
      made.frequency_hz = value("frequency_hz");
      return made;
    };
    double computed = 0;
    if (function == "sea reflectivity") {
      computed = dbToRatio(seaDb(cases, i, value("frequency_hz")));
    } else if (function == "canceller improvement") {
      computed = filter().improvement(value("spread_mps"), std::nullopt);
    } else if (function == "canceller response") {
      computed = filter().response(value("radial_speed_mps"));
    } else if (function == "first blind speed") {
      computed = scenario::Waveform{value("prf_hz"), 0, {}}.firstBlindSpeed_mps(value("frequency_hz"));
    } else if (function == "unambiguous range") {
      computed = scenario::Waveform{value("prf_hz"), 0, {}}.unambiguousRange_m();
    } else if (function == "hits per scan") {  // a beam of 1.5 degrees at 5 rpm
      scenario::ScanSpec scan;
      scan.kind = scenario::ScanKind::rotate;
      scan.rate_rpm = 5;
      computed = scenario::hitsPerScan(scan, 1.5, value("prf_hz")).value_or(0);
    } else {
      throw Error(ErrorCode::bad_input, cases.location(i), "function: '" + function + "' is not known");
    }
    expected.compareRelative(computed, value("expected"), cases.location(i).line);
  }
  return {cases.rows(), {expected}};
}

}  // namespace emscape::emfield
