#include "scenario/file/parse_sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "base/files/file_reading.h"
#include "document/schema_check.h"
#include "document/text_edit.h"
#include "emscape/base/units.h"
#include "propagation/air/sky_noise.h"
#include "propagation/registry/model_info.h"
#include "scenario/antenna/shapes.h"
#include "scenario/antenna/tables.h"

namespace emscape::scenario {

namespace {

Taper taperOf(const Section& section) {
  return Taper(section.choice<TaperKind>("taper"), section.number("taper_side_lobe_db"));
}

constexpr std::size_t kMaxNamedFileBytes = std::size_t{64} << 20, kMaxTrackBytes = std::size_t{256} << 20;

/// @param default_dbi  gain of a section without one; NaN: by formula
AntennaPtr makeAntenna(const Section& section, ParseContext& context,
                       double default_dbi = std::numeric_limits<double>::quiet_NaN()) {
  const double azimuth_deg = section.number("beamwidth_az_deg"),
               elevation_deg = section.number("beamwidth_el_deg");
  const double side_lobe_db = section.number("side_lobe_db");
  const auto gainOr = [&](double formula_dbi) {
    return section.optionalNumber("gain_dbi").value_or(std::isnan(default_dbi) ? formula_dbi : default_dbi);
  };
  const auto gainOfBeam = [&] {
    const double formula_dbi = gainFromBeamwidths_dbi(azimuth_deg, elevation_deg);
    if (!section.has("gain_dbi") && formula_dbi > kMaxGain_dbi) {
      throw Error(
          ErrorCode::bad_input,
          fmt::format("beamwidths of {:g} deg by {:g} deg are those of a gain of {:.4g} dBi, above {:g} "
                      "dBi; give wider ones, or 'gain_dbi'",
                      azimuth_deg, elevation_deg, formula_dbi, kMaxGain_dbi));
    }
    return gainOr(formula_dbi);
  };
  switch (section.choice<AntennaForm>("pattern")) {
    case AntennaForm::isotropic:
      return makeIsotropic(section.number("gain_dbi"));
    case AntennaForm::gaussian:
      return makeGaussian(gainOfBeam(), azimuth_deg, elevation_deg, side_lobe_db);
    case AntennaForm::sinc:
      return makeSinc(gainOfBeam(), azimuth_deg, elevation_deg, side_lobe_db, taperOf(section));
    case AntennaForm::cosecant2:
      return makeCosecant2(section.number("gain_dbi"), azimuth_deg, elevation_deg,
                           section.number("max_elevation_deg"), side_lobe_db);
    case AntennaForm::phased_array: {
      const int columns = section.integer("columns"), rows = section.integer("rows");
      const double spacing_wavelengths = section.number("spacing_wavelengths");
      const Taper taper = taperOf(section);
      return makePhasedArray(gainOr(gainFromArray_dbi(columns, rows, spacing_wavelengths, taper)), columns,
                             rows, spacing_wavelengths, section.number("element_exponent"), side_lobe_db,
                             taper);
    }
    case AntennaForm::file: {
      const std::string file = context.resolve(section.text("file"));
      return readAntenna(file, gainOr(std::numeric_limits<double>::quiet_NaN()),
                         &context.files.antenna_bands[file]);
    }
    case AntennaForm::cuts:
      return readCsvCuts(context.resolve(section.text("azimuth_file")),
                         context.resolve(section.text("elevation_file")), section.number("gain_dbi"));
  }
  return nullptr;
}

/// An antenna; a gain by formula is limited to the pattern's directivity.
AntennaPtr makeConsistentAntenna(const Section& section, ParseContext& context) {
  AntennaPtr antenna = makeAntenna(section, context);
  const bool has_formula =
      !section.has("gain_dbi") && section.choice<AntennaForm>("pattern") != AntennaForm::file;
  if (!has_formula || antenna->gain_dbi <= antenna->directivity_dbi()) return antenna;
  return makeAntenna(section, context, antenna->directivity_dbi());
}

std::vector<TimeInterval> parseActive(const Section& section, ParseContext& context) {
  std::vector<TimeInterval> intervals;
  const auto lists = section.numberLists("active_s");
  for (std::size_t i = 0; i < lists.size(); ++i) {
    if (lists[i].size() != 2) continue;
    intervals.push_back({lists[i][0], lists[i][1]});
    if (lists[i][0] >= lists[i][1]) {
      context.problems.addError(
          section.locationOf("active_s", i),
          fmt::format("the interval from {} s to {} s ends before it begins", lists[i][0], lists[i][1]));
    }
  }
  return intervals;
}

RadarReceiver parseReceiver(const Section& section, ParseContext& context) {
  RadarReceiver receiver;
  receiver.noise_figure_db = section.number("noise_figure_db");
  receiver.antenna_temperature_k = section.number("antenna_temperature_k");
  receiver.bandwidth_hz = section.number("bandwidth_hz");
  receiver.losses_db = section.number("losses_db");
  receiver.processing_gain_db = section.number("processing_gain_db");
  if (section.has("polarization"))
    receiver.polarization = section.choice<propagation::Polarization>("polarization");
  receiver.cross_polar_isolation_db = section.number("cross_polar_isolation_db");
  if (section.has("pulses")) receiver.pulses = section.integer("pulses");
  receiver.pfa = section.number("pfa");
  receiver.swerling = section.integer("swerling");
  receiver.detection = section.choice<DetectionMethod>("detection");
  if (receiver.detection == DetectionMethod::albersheim && receiver.swerling != 0) {
    context.problems.addError(section.locationOf("detection"),
                              fmt::format("'detection' is albersheim, which supports only steady "
                                          "(non-fluctuating) targets (swerling 0), not swerling {}",
                                          receiver.swerling));
  }
  receiver.beam_shape_loss = section.choice<BeamShapeLoss>("beam_shape_loss");
  receiver.cfar_cells = section.integer("cfar_cells");
  receiver.binary_threshold = section.integer("binary_threshold");
  receiver.required_signal_to_jammer_db = section.optionalNumber("required_signal_to_jammer_db");
  receiver.target_rcs_m2 = section.number("target_rcs_m2");
  if (section.has("side_lobe_blanking")) {
    const Section blanking = section.section("side_lobe_blanking");
    receiver.side_lobe_blanking =
        SideLobeBlanking{blanking.number("auxiliary_gain_dbi"), blanking.number("threshold_db")};
  }
  return receiver;
}

/// An auxiliary channel that is stronger than the main beam would blank the radar's own echoes.
void checkBlanking(const Emitter& radar, const Section& receiver, ParseContext& context) {
  const auto& blanking = radar.receiver.side_lobe_blanking;
  if (!blanking || !radar.antenna) return;
  const double highest_dbi = radar.antenna->gain_dbi + blanking->threshold_db;
  if (blanking->auxiliary_gain_dbi < highest_dbi) return;
  context.problems.addError(
      receiver.section("side_lobe_blanking").locationOf("auxiliary_gain_dbi"),
      fmt::format("'auxiliary_gain_dbi' is {:g} dBi: with 'threshold_db' {:g} dB it must be below {:g} dBi, "
                  "or what the "
                  "main beam of '{}' receives would be blanked",
                  blanking->auxiliary_gain_dbi, blanking->threshold_db, highest_dbi, radar.name));
}

/// @param is_radar  else of a jammer, whose pulses have no ranges
std::optional<Waveform> parseWaveform(const Section& section, bool is_radar, ParseContext& context) {
  for (const char* key : {"instrumented_range_m", "limits_detection"}) {
    if (is_radar || !section.has(key)) continue;
    context.problems.addError(section.locationOf(key),
                              fmt::format("'{}' is of the waveform of radars, not of jammers", key));
  }
  const Waveform waveform{section.number("prf_hz"), section.number("pulse_width_s"),
                          section.optionalNumber("instrumented_range_m"),
                          section.optionalBoolean("limits_detection").value_or(true)};
  if (waveform.dutyCycle() >= 1) {
    context.problems.addError(
        section.locationOf("pulse_width_s"),
        fmt::format("'pulse_width_s' is {} s: pulses that are repeated at {} Hz are shorter than {:.4g} s",
                    waveform.pulse_width_s, waveform.prf_hz, 1 / waveform.prf_hz));
  }
  if (!section.sound()) return std::nullopt;
  return waveform;
}

/// Warns of a receiver whose echo over noise exceeds that of a matched filter, which is P tau / (k T) for
/// each of the pulses that are summed coherently, or lacks the gain of such a sum.
void checkBandwidth(const Emitter& radar, const Section& receiver, ParseContext& context) {
  constexpr double kTolerance_db = 1;
  const bool sums = radar.clutter && radar.clutter->mti && radar.clutter->mti->kind == MtiKind::pulse_doppler;
  const double coherent = sums ? radar.clutter->mti->pulses : 1;
  const double excess_db = radar.receiver.processing_gain_db -
                           ratioToDb(radar.receiver.bandwidth_hz * radar.waveform->pulse_width_s * coherent);
  const bool has_gain = receiver.has("processing_gain_db");
  if (sums && radar.receiver.processing_gain_db == 0) {
    context.problems.addWarning(
        receiver.location(),
        fmt::format("the filter of '{}' sums {} pulses coherently, but 'processing_gain_db' is {}: its "
                    "echoes are those of one pulse. The sum has up to {:.1f} dB, less about 3 by its weights",
                    radar.name, coherent, has_gain ? "0" : "not given", ratioToDb(coherent)));
  }
  if (!(excess_db > kTolerance_db)) return;
  context.problems.addWarning(
      receiver.locationOf(has_gain ? "processing_gain_db" : "bandwidth_hz"),
      fmt::format("the echoes of '{}' are {:.1f} dB above those of a matched filter: a bandwidth of {:g} Hz, "
                  "pulses of {:g} s and {} together allow a 'processing_gain_db' of at most {:.1f}",
                  radar.name, excess_db, radar.receiver.bandwidth_hz, radar.waveform->pulse_width_s,
                  sums ? fmt::format("{} of them summed coherently", coherent) : "no coherent sum",
                  radar.receiver.processing_gain_db - excess_db));
}

/// Takes the number of integrated pulses from the waveform unless it is given, and compares it with the hits
/// of one scan, of which the Doppler filter uses a part.
void matchPulses(Emitter& radar, const Section& receiver, ParseContext& context) {
  const std::optional<double> hits =
      radar.waveform && radar.antenna
          ? hitsPerScan(radar.scan, radar.antenna->beamwidth_az_deg, radar.waveform->prf_hz)
          : std::nullopt;
  int& pulses = radar.receiver.pulses;
  const Mti* const filter = radar.clutter && radar.clutter->mti ? &*radar.clutter->mti : nullptr;
  if (hits) {
    const double most = filter == nullptr ? *hits : filter->outputsOf(*hits);
    if (!receiver.has("pulses")) {
      pulses = static_cast<int>(std::clamp(std::floor(most * (1 + 1e-9)), 1.0, 1e6));
    } else if (pulses > std::max(most, 1.0) * (1 + 1e-9)) {
      context.problems.addWarning(
          receiver.locationOf("pulses"),
          fmt::format(
              "'pulses' is {}, but one pass of the beam of '{}' gives {:.4g} hits{}; {} are integrated all "
              "the same. Without 'pulses' it is {}",
              pulses, radar.name, *hits,
              filter == nullptr ? ""
                                : fmt::format(", {:.4g} after its filter of {} pulses", most, filter->pulses),
              pulses, filter == nullptr ? "the hits" : "those after the filter"));
    }
    if (filter != nullptr && filter->pulses > *hits * (1 + 1e-9)) {
      context.problems.addWarning(
          receiver.location(),
          fmt::format("the Doppler filter of '{}' has {} pulses, but one pass of its beam "
                      "gives {:.4g} hits",
                      radar.name, filter->pulses, *hits));
    }
  }
  if (radar.receiver.binary_threshold > pulses) {
    context.problems.addError(receiver.locationOf("binary_threshold"),
                              fmt::format("'binary_threshold' is {}, more than the {} pulses integrated",
                                          radar.receiver.binary_threshold, pulses));
  }
  if (radar.waveform) checkBandwidth(radar, receiver, context);
}

/// The model and the settings of all models; settings of a model that is not used are an error.
propagation::ModelSettings parsePropagation(const Section& section, ParseContext& context) {
  propagation::ModelSettings settings;
  settings.model = section.choice<propagation::PropagationModel>("propagation");
  const propagation::ModelInfo& chosen = propagation::modelInfo(settings.model);
  for (const propagation::ModelInfo& model : propagation::models()) {
    if (model.settings.empty()) continue;
    const Section own = section.section(model.name);
    for (const propagation::Setting& setting : model.settings) {
      if (setting.has_auto && own.text(setting.key) == "auto") {
        setting.set(settings, 0);
      } else {
        setting.set(settings,
                    setting.choices.empty() ? own.number(setting.key) : own.choiceIndex(setting.key));
      }
    }
    if (model.model == chosen.model) settings.location = own.location();
    if (propagation::settingsEnter(model, chosen) || !section.has(model.name)) continue;
    context.problems.addError(
        section.locationOf(model.name),
        fmt::format("'{}' sets up a model that is not used: 'propagation' is {}", model.name, chosen.name));
  }
  return settings;
}

/// Index of the platform to which an emitter's antenna turns; -1: a problem.
int parseVictim(const Section& section, const Emitter& emitter, const std::vector<Platform>& platforms,
                ParseContext& context) {
  const Section scan = section.section("scan");
  const int victim = indexNamedBy(scan, "victim", "platform", platforms, context);
  if (victim >= 0 && victim == emitter.platform) {
    context.problems.addError(
        scan.locationOf("victim"),
        fmt::format("'victim' is '{}', the platform of '{}' itself", scan.text("victim"), emitter.name));
  }
  if (emitter.kind == EmitterKind::radar) {
    context.problems.addError(
        scan.locationOf("kind"),
        fmt::format("'kind' is victim, for jammers and transmitters; '{}' is a radar: track "
                    "turns it onto its targets",
                    emitter.name));
  }
  return victim;
}

}  // namespace

std::string ParseContext::resolve(const std::string& name) const {
  return (std::filesystem::path(file).parent_path() / std::filesystem::path(name))
      .lexically_normal()
      .string();
}

bool ParseContext::addNamed(const Section& section, const std::string& key, std::string* bytes) {
  const std::string name = section.text(key);
  if (name.empty()) return false;
  const std::string named = resolve(name);
  std::string digest;
  const auto isKnownTo = [&](const NamedFiles* read) {
    return bytes == nullptr && read != nullptr && read->digests.count(named) != 0;
  };
  if (isKnownTo(before) || isKnownTo(&files)) {
    digest = (isKnownTo(before) ? before : &files)->digests.at(named);
  } else {
    try {
      std::string content = readWholeText(named, bytes == nullptr ? kMaxNamedFileBytes : kMaxTrackBytes);
      document::ContentHash of_file;
      of_file.add(content);
      digest = of_file.hex();
      if (bytes != nullptr) *bytes = std::move(content);
    } catch (const Error& error) {
      problems.addError(section.locationOf(key), fmt::format("'{}': {}: {}", key, named, error.message()));
      return false;
    }
  }
  hash.add(digest);
  files.digests[named] = digest;
  return true;
}

AntennaPtr parseAntenna(const Section& section, ParseContext& context) {
  bool readable = true;
  for (const char* key : {"file", "azimuth_file", "elevation_file"}) {
    readable = (!section.has(key) || context.addNamed(section, key)) && readable;
  }
  if (!readable || !section.sound()) return nullptr;
  if (section.has("taper_side_lobe_db") && section.choice<TaperKind>("taper") != TaperKind::taylor) {
    context.problems.addError(section.locationOf("taper_side_lobe_db"),
                              "'taper_side_lobe_db' is the design level of taper: taylor; 'taper' is " +
                                  std::string(toString(section.choice<TaperKind>("taper"))));
  }
  const std::string description = document::flowText(*section.node(), true);
  AntennaPtr& antenna = context.files.antennas[description];
  if (!antenna && context.before != nullptr && context.before->antennas.count(description) != 0) {
    antenna = context.before->antennas.at(description);
    context.files.antenna_bands.insert(context.before->antenna_bands.begin(),
                                       context.before->antenna_bands.end());
  }
  try {
    if (!antenna) antenna = makeConsistentAntenna(section, context);
  } catch (const Error& error) {
    const SourceLocation location = error.location().file.empty() ? section.location() : error.location();
    context.problems.addErrorElsewhere(section.location(), location, error.message());
  }
  return antenna;
}

ScanSpec parseScan(const Section& section, bool steers_electronically, ParseContext& context) {
  ScanSpec scan;
  scan.kind = section.has("kind") ? section.choice<ScanKind>("kind") : ScanKind::fixed;
  scan.azimuth_deg = section.number("azimuth_deg");
  scan.elevation_deg = section.number("elevation_deg");
  const auto numberOrZero = [&](const char* key) { return section.optionalNumber(key).value_or(0); };
  scan.rate_rpm = numberOrZero("rate_rpm");
  // A turn of it would never end: what asks for whole turns has one direction.
  if (scan.kind == ScanKind::rotate && scan.rate_rpm == 0) scan.kind = ScanKind::fixed;
  scan.width_deg = numberOrZero("width_deg");
  scan.rate_deg_s = numberOrZero("rate_deg_s");
  scan.elevation_step_deg = numberOrZero("elevation_step_deg");
  scan.bars = std::max(section.integer("bars"), 1);
  const double highest_deg = std::abs(scan.elevation_deg) + (scan.bars - 1) / 2.0 * scan.elevation_step_deg;
  if (highest_deg > 90) {
    context.problems.addError(section.locationOf("bars"),
                              fmt::format("the bars reach {} deg of elevation, outside the "
                                          "allowed range -90 to 90 deg",
                                          highest_deg));
  }
  for (const Section& item : section.sections("dwells")) {
    const Dwell dwell{item.number("azimuth_deg"), item.number("elevation_deg"), item.number("duration_s")};
    scan.dwells.push_back(dwell);
    if (steers_electronically && std::abs(dwell.azimuth_deg) >= 90) {
      context.problems.addError(
          item.locationOf("azimuth_deg"),
          fmt::format("'azimuth_deg' is {}: a phased array is steered within less than 90 deg of its "
                      "boresight",
                      dwell.azimuth_deg));
    }
  }
  return scan;
}

void parseAntennaNoise(const Section& section, double frequency_hz, const AntennaPtr& antenna,
                       const ScanSpec& scan, ParseContext& context, double& antenna_temperature_k) {
  if (!section.has("antenna_noise")) return;
  if (section.has("antenna_temperature_k")) {
    context.problems.addError(section.locationOf("antenna_temperature_k"),
                              "'antenna_temperature_k' and 'antenna_noise' exclude each other");
  } else if (frequency_hz <= 0) {
    context.problems.addError(section.locationOf("antenna_noise"),
                              "'antenna_noise' needs the receiver's 'center_frequency_hz'");
  } else {
    antenna_temperature_k = propagation::antennaTemperature_k(
        frequency_hz, degToRad(scan.elevation_deg), degToRad(antenna ? antenna->beamwidth_el_deg : 180.0),
        context.atmosphere);
  }
}

Emitter parseEmitter(const Section& section, const std::vector<Platform>& platforms, ParseContext& context) {
  Emitter emitter;
  emitter.name = section.text("name");
  emitter.location = section.location();
  emitter.platform = indexNamedBy(section, "platform", "platform", platforms, context);
  emitter.kind = section.choice<EmitterKind>("kind");
  emitter.enabled = section.optionalBoolean("enabled").value_or(true);
  emitter.frequency_hz = section.number("frequency_hz");
  emitter.bandwidth_hz = section.number("bandwidth_hz");
  emitter.power_w = section.number("power_w");
  emitter.losses_db = section.number("losses_db");
  emitter.polarization = section.choice<propagation::Polarization>("polarization");
  emitter.frequency_location = section.locationOf("frequency_hz");
  emitter.propagation = parsePropagation(section, context);
  if (section.has("antenna")) emitter.antenna = parseAntenna(section.section("antenna"), context);
  const bool steers = emitter.antenna && emitter.antenna->is_array;
  emitter.scan = parseScan(section.section("scan"), steers, context);
  if (emitter.scan.kind == ScanKind::victim)
    emitter.scan.victim = parseVictim(section, emitter, platforms, context);
  if (emitter.scan.kind == ScanKind::track && emitter.kind != EmitterKind::radar) {
    context.problems.addWarning(
        section.section("scan").locationOf("kind"),
        fmt::format("'kind' is track, which turns a radar onto its targets; '{}' is a {}: its beam stays",
                    emitter.name, toString(emitter.kind)));
  }
  if (section.has("waveform"))
    emitter.waveform =
        parseWaveform(section.section("waveform"), emitter.kind == EmitterKind::radar, context);
  if (section.has("clutter")) emitter.clutter = parseClutter(section.section("clutter"), emitter, context);
  if (section.has("receiver")) {
    const Section receiver = section.section("receiver");
    emitter.receiver = parseReceiver(receiver, context);
    parseAntennaNoise(receiver, emitter.frequency_hz, emitter.antenna, emitter.scan, context,
                      emitter.receiver.antenna_temperature_k);
    matchPulses(emitter, receiver, context);
    checkBlanking(emitter, receiver, context);
  }
  emitter.active_s = parseActive(section, context);
  return emitter;
}

}  // namespace emscape::scenario
