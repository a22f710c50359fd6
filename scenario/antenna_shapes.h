/// Makes antennas: closed forms, measured patterns.
#pragma once

#include <string>

#include "scenario/antenna.h"

namespace emscape::scenario {

AntennaPtr makeIsotropic(double gain_dbi = 0);
/// Gaussian beam, -3 dB at half of each beamwidth. side_lobe_db: level (below 0) under which the pattern does not fall.
AntennaPtr makeGaussian(double gain_dbi, double beamwidth_az_deg, double beamwidth_el_deg, double side_lobe_db);
/// Uniformly lit rectangular aperture: sinc in azimuth times sinc in elevation; nothing lower than side_lobe_db behind it.
AntennaPtr makeSinc(double gain_dbi, double beamwidth_az_deg, double beamwidth_el_deg, double side_lobe_db);
/// Gaussian in azimuth; in elevation a Gaussian below and at the nose of the beam and cosecant squared above it up to
/// max_elevation_deg.
AntennaPtr makeCosecant2(double gain_dbi, double beamwidth_az_deg, double beamwidth_el_deg, double max_elevation_deg,
                         double side_lobe_db);
/// Planar array of columns x rows elements, uniform weights; spacing in wavelengths, 0.1..1.
AntennaPtr makePhasedArray(double gain_dbi, int columns, int rows, double spacing_wavelengths, double element_exponent);
/// MSI/Planet (.msi, .pln): horizontal and vertical cuts, dBd unless the file says dBi, electrical tilt downwards.
/// @throws Error (bad_input) with file and line
AntennaPtr readMsi(const std::string& file);
/// CSV cut: columns `azimuth_deg,attenuation_db` or `elevation_deg,attenuation_db` (two files), attenuation >= 0 below the maximum.
AntennaPtr readCsvCuts(const std::string& azimuth_file, const std::string& elevation_file, double gain_dbi);
/// CSV grid: columns `azimuth_deg,elevation_deg,attenuation_db`, a full regular grid in any order.
AntennaPtr readCsvGrid(const std::string& file, double gain_dbi);
/// By the file's ending and header line: MSI/PLN or CSV grid. gain_dbi NaN: from the file (MSI) or an error (CSV).
AntennaPtr readAntenna(const std::string& file, double gain_dbi);

}  // namespace emscape::scenario
