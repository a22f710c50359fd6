#include "scenario/schema.h"

#include <map>

#include "emscape/scenario/quantities.h"
#include "emscape/scenario/scenario.h"
#include "propagation/registry/model_info.h"
#include "scenario/antenna/taper.h"

namespace emscape::scenario {

namespace {

using document::DefaultValue;
using document::ValueType;
using document::spec::byDefault;
using document::spec::choice;
using document::spec::listOf;
using document::spec::number;
using document::spec::object;
using document::spec::optional;
using document::spec::required;
using document::spec::simple;
using document::spec::textOf;
using document::spec::Variants;
using propagation::Atmosphere;
using propagation::GasLosses;
using propagation::Ground;
using propagation::GroundKind;
using propagation::ModelInfo;
using propagation::Polarization;
using propagation::RadioClimate;
using propagation::RefractionProfile;

/// The names of an enumeration that counts from 0 to `last`.
template <class Enum>
ValueSpec choiceUpTo(Enum last) {
  std::vector<std::string> names;
  for (int i = 0; i <= static_cast<int>(last); ++i) names.emplace_back(toString(static_cast<Enum>(i)));
  return choice(std::move(names));
}

const ValueSpec kInteger = simple(ValueType::integer);
const ValueSpec kName = textOf(ValueType::text, 200);
const ValueSpec kFile = textOf(ValueType::file, 4096);
const ValueSpec kLatitude = number("deg").from(-90).to(90);
const ValueSpec kLongitude = number("deg").from(-180).to(180);
const ValueSpec kHeight = number("m").from(-12000).to(100000);
const ValueSpec kHeightAboveGround = number("m").from(0).to(100000);
const ValueSpec kAngle = number("deg").from(-360).to(360);
const ValueSpec kElevation = number("deg").from(-90).to(90);
const ValueSpec kTime = number("s").from(0).to(1e8);
const ValueSpec kFrequency = number("Hz").from(1e6).to(1e12);
const ValueSpec kBandwidth = number("Hz").above(0).to(1e11);
const ValueSpec kLoss = number("dB").from(0).to(100);
const ValueSpec kGain = number("dBi").from(-50).to(80);
const ValueSpec kNoiseFigure = number("dB").from(0).to(60);
const ValueSpec kNoiseTemperature = number("K").from(0).to(10000);
const ValueSpec kRcs = number("m2").above(0).to(1e9);
const ValueSpec kSwerling = kInteger.from(0).to(4);
constexpr int kMaxItems = 10000;

KeySpec latitudeKey() {
  return required("latitude_deg", kLatitude, "geodetic, WGS84");
}
KeySpec longitudeKey() {
  return required("longitude_deg", kLongitude, "WGS84, positive eastwards");
}
KeySpec heightMslKey() {
  return optional("height_msl_m", kHeight, "above EGM96 mean sea level");
}
KeySpec heightAglKey() {
  return optional("height_agl_m", kHeightAboveGround,
                  "above the ground; above mean sea level without terrain");
}

const ObjectSpec& originSpec() {
  static const ObjectSpec spec{
      "origin",
      "",
      {
          latitudeKey(),
          longitudeKey(),
          byDefault("height_msl_m", kHeight, 0.0, "bottom of the region, above EGM96 mean sea level"),
      }};
  return spec;
}

const ObjectSpec& regionSpec() {
  static const ObjectSpec spec{
      "region",
      "",
      {
          required("origin", object(originSpec()), "centre of the region's bottom"),
          byDefault("frame", choice({toString(FrameKind::altitude), toString(FrameKind::enu)}), "altitude",
                    "altitude: x east and y north along the ground, z above mean sea level; enu: a Cartesian "
                    "box tangent at the origin"),
          required("size_m", listOf(number("m").from(1).to(4e6), 3, 3),
                   "extent along x, y and z; a voxel's x and y differ by at most 1000 times"),
          required("dims", listOf(kInteger.from(2).to(4096), 3, 3),
                   "voxels along x, y and z; at most 2^31 in all"),
      }};
  return spec;
}

const ObjectSpec& terrainSpec() {
  static const ObjectSpec spec{
      "terrain",
      "",
      {
          required("files", listOf(kFile, 1, kMaxItems),
                   "elevation files (HGT, DTED, GeoTIFF, VRT), relative to the scenario's folder"),
          byDefault("vertical_datum", choice({"egm96", "ellipsoid", "egm2008"}), "egm96",
                    "datum of the files' heights; egm2008 (Copernicus GLO-30) needs PROJ's or "
                    "GeographicLib's grid of it"),
      }};
  return spec;
}

const ObjectSpec& atmosphereSpec() {
  static const ObjectSpec spec{
      "atmosphere",
      "",
      {
          byDefault("k_factor", number().from(0.5).to(10), Atmosphere{}.k_factor,
                    "effective earth radius over earth radius"),
          byDefault("pressure_hpa", number("hPa").from(300).to(1100), Atmosphere{}.pressure_hpa,
                    "at sea level"),
          byDefault("temperature_k", number("K").from(180).to(340), Atmosphere{}.temperature_k,
                    "at sea level"),
          byDefault("vapour_g_m3", number("g/m3").from(0).to(100), Atmosphere{}.vapour_g_m3, "water vapour"),
          byDefault("rain_mm_h", number("mm/h").from(0).to(200), Atmosphere{}.rain_mm_h,
                    "rain rate, everywhere up to rain_height_m; its loss is added to every model's"),
          optional("rain_height_m", number("m").from(0).to(20000),
                   "upper limit of the rain, above mean sea level; by default by latitude (P.839-2), 5000 in "
                   "the tropics; P.839-4's maps differ from it by up to 1.7 km at middle latitudes"),
          byDefault("gases", choiceUpTo(GasLosses::never), toString(Atmosphere{}.gases),
                    "attenuation by oxygen and water vapour; auto: with every model except free_space and "
                    "horizon; p528 and p452 include their own"),
          byDefault("refraction", choiceUpTo(RefractionProfile::exponential),
                    toString(Atmosphere{}.refraction),
                    "refractivity over height, for horizon, diffraction, two_ray and the directions of all "
                    "rays: linear, by k_factor, right up to about 10 km; exponential, from "
                    "sea_level_refractivity, at all heights"),
          byDefault("sea_level_refractivity", number().from(200).to(450), Atmosphere{}.sea_level_refractivity,
                    "N-units; for refraction: exponential, for itm, whose rays are bent by it, not by "
                    "k_factor, and "
                    "for the troposcatter of p1812 and p452"),
          byDefault("climate", choiceUpTo(RadioClimate::maritime_temperate_over_sea),
                    toString(Atmosphere{}.climate), "for itm's statistics"),
          optional("refractivity", object(refractivitySpec()),
                   "profiles of the air, for parabolic_equation; not together with k_factor, which the other "
                   "models then have by default, or from kind: linear"),
      }};
  return spec;
}

const ObjectSpec& groundSpec() {
  static const ObjectSpec spec{
      "ground",
      "",
      {
          byDefault("kind", choiceUpTo(GroundKind::concrete), toString(Ground{}.kind),
                    "electrical constants of the ground; for sea and fresh water by frequency"),
          optional("relative_permittivity", number().from(1).to(200), "by default that of the kind"),
          optional("conductivity_s_m", number("S/m").from(0).to(100), "by default that of the kind"),
          byDefault("roughness_m", number("m").from(0).to(1000), Ground{}.roughness_m,
                    "standard deviation of the surface's height, for two_ray"),
          optional("surface_msl_m", kHeight,
                   "height of the smooth surface of two_ray and p528; by default of the ground below each "
                   "emitter"),
          optional(
              "sea_by_height", simple(ValueType::boolean),
              "true: sea where the terrain is at or below mean sea level; diffraction weighs the losses over "
              "sea and over this ground by their parts of the path; p1812 and p452 have their own, `zone`"),
      }};
  return spec;
}

/// The section of a propagation model in an emitter.
const ObjectSpec& settingsSpec(const ModelInfo& model) {
  static const std::map<propagation::PropagationModel, ObjectSpec> specs = [] {
    const propagation::ModelSettings defaults;
    std::map<propagation::PropagationModel, ObjectSpec> all;
    for (const ModelInfo& row : propagation::models()) {
      ObjectSpec& spec = all[row.model] = {row.name, "", {}};
      for (const propagation::Setting& setting : row.settings) {
        const double value = setting.get(defaults);
        const ValueSpec plain = number(setting.unit).from(setting.min).to(setting.max);
        if (setting.has_auto) {
          spec.keys.push_back(byDefault(setting.key, plain.orWord("auto"), "auto", setting.description));
          continue;
        }
        const bool is_number = setting.choices.empty();
        spec.keys.push_back(byDefault(
            setting.key, is_number ? plain : choice(setting.choices),
            is_number ? DefaultValue(value) : DefaultValue(setting.choices[static_cast<std::size_t>(value)]),
            setting.description));
      }
    }
    return all;
  }();
  return specs.at(model.model);
}

/// The choice of a model, and a section for each that has settings.
std::vector<KeySpec> propagationKeys() {
  std::vector<std::string> names;
  for (const ModelInfo& model : propagation::models()) names.push_back(model.name);
  std::vector<KeySpec> keys{byDefault("propagation", choice(names), toString(Emitter{}.propagation.model),
                                      "model of the path loss")};
  for (const ModelInfo& model : propagation::models()) {
    if (model.settings.empty()) continue;
    keys.push_back(optional(model.name, object(settingsSpec(model)), model.settings_description));
  }
  return keys;
}

/// The keys of an emitter: those before the choice of a propagation model, that choice, and the rest.
std::vector<KeySpec> withPropagation(std::vector<KeySpec> keys, const std::vector<KeySpec>& rest) {
  const std::vector<KeySpec> of_models = propagationKeys();
  keys.insert(keys.end(), of_models.begin(), of_models.end());
  keys.insert(keys.end(), rest.begin(), rest.end());
  return keys;
}

const ObjectSpec& positionSpec() {
  static const ObjectSpec spec{"position",
                               "",
                               {latitudeKey(), longitudeKey(), heightMslKey(), heightAglKey(),
                                optional("height_ellipsoid_m", kHeight, "above the WGS84 ellipsoid")},
                               {{"height_msl_m", "height_agl_m", "height_ellipsoid_m"}}};
  return spec;
}

KeySpec headingKey(DefaultValue default_value) {
  return byDefault("heading_deg", kAngle, std::move(default_value), "clockwise from true north");
}
KeySpec pitchKey() {
  return byDefault("pitch_deg", kElevation, 0.0, "nose up");
}
KeySpec rollKey() {
  return byDefault("roll_deg", kAngle, 0.0, "right wing down");
}

const ObjectSpec& attitudeSpec() {
  static const ObjectSpec spec{"attitude", "", {headingKey(0.0), pitchKey(), rollKey()}};
  return spec;
}

const ObjectSpec& trackSpec() {
  static const ObjectSpec spec{
      "track",
      "",
      {required("file", kFile,
                "CSV with a header line: t_s, latitude_deg, longitude_deg, height_msl_m or height_agl_m and, "
                "if wanted, heading_deg, pitch_deg, roll_deg; relative to the scenario's folder")}};
  return spec;
}

const ObjectSpec& platformSpec() {
  static const ObjectSpec spec{
      "platform",
      "",
      {
          required("name", kName, "emitters, receivers and targets refer to it by this name"),
          optional("position", object(positionSpec()), "of a fixed site"),
          optional("attitude", object(attitudeSpec()), "of a fixed site; level and north by default"),
          optional("track", object(trackSpec()), "of a moving platform"),
      },
      {{"position", "track"}},
      {{"attitude", "position"}}};
  return spec;
}

const ObjectSpec& antennaSpec() {
  const Variants beams{"gaussian", "sinc", "cosecant2"}, apertures{"sinc", "phased_array"};
  static const ObjectSpec spec{
      "antenna",
      "pattern",
      {
          required("pattern", choiceUpTo(AntennaForm::cuts),
                   "shape of the beam; file: MSI/PLN or a CSV grid; cuts: two CSV cuts"),
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
          optional("gain_dbi", kGain, "at the maximum; by default the file's own, which only MSI/PLN has",
                   {"file"}),
          required("gain_dbi", kGain, "at the maximum", {"cosecant2", "cuts"}),
          required("beamwidth_az_deg", number("deg").above(0).to(360), "between half-power points", beams),
          required("beamwidth_el_deg", number("deg").above(0).to(180), "between half-power points", beams),
          byDefault(
              "side_lobe_db", number("dB").from(-100).to(0), -40.0,
              "lower limit of the pattern, relative to the maximum; in nulls and behind the antenna too",
              {"gaussian", "sinc", "cosecant2", "phased_array"}),
          byDefault("taper", choiceUpTo(TaperKind::cosine), toString(TaperKind::uniform),
                    "amplitude over the aperture, in both planes: first side lobes at -13.3 dB (uniform), "
                    "-23 dB (cosine) or taper_side_lobe_db (taylor)",
                    apertures),
          byDefault("taper_side_lobe_db", number("dB").from(-60).to(-15), -30.0,
                    "design level of the first side lobes; taper: taylor alone", apertures),
          byDefault("max_elevation_deg", number("deg").above(0).to(90), 40.0,
                    "end of the cosecant-squared part", {"cosecant2"}),
          required("columns", kInteger.from(1).to(1024), "elements in azimuth", {"phased_array"}),
          required("rows", kInteger.from(1).to(1024), "elements in elevation", {"phased_array"}),
          byDefault("spacing_wavelengths", number().from(0.1).to(1), 0.5, "between elements",
                    {"phased_array"}),
          byDefault("element_exponent", number().from(0).to(10), 0.5,
                    "exponent of the element's amplitude, a power of the cosine off boresight",
                    {"phased_array"}),
          required("file", kFile, "relative to the scenario's folder", {"file"}),
          required("azimuth_file", kFile, "CSV: azimuth_deg, attenuation_db", {"cuts"}),
          required("elevation_file", kFile, "CSV: elevation_deg, attenuation_db", {"cuts"}),
      }};
  return spec;
}

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

const ObjectSpec& scanSpec() {
  const Variants sweeps{"sector", "raster"};
  static const ObjectSpec spec{
      "scan",
      "kind",
      {
          required("kind", choiceUpTo(ScanKind::track),
                   "motion of the beam; track: a radar's antenna that turns onto its target"),
          byDefault(
              "azimuth_deg", kAngle, 0.0,
              "off the platform's heading, clockwise: boresight; rotate: at t = 0; sector, raster: centre"),
          byDefault("elevation_deg", kElevation, 0.0,
                    "of the boresight, upwards; raster: centre of the bars"),
          required("rate_rpm", number("rpm").from(-6000).to(6000), "clockwise if positive", {"rotate"}),
          required("width_deg", number("deg").above(0).to(360), "whole azimuth sweep", sweeps),
          required("rate_deg_s", number("deg/s").above(0).to(1e5), "azimuth speed", sweeps),
          required("elevation_step_deg", number("deg").above(0).to(90), "between bars", {"raster"}),
          required("bars", kInteger.from(1).to(1000), "sweeps stacked, from the lowest upwards", {"raster"}),
          required("dwells", listOf(object(dwellSpec()), 1, kMaxItems), "repeated", {"dwell_list"}),
      }};
  return spec;
}

KeySpec crossPolarKey() {
  return byDefault("cross_polar_isolation_db", number("dB").from(0).to(100), kCrossPolarIsolation_db,
                   "isolation of the orthogonal polarisation by the antenna");
}

KeySpec antennaNoiseKey() {
  return optional(
      "antenna_noise", choice({"sky"}),
      "in place of antenna_temperature_k: the clear sky at the frequency and the boresight's "
      "elevation (galaxy by P.372, gases by P.676), and the ground at 290 K in 0.124 of the pattern");
}

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
          optional("polarization", choiceUpTo(Polarization::circular_left),
                   "for jamming; by default the emitter's. target_rcs_m2 is that between the two"),
          crossPolarKey(),
          optional(
              "pulses", kInteger.from(1).to(1e6),
              "integrated on a target; by default the hits of one scan, from the waveform, the beamwidth "
              "and the scan's rate; 1 without a waveform or without a scan"),
          byDefault("pfa", number().above(0).to(0.5), RadarReceiver{}.pfa, "probability of false alarm"),
          byDefault("swerling", kSwerling, double(RadarReceiver{}.swerling), "case of target fluctuation"),
          byDefault("detection", choiceUpTo(DetectionMethod::shnidman), toString(RadarReceiver{}.detection),
                    "method of detection_probability: exact statistics or a formula; albersheim only with "
                    "swerling 0"),
          byDefault(
              "beam_shape_loss", choiceUpTo(BeamShapeLoss::barton), toString(RadarReceiver{}.beam_shape_loss),
              "of pulses received off the beam's peak, per scanned plane: blake 1.6 dB, barton 1.23 dB"),
          optional("cfar_cells", kInteger.from(1).to(10000),
                   "reference cells of a cell-averaging CFAR, for its loss; by default the noise level is "
                   "known"),
          optional("binary_threshold", kInteger.from(1).to(1e4),
                   "M of M-of-N integration over N = pulses, for its loss; by default the pulses are added "
                   "up"),
          optional("required_signal_to_jammer_db", number("dB").from(-100).to(100),
                   "required for burn-through; by default that of a detection probability of 0.5"),
          byDefault("target_rcs_m2", kRcs, RadarReceiver{}.target_rcs_m2, "radar cross section"),
      }};
  return spec;
}

const ObjectSpec& waveformSpec() {
  static const ObjectSpec spec{
      "waveform",
      "",
      {
          required("prf_hz", number("Hz").above(0).to(1e8), "pulse repetition frequency"),
          required("pulse_width_s", number("s").above(0).to(1),
                   "of the transmitted pulse, before compression; shorter than 1 / prf_hz"),
          optional("instrumented_range_m", number("m").above(0).to(1e8),
                   "beyond which the radar does not look; reports say where a point is beyond it"),
      }};
  return spec;
}

const ObjectSpec& mtiSpec() {
  const ValueSpec spread = number("m/s").from(0).to(1000);
  static const ObjectSpec spec{
      "mti",
      "",
      {
          required(
              "kind", choiceUpTo(MtiKind::pulse_doppler),
              "canceller: binomial weights of alternating sign; pulse_doppler: a bank of coherent filters"),
          byDefault("pulses", kInteger.from(2).to(1024), double(Mti{}.pulses), "that the filter weighs"),
          byDefault("surface_spread_m_s", spread, Mti{}.surface_spread_mps,
                    "standard deviation of the radial velocities of land and sea, the scanning included"),
          byDefault("rain_spread_m_s", spread, Mti{}.rain_spread_mps, "the same of rain"),
          optional("improvement_limit_db", number("dB").from(0).to(200),
                   "largest improvement that the radar's stability permits"),
      }};
  return spec;
}

const ObjectSpec& clutterSpec() {
  static const ObjectSpec spec{
      "clutter",
      "",
      {
          optional("land", choiceUpTo(LandKind::urban),
                   "kind of land, for its constant gamma; posts above 0 m, and all others without sea_state"),
          optional("land_gamma_db", number("dB").from(-80).to(30),
                   "gamma at the radar's frequency, in place of land"),
          optional("sea_state", kInteger.from(0).to(6), "of the posts at or below mean sea level"),
          optional("rain", simple(ValueType::boolean), "true: echo of the atmosphere's rain_mm_h"),
          optional("range_cell_m", number("m").above(0).to(1e6),
                   "length of the resolution cell; by default c pulse_width_s / 2, that of a pulse without "
                   "compression"),
          optional("mti", object(mtiSpec()), "Doppler filter; by default none"),
          optional(
              "target_radial_speed_m_s", number("m/s").from(-20000).to(20000),
              "in volumes; by default the mean response of all speeds (canceller), the middle between two "
              "blind speeds (pulse_doppler)"),
      }};
  return spec;
}

const ObjectSpec& emitterSpec() {
  static const ObjectSpec spec{
      "emitter",
      "kind",
      withPropagation(
          {
              required("name", kName, "on pictures and in volumes"),
              required("platform", kName, "name of its platform"),
              required("kind", choiceUpTo(EmitterKind::jammer), "kind"),
              required("frequency_hz", kFrequency, "carrier"),
              byDefault("bandwidth_hz", number("Hz").from(0).to(1e11), Emitter{}.bandwidth_hz,
                        "of the signal; 0: narrower than any receiver"),
              required("power_w", number("W").above(0).to(1e12), "peak, at the transmitter's output"),
              byDefault("losses_db", kLoss, Emitter{}.losses_db, "transmit path, one way"),
              byDefault("polarization", choiceUpTo(Polarization::circular_left),
                        toString(Emitter{}.polarization), "of the transmitted wave"),
              required("antenna", object(antennaSpec()), "pattern and gain"),
              optional("scan", object(scanSpec()), "motion of the beam; by default fixed along the heading"),
          },
          {
              required("receiver", object(radarReceiverSpec()), "the radar's own", {"radar"}),
              optional("waveform", object(waveformSpec()),
                       "the pulses; without it the mean power is taken as power_w", {"radar"}),
              optional("clutter", object(clutterSpec()),
                       "echoes of land, sea and rain, for sclnr_db and detection_probability; needs waveform",
                       {"radar"}),
              optional("active_s", listOf(listOf(kTime, 2, 2), 1, kMaxItems),
                       "[begin, end) of the times at which it radiates; always by default"),
          }),
      {},
      {{"clutter", "waveform"}}};
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
          optional("antenna", object(antennaSpec()), "pattern and gain, in place of gain_dbi"),
          optional("scan", object(scanSpec()), "motion of the beam; by default fixed along the heading"),
          byDefault("losses_db", kLoss, ReceiverProfile{}.losses_db, "between antenna and receiver"),
          optional("noise_figure_db", kNoiseFigure,
                   "referred to 290 K; required with a platform and for sinr_db"),
          optional("antenna_temperature_k", kNoiseTemperature, "noise from sky and ground; by default 290"),
          antennaNoiseKey(),
          optional("polarization", choiceUpTo(Polarization::circular_left),
                   "by default that of each emitter"),
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
          optional("rcs_file", kFile,
                   "CSV: azimuth_deg (clockwise from the nose), elevation_deg, rcs_dbsm; a full grid, "
                   "relative to the scenario's folder"),
          byDefault("swerling", kSwerling, double(Target{}.swerling), "case of fluctuation"),
      },
      {{"rcs_m2", "rcs_file"}}};
  return spec;
}

const ObjectSpec& bandSpec() {
  static const ObjectSpec spec{"band",
                               "",
                               {
                                   required("name", kName, ""),
                                   required("begin_hz", kFrequency, "included"),
                                   required("end_hz", kFrequency, "excluded"),
                               }};
  return spec;
}

std::vector<std::string> quantityChoices() {
  std::vector<std::string> names;
  for (const QuantityInfo& row : quantityTable()) names.emplace_back(row.name);
  return names;
}

const ObjectSpec& intervalSpec() {
  static const ObjectSpec spec{
      "interval",
      "kind",
      {
          required("kind", choiceUpTo(IntervalKind::cumulative),
                   "what a volume shows of the time from its own on: the field at its time, the largest of "
                   "each emitter, the mean power, or the probability of at least one detection"),
          optional("seconds", number("s").above(0).to(1e7),
                   "duration; by default step_s. An instant has none"),
          optional("turns", number().above(0).to(1e5),
                   "duration in turns of each scan: its turns, sweeps there and back, or cycles"),
      }};
  return spec;
}

const ObjectSpec& outputSpec() {
  static const ObjectSpec spec{
      "output",
      "",
      {
          byDefault("quantities", listOf(choice(quantityChoices()), 1, kMaxItems).distinct(),
                    OutputSpec{}.quantities, "one volume per quantity"),
          byDefault("combine", choiceUpTo(CombineMode::per_band), toString(OutputSpec{}.combine),
                    "combination of the emitters"),
          byDefault("radar_look", choiceUpTo(RadarLook::target), toString(OutputSpec{}.radar_look),
                    "for snr_db and detection_probability: beams in the direction of their scans at the "
                    "time, or towards each voxel (coverage)"),
          byDefault("floor", number().from(-1000).to(1000), OutputSpec{}.floor,
                    "lowest stored value, in each quantity's unit"),
          byDefault("count_threshold_dbwm2", number("dBW/m2").from(-1000).to(1000),
                    OutputSpec{}.count_threshold_dbwm2,
                    "emitter_count counts emitters above it, occupancy the time in which they are"),
          optional("interval", object(intervalSpec()), "of time that a volume covers; by default an instant"),
          optional("receiver", kName,
                   "name of the receiver, without a platform, of received_power_dbm, sinr_db and "
                   "intercept_margin_db; by default the first"),
          optional("wanted_emitter", kName,
                   "name of the emitter whose signal sinr_db is of; all others are interference"),
          byDefault("detection_threshold", number().above(0).to(1), OutputSpec{}.detection_threshold,
                    "detection_age_s: probability from which a look counts as a detection"),
      }};
  return spec;
}

}  // namespace

const char* toString(AntennaForm form) {
  static constexpr const char* kNames[] = {"isotropic",    "gaussian", "sinc", "cosecant2",
                                           "phased_array", "file",     "cuts"};
  return kNames[static_cast<int>(form)];
}

const ObjectSpec& scenarioSpec() {
  static const ObjectSpec spec{
      "scenario",
      "",
      {
          required("schema_version", kInteger.from(1).to(1), "of this format"),
          required("name", kName, "of the scenario"),
          optional("epoch", simple(ValueType::timestamp), "the time of t = 0, UTC"),
          byDefault("duration_s", kTime, Clock{}.duration_s, "of the scenario"),
          byDefault("step_s", number("s").from(1e-6).to(1e8), Clock{}.step_s,
                    "between volumes; at most 10^7 in all"),
          required("region", object(regionSpec()), "the box of the field"),
          optional("terrain", object(terrainSpec()),
                   "the ground; by default a smooth earth at mean sea level"),
          optional("atmosphere", object(atmosphereSpec()), "refraction and attenuation by the air"),
          optional("ground", object(groundSpec()), "electrical properties of the ground"),
          required("platforms", listOf(object(platformSpec()), 1, kMaxItems).distinct(),
                   "carriers of emitters, receivers and targets"),
          required("emitters", listOf(object(emitterSpec()), 1, kMaxItems).distinct(),
                   "radars, transmitters and jammers"),
          optional("receivers", listOf(object(receiverSpec()), 1, kMaxItems).distinct(),
                   "at every voxel, for received_power_dbm, sinr_db and intercept_margin_db; with a platform "
                   "there, for `emscape link`"),
          optional("targets", listOf(object(targetSpec()), 1, kMaxItems).distinct(),
                   "of the radars, for `emscape link`"),
          optional("bands", listOf(object(bandSpec()), 1, kMaxItems).distinct(), "for combine per_band"),
          optional("output", object(outputSpec()), "quantities and their combination"),
      }};
  return spec;
}

const ObjectSpec& trackRowSpec() {
  static const ObjectSpec spec{
      "track file",
      "",
      {required("t_s", number("s").from(-1e8).to(1e8), "since the epoch"), latitudeKey(), longitudeKey(),
       heightMslKey(), heightAglKey(), headingKey({}), pitchKey(), rollKey()},
      {{"height_msl_m", "height_agl_m"}}};
  return spec;
}

}  // namespace emscape::scenario
