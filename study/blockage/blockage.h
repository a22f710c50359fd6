/// Partial beam blockage: the part of a radar's beam that terrain cuts, over azimuth and range.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/files/own_file.h"
#include "emscape/render/picture/image.h"
#include "emscape/scenario/model/scenario.h"
#include "study/files/geotiff.h"

namespace emscape::study {

struct BlockageRequest {
  static constexpr double kMinRange_m = 100, kUsualRange_m = 100e3, kMaxRange_m = 1e6;
  static constexpr int kMinAzimuths = 4, kMaxAzimuths = 3600, kMaxRanges = 10000;

  int emitter = 0;  ///< index into Scenario::emitters
  double time_s = 0;
  std::optional<double>
      elevation_deg;  ///< of the beam's axis, -10..89; none: of the emitter's beam at the time
  std::optional<double> beamwidth_deg;  ///< between its half-power points; none: the antenna's in elevation
  std::optional<double> range_m;        ///< of the last gate, along the beam; none: up to kUsualRange_m, but
                                        ///< not beyond the last gate whose blockage is known
  double step_m = 500;                  ///< of the gates
  int azimuths = 360;                   ///< beams, from north clockwise
};

/// Part of the cross section of a circular beam that is below a horizontal edge:
///   (y sqrt(a^2 - y^2) + a^2 asin(y / a) + pi a^2 / 2) / (pi a^2), 0 for y < -a, 1 for y > a.
/// @param edge_m    y, height of the edge above the beam's axis
/// @param radius_m  a, > 0: half of the beam's width between the half-power points
/// @return 0..1; NaN for NaN
/// @see J. Bech, B. Codina, J. Lorente, D. Bebbington, The Sensitivity of Single Polarization Weather Radar
/// Beam Blockage Correction to Variability in the Vertical Refractivity Gradient, J. Atmos. Oceanic Technol.
/// 20 (2003), p. 845, eq. (2)
double partOfBeamBelow(double edge_m, double radius_m);

/// Of gate n of azimuth i at [i * ranges + n]; NaN: terrain is missing there or on the way.
struct Blockage {
  BlockageRequest request;
  std::string scenario, emitter;
  std::string title;  ///< name of the scenario with the number of edits
  GeodeticPosition position;
  double station_msl_m = 0, effective_earth_radius_m = 0;
  double elevation_deg = 0, beamwidth_deg = 0;
  int ranges = 0;
  std::vector<float> edge_msl_m;  ///< highest ground of the gate
  std::vector<float> partial;     ///< by the ground of the gate: Bech's PBB
  std::vector<float> cumulative;  ///< by all ground up to the gate
  std::vector<std::string> warnings;

  double azimuth_deg(int index) const { return 360.0 * index / request.azimuths; }
  double range_m() const { return ranges * request.step_m; }                 ///< end of the last gate
  double gate_m(int index) const { return (index + 0.5) * request.step_m; }  ///< middle, along the beam
  /// Height of the beam's axis at a distance along it, on the effective earth.
  double axis_msl_m(double slant_m) const;
  /// Distance over the ground, at mean sea level, below a distance along the beam.
  double ground_m(double slant_m) const;
  /// Gate above a point of the ground; -1: beyond the last, or below the horizon of the beam.
  int gateAt(double ground_m) const;
};

/// @throws Error (bad_input) if the scenario has no terrain; (usage) for a beam without a width
Blockage computeBlockage(const std::shared_ptr<const scenario::Scenario>& scenario,
                         const BlockageRequest& request);

/// The cumulative blockage over the ground.
struct BlockageMap {
  MapGrid grid;
  Map map;
};
BlockageMap mapOf(const Blockage& blockage);
render::Image8 drawBlockage(const Blockage& blockage, int width);
/// Rows of azimuth and range. Written as a whole.
void writeBlockageCsv(const Blockage& blockage, const std::string& file, Replaces replaces = Replaces::own);
/// Arrays over azimuth and range with the positions of the gates (netCDF, CF conventions). Written as a
/// whole.
void writeBlockageNetcdf(const Blockage& blockage, const std::string& file,
                         Replaces replaces = Replaces::own);

}  // namespace emscape::study
