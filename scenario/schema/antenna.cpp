// Sections of an antenna: pattern and scan.
#include "emscape/scenario/model/scenario.h"
#include "scenario/antenna/taper.h"
#include "scenario/schema/sections.h"
#include "scenario/schema/values.h"

namespace emscape::scenario {
namespace {

using document::spec::byDefault;
using document::spec::listOf;
using document::spec::number;
using document::spec::object;
using document::spec::optional;
using document::spec::required;
using document::spec::Variants;

const ObjectSpec& dwellSpec() {
  static const ObjectSpec spec{
      "dwell",
      "",
      {
          required("azimuth_deg", number("deg").from(-180).to(180), "off the boresight, clockwise"),
          required("elevation_deg", kElevation, "off the boresight, upwards"),
          required("duration_s", number("s").from(1e-6).to(1e6), "whole nanoseconds"),
      }};
  return spec;
}

}  // namespace

const ObjectSpec& antennaSpec() {
  const Variants beams{"gaussian", "sinc", "cosecant2"}, apertures{"sinc", "phased_array"};
  static const ObjectSpec spec{
      "antenna",
      "pattern",
      {
          required("pattern", choiceOf<AntennaForm>(),
                   "shape of the beam; file: MSI/PLN, NSMA, STK, SPLAT! or CSV; cuts: two cuts"),
          byDefault("gain_dbi", kGain, 0.0, "at the maximum", {"isotropic"}),
          optional(
              "gain_dbi", kGain,
              "at the maximum; by default 26000 / (beamwidths in degrees), within 0 dBi and the pattern's "
              "directivity",
              {"gaussian", "sinc"}),
          optional(
              "gain_dbi", kGain,
              "at the maximum; by default 4 pi times the aperture in square wavelengths times the taper's "
              "efficiency, at most the pattern's directivity",
              {"phased_array"}),
          optional("gain_dbi", kGain, "at the maximum; by default the file's own, if it has one", {"file"}),
          required("gain_dbi", kGain, "at the maximum", {"cosecant2", "cuts"}),
          required("beamwidth_az_deg", number("deg").from(1e-3).to(360),
                   "between half-power points; sinc: at most 180", beams),
          required("beamwidth_el_deg", number("deg").from(1e-3).to(180), "between half-power points", beams),
          byDefault(
              "side_lobe_db", number("dB").from(-100).to(0), -40.0,
              "lower limit of the pattern, relative to the maximum; in nulls and behind the antenna too",
              {"gaussian", "sinc", "cosecant2", "phased_array"}),
          byDefault("taper", choiceOf<TaperKind>(), toString(TaperKind::uniform),
                    "amplitude over the aperture, in both planes: first side lobes at -13.3 dB (uniform), "
                    "-23 dB (cosine) or taper_side_lobe_db (taylor)",
                    apertures),
          byDefault("taper_side_lobe_db", number("dB").from(-60).to(-15), -30.0,
                    "design level of the first side lobes; only with taper taylor", apertures),
          byDefault("max_elevation_deg", number("deg").above(0).to(90), 40.0,
                    "end of the cosecant-squared part; at least half of beamwidth_el_deg", {"cosecant2"}),
          required("columns", kInteger.from(1).to(1024), "elements in azimuth", {"phased_array"}),
          required("rows", kInteger.from(1).to(1024), "elements in elevation", {"phased_array"}),
          byDefault("spacing_wavelengths", number().from(0.1).to(1), 0.5, "between elements",
                    {"phased_array"}),
          byDefault("element_exponent", number().from(0).to(10), 0.5,
                    "exponent of the element's amplitude, a power of the cosine off boresight",
                    {"phased_array"}),
          required("file", kFile, "relative to the scenario's folder", {"file"}),
          required("azimuth_file", kFile, "CSV: azimuth_deg, attenuation_db; or .az of SPLAT!", {"cuts"}),
          required("elevation_file", kFile, "CSV: elevation_deg, attenuation_db; or .el of SPLAT!", {"cuts"}),
      },
      {},
      {},
      {{"elevation_deg", "the elevation of the beam is 'elevation_deg' of the emitter's 'scan'"},
       {"tilt_deg", "the elevation of the beam is 'elevation_deg' of the emitter's 'scan'"},
       {"azimuth_deg", "the direction of the beam is 'azimuth_deg' of the emitter's 'scan'"}}};
  return spec;
}

const ObjectSpec& scanSpec() {
  const Variants sweeps{"sector", "raster"};
  static const ObjectSpec spec{
      "scan",
      "kind",
      {
          required("kind", choiceOf<ScanKind>(),
                   "motion of the beam; track: a radar's antenna that turns onto its target; victim: an "
                   "antenna that "
                   "turns to a platform, such as a jammer's"),
          byDefault(
              "azimuth_deg", kAngle, 0.0,
              "off the platform's heading, clockwise: boresight; rotate: at t = 0; sector, raster: centre"),
          byDefault("elevation_deg", kElevation, 0.0,
                    "of the boresight, upwards; raster: centre of the bars"),
          required("rate_rpm", number("rpm").from(-6000).to(6000), "clockwise if positive; 0: as `fixed`",
                   {"rotate"}),
          required("width_deg", number("deg").above(0).to(360), "whole azimuth sweep", sweeps),
          required("rate_deg_s", number("deg/s").above(0).to(1e5), "azimuth speed", sweeps),
          required("elevation_step_deg", number("deg").above(0).to(90), "between bars", {"raster"}),
          required("bars", kInteger.from(1).to(1000), "sweeps stacked, from the lowest upwards", {"raster"}),
          required("victim", kName, "platform to which the antenna turns, along the straight line",
                   {"victim"}),
          required("dwells", listOf(object(dwellSpec()), 1, kMaxItems), "repeated", {"dwell_list"}),
      }};
  return spec;
}

}  // namespace emscape::scenario
