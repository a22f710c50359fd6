/// Constructors of antennas: closed forms and measured patterns. All throw Error (bad_input) that names the
/// value and its range.
#pragma once

#include <cmath>
#include <limits>
#include <string>

#include "emscape/scenario/antenna/antenna.h"
#include "scenario/antenna/taper.h"

namespace emscape::scenario {

AntennaPtr makeIsotropic(double gain_dbi = 0);

/// Gaussian beam: attenuation 10 log10(2) = 3.0103 dB at half of each beamwidth, growing with the square of
/// the angle; the two planes add in dB.
/// @param beamwidth_az_deg  0..360; 360: the same in every azimuth
/// @param beamwidth_el_deg  0..180; 180: the same in every elevation
/// @param side_lobe_db      -200..0: lower limit of the pattern
AntennaPtr makeGaussian(double gain_dbi, double beamwidth_az_deg, double beamwidth_el_deg,
                        double side_lobe_db);

/// Rectangular aperture: taper.pattern(D u / lambda) taper.pattern(H v / lambda) in the direction cosines u
/// (right) and v (up), with D and H such that the half-power points are at half of each beamwidth (uniform
/// illumination: D = 0.886 lambda / beamwidth for narrow beams). It is turned, not steered electronically.
/// @param beamwidth_az_deg, beamwidth_el_deg  0..180
/// @param side_lobe_db      -200..0: lower limit of the pattern, in its nulls and behind the aperture
/// @see Balanis, Antenna Theory, 4th ed., table 12.1
AntennaPtr makeSinc(double gain_dbi, double beamwidth_az_deg, double beamwidth_el_deg, double side_lobe_db,
                    const Taper& taper = Taper());

/// Gaussian in azimuth. In elevation Gaussian up to the nose's upper half-power point (half the beamwidth),
/// from there csc^2(elevation) / csc^2(beamwidth / 2), 3 dB below the maximum where both parts meet, and
/// beyond max_elevation_deg a Gaussian of the same beamwidth down to side_lobe_db. Elevation counts from the
/// antenna's boresight, the nose's maximum.
/// @param beamwidth_az_deg   0..360; 360: the same in every azimuth
/// @param beamwidth_el_deg   of the nose, 0..180
/// @param max_elevation_deg  beamwidth_el_deg / 2 .. 90
/// @param side_lobe_db       -200..0: lower limit of the pattern
/// @see Skolnik, Introduction to Radar Systems, 3rd ed., 9.11
AntennaPtr makeCosecant2(double gain_dbi, double beamwidth_az_deg, double beamwidth_el_deg,
                         double max_elevation_deg, double side_lobe_db);

/// Planar array of elements whose weights are the taper's in columns times the taper's in rows. The pattern
/// is the array factor, with its grating lobes, times an element's cos(angle off boresight)^element_exponent
/// in amplitude, at least side_lobe_db. Steered electronically; the element's pattern reduces the gain of a
/// steered beam.
/// @param gain_dbi             of the unsteered array
/// @param columns, rows        1..1024
/// @param spacing_wavelengths  0.1..1, both ways
/// @param element_exponent     0..10
/// @param side_lobe_db  -200..0: the lower limit due to errors of the elements' amplitudes and phases, also
/// in nulls and behind the array
/// @see Balanis, Antenna Theory, 4th ed., 6.10; Mailloux, Phased Array Antenna Handbook, 2nd ed., ch. 7
/// (errors)
AntennaPtr makePhasedArray(double gain_dbi, int columns, int rows, double spacing_wavelengths,
                           double element_exponent, double side_lobe_db = -200, const Taper& taper = Taper());

/// Gain of a directive antenna by its half-power beamwidths, 26000 / (az el) with losses and side lobes of
/// practical antennas; at least 0 dBi.
/// @see Stutzman and Thiele, Antenna Theory and Design, 3rd ed., 5.4 (G = 26,000 / (HP_E HP_H))
double gainFromBeamwidths_dbi(double beamwidth_az_deg, double beamwidth_el_deg);
/// Gain of a planar array by its area, 4 pi A / lambda^2 times the taper's efficiency in columns and rows;
/// not below 0 dBi.
double gainFromArray_dbi(int columns, int rows, double spacing_wavelengths, const Taper& taper = Taper());

/// Cuts in two files, SPLAT!'s .az and .el, or CSV: columns `azimuth_deg,attenuation_db` and
/// `elevation_deg,attenuation_db`, rows in any order, attenuation >= 0 below the maximum. Azimuths cover the
/// full circle, elevations from -90 to 90, with gaps of at most 90 degrees. The attenuations are added.
/// Interpolation is linear in amplitude.
/// @throws Error (bad_input) with file, line and column
AntennaPtr readCsvCuts(const std::string& azimuth_file, const std::string& elevation_file, double gain_dbi);

/// Frequencies (Hz) for which an antenna file states its pattern; of a single frequency: twice that.
struct StatedBand {
  double lowest_hz = 0, highest_hz = HUGE_VAL;
};

/// Reads a file of any format (scenario/antenna/pattern_file.h): MSI/Planet (.msi, .pln), NSMA (.adf), STK
/// (.ant, .pattern), SPLAT! (.az, .el), CSV (.csv).
///
/// MSI/Planet has horizontal and vertical cuts, attenuations below the maximum. GAIN is in dBd unless the
/// file says dBi. Azimuth runs clockwise, the vertical angle downwards from the horizon ahead, so that a cut
/// with tilt has its maximum at a positive angle; the cut includes the tilt; TILT and ELECTRICAL_TILT are
/// informative.
/// @param gain_dbi  NaN: the file's own
/// @param band      receives the frequencies that the file states; may be null
/// @throws Error (bad_input) with file, line and column; without a gain
AntennaPtr readAntenna(const std::string& file, double gain_dbi = std::numeric_limits<double>::quiet_NaN(),
                       StatedBand* band = nullptr);

}  // namespace emscape::scenario
