/// Scans, and an emitter that scans amid a box.
#pragma once

#include <memory>

#include "tests/emfield/test_scenario.h"

namespace emscape::emfield::testing {

inline scenario::ScanSpec rotating(double rate_rpm, double elevation_deg = 0) {
  scenario::ScanSpec scan;
  scan.kind = scenario::ScanKind::rotate;
  scan.rate_rpm = rate_rpm;
  scan.azimuth_deg = 20;
  scan.elevation_deg = elevation_deg;
  return scan;
}

inline scenario::ScanSpec sweeping(scenario::ScanKind kind, double width_deg, double rate_deg_s,
                                   int bars = 1) {
  scenario::ScanSpec scan;
  scan.kind = kind;
  scan.azimuth_deg = 40;
  scan.elevation_deg = 2;
  scan.width_deg = width_deg;
  scan.rate_deg_s = rate_deg_s;
  scan.bars = bars;
  scan.elevation_step_deg = 4;
  return scan;
}

inline scenario::ScanSpec dwelling() {
  scenario::ScanSpec scan;
  scan.kind = scenario::ScanKind::dwell_list;
  scan.azimuth_deg = 30;
  scan.elevation_deg = 5;
  scan.dwells = {{-20, 0, 0.3}, {5, 10, 0.2}, {25, -3, 0.5}};
  return scan;
}

/// An emitter in the middle of a box whose voxels are at all azimuths and elevations.
inline std::shared_ptr<scenario::Scenario> around(const scenario::AntennaPtr& antenna,
                                                  const scenario::ScanSpec& scan) {
  auto scenario = emptyScenario(FrameKind::enu, 44.3, -71.4, {15000, 15000, 6000}, {15, 15, 6});
  scenario::Emitter emitter = plainEmitter("emitter", 0);
  emitter.antenna = antenna;
  emitter.scan = scan;
  addEmitter(*scenario, middleOf(*scenario), emitter);
  scenario->platforms.front().track.front().heading_deg = 0;
  return scenario;
}

}  // namespace emscape::emfield::testing
