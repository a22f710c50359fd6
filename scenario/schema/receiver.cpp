// Sections of receivers: of radars, at every voxel, and on platforms; targets.
#include <string>

#include "emscape/scenario/model/scenario.h"
#include "scenario/schema/sections.h"
#include "scenario/schema/values.h"

namespace emscape::scenario {
namespace {

using document::spec::byDefault;
using document::spec::choice;
using document::spec::number;
using document::spec::object;
using document::spec::optional;
using document::spec::required;
using propagation::Polarization;

KeySpec crossPolarKey() {
  return byDefault("cross_polar_isolation_db", number("dB").from(0).to(100), kCrossPolarIsolation_db,
                   "isolation of the orthogonal polarisation by the antenna");
}

/// @param condition  end of the description
KeySpec antennaNoiseKey(const std::string& condition = "") {
  return optional(
      "antenna_noise", choice({"sky"}),
      "in place of antenna_temperature_k: the clear sky at the frequency and the boresight's "
      "elevation (galaxy by P.372, gases by P.676), and the ground at 290 K in 0.124 of the pattern" +
          condition);
}

const ObjectSpec& sideLobeBlankingSpec() {
  static const ObjectSpec spec{
      "side_lobe_blanking",
      "",
      {
          required("auxiliary_gain_dbi", kGain,
                   "of the omnidirectional auxiliary antenna, above the side lobes"),
          byDefault("threshold_db", number("dB").from(-30).to(30), SideLobeBlanking{}.threshold_db,
                    "power in the auxiliary over that in the main channel from which a pulse is blanked"),
      }};
  return spec;
}

}  // namespace

const ObjectSpec& radarReceiverSpec() {
  static const ObjectSpec spec{
      "radar receiver",
      "",
      {
          required("noise_figure_db", kNoiseFigure, "referred to 290 K"),
          byDefault("antenna_temperature_k", kNoiseTemperature, RadarReceiver{}.antenna_temperature_k,
                    "noise from sky and ground"),
          antennaNoiseKey(),
          required("bandwidth_hz", kBandwidth, "of the noise"),
          byDefault(
              "losses_db", kLoss, RadarReceiver{}.losses_db,
              "between antenna and receiver; the emitter's losses_db, of its transmit path, is not added"),
          byDefault(
              "processing_gain_db", number("dB").from(-100).to(100), RadarReceiver{}.processing_gain_db,
              "of an echo over noise and jamming: pulse compression and coherent integration, net of losses"),
          optional("polarization", choiceOf<Polarization>(),
                   "for jamming; by default the emitter's. target_rcs_m2 is that between the two"),
          crossPolarKey(),
          optional(
              "pulses", kInteger.from(1).to(1e6),
              "integrated on a target; by default the hits of one scan, from the waveform, the beamwidth "
              "and the scan's rate; 1 without a waveform or without a scan"),
          byDefault("pfa", number().from(1e-15).to(0.5), RadarReceiver{}.pfa, "probability of false alarm"),
          byDefault("swerling", kSwerling, double(RadarReceiver{}.swerling), "case of target fluctuation"),
          byDefault("detection", choiceOf<DetectionMethod>(), toString(RadarReceiver{}.detection),
                    "method of detection_probability: exact statistics or a formula; albersheim only with "
                    "swerling 0"),
          byDefault(
              "beam_shape_loss", choiceOf<BeamShapeLoss>(), toString(RadarReceiver{}.beam_shape_loss),
              "of pulses received off the beam's peak, per scanned plane: blake 1.6 dB, barton 1.23 dB"),
          optional("cfar_cells", kInteger.from(1).to(10000),
                   "reference cells of a cell-averaging CFAR, for its loss; by default the noise level is "
                   "known"),
          optional("binary_threshold", kInteger.from(1).to(1e4),
                   "M of M-of-N integration over N = pulses, for its loss; by default the pulses are added "
                   "up"),
          optional("required_signal_to_jammer_db", number("dB").from(-100).to(100),
                   "required for burn-through; by default that of a detection probability of 0.5"),
          optional("side_lobe_blanking", object(sideLobeBlankingSpec()),
                   "blanks jammers' pulses in the side lobes; by default none"),
          byDefault("target_rcs_m2", kRcs, RadarReceiver{}.target_rcs_m2, "radar cross section"),
      }};
  return spec;
}

const ObjectSpec& receiverSpec() {
  static const ObjectSpec spec{
      "receiver",
      "",
      {
          required("name", kName, ""),
          optional("platform", kName,
                   "name of its platform, for `emscape link`; without it the receiver is at every voxel"),
          byDefault("gain_dbi", kGain, ReceiverProfile{}.gain_dbi, "in every direction"),
          optional("antenna", object(antennaSpec()),
                   "pattern and gain, in place of gain_dbi; needs platform"),
          optional("scan", object(scanSpec()),
                   "motion of the beam; by default fixed along the heading; needs antenna"),
          byDefault("losses_db", kLoss, ReceiverProfile{}.losses_db, "between antenna and receiver"),
          optional("noise_figure_db", kNoiseFigure,
                   "referred to 290 K; required with a platform and for sinr_db"),
          optional("antenna_temperature_k", kNoiseTemperature, "noise from sky and ground; by default 290"),
          antennaNoiseKey("; needs platform"),
          optional("polarization", choiceOf<Polarization>(), "by default that of each emitter"),
          crossPolarKey(),
          optional("center_frequency_hz", kFrequency,
                   "by default that of each emitter; for sinr_db that of the wanted one"),
          optional("bandwidth_hz", kBandwidth,
                   "by default that of each emitter's signal; required with a platform and for noise"),
          optional("sensitivity_dbm", number("dBm").from(-300).to(100),
                   "smallest power, after losses_db, at which a signal is received"),
          optional("required_sinr_db", number("dB").from(-100).to(100),
                   "smallest ratio to noise and interference at which a signal is received"),
      },
      {},
      {{"platform", "noise_figure_db"},
       {"platform", "bandwidth_hz"},
       {"antenna", "platform"},
       {"scan", "antenna"},
       {"antenna_noise", "platform"}}};
  return spec;
}

const ObjectSpec& targetSpec() {
  static const ObjectSpec spec{
      "target",
      "",
      {
          required("name", kName, ""),
          required("platform", kName, "name of its platform"),
          optional("rcs_m2", kRcs, "radar cross section, the same from every aspect"),
          optional(
              "rcs_file", kFile,
              "CSV: azimuth_deg (clockwise from the nose), elevation_deg, rcs_dbsm; a full grid; without "
              "elevation_deg the same at all elevations; relative to the scenario's folder"),
          byDefault("swerling", kSwerling, double(Target{}.swerling),
                    "case of fluctuation; radars with detection albersheim take it as 0, with a warning"),
      },
      {{"rcs_m2", "rcs_file"}}};
  return spec;
}

}  // namespace emscape::scenario
