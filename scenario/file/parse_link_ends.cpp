#include <fmt/format.h>

#include <cmath>

#include "emscape/base/error.h"
#include "scenario/antenna/shapes.h"
#include "scenario/file/parse_sections.h"

namespace emscape::scenario {

ReceiverProfile parseReceiverProfile(const Section& section) {
  ReceiverProfile receiver;
  receiver.name = section.text("name");
  receiver.gain_dbi = section.number("gain_dbi");
  receiver.losses_db = section.number("losses_db");
  receiver.noise_figure_db = section.optionalNumber("noise_figure_db");
  receiver.antenna_temperature_k =
      section.optionalNumber("antenna_temperature_k").value_or(receiver.antenna_temperature_k);
  if (section.has("polarization"))
    receiver.polarization = section.choice<propagation::Polarization>("polarization");
  receiver.cross_polar_isolation_db = section.number("cross_polar_isolation_db");
  receiver.center_frequency_hz = section.optionalNumber("center_frequency_hz").value_or(0);
  receiver.bandwidth_hz = section.optionalNumber("bandwidth_hz").value_or(0);
  receiver.sensitivity_dbm = section.optionalNumber("sensitivity_dbm");
  receiver.required_sinr_db = section.optionalNumber("required_sinr_db");
  return receiver;
}

PlacedReceiver parsePlacedReceiver(const Section& section, const std::vector<Platform>& platforms,
                                   ParseContext& context) {
  PlacedReceiver receiver;
  static_cast<ReceiverProfile&>(receiver) = parseReceiverProfile(section);
  receiver.platform = indexNamedBy(section, "platform", "platform", platforms, context);
  if (section.has("antenna")) {
    receiver.antenna = parseAntenna(section.section("antenna"), context);
    if (section.has("gain_dbi")) {
      context.problems.addError(section.locationOf("gain_dbi"),
                                "'gain_dbi' is the gain in every direction; 'antenna' has its own gain");
    }
  } else {
    // A faulty gain is a problem already, with its line.
    receiver.antenna = makeIsotropic(std::isnan(receiver.gain_dbi) ? 0.0 : receiver.gain_dbi);
  }
  receiver.scan = parseScan(section.section("scan"), receiver.antenna && receiver.antenna->is_array, context);
  parseAntennaNoise(section, receiver.center_frequency_hz, receiver.antenna, receiver.scan, context,
                    receiver.antenna_temperature_k);
  if (receiver.scan.kind == ScanKind::victim) {
    context.problems.addError(
        section.section("scan").locationOf("kind"),
        "'kind' is victim, for emitters; a receiver's antenna does not turn to a platform");
  }
  if (receiver.scan.kind == ScanKind::track) {
    context.problems.addWarning(
        section.section("scan").locationOf("kind"),
        fmt::format(
            "'kind' is track, which turns a radar onto its targets; the beam of the receiver '{}' stays",
            receiver.name));
  }
  return receiver;
}

Target parseTarget(const Section& section, const std::vector<Platform>& platforms, ParseContext& context) {
  Target target;
  target.name = section.text("name");
  target.platform = indexNamedBy(section, "platform", "platform", platforms, context);
  target.rcs_m2 = section.optionalNumber("rcs_m2").value_or(target.rcs_m2);
  target.swerling = section.integer("swerling");
  if (!section.has("rcs_file") || !context.addNamed(section, "rcs_file")) return target;
  const std::string file = context.resolve(section.text("rcs_file"));
  if (context.before != nullptr && context.before->rcs_tables.count(file) != 0)
    target.table = context.before->rcs_tables.at(file);
  try {
    if (!target.table) target.table = readRcsTable(file);
    context.files.rcs_tables[file] = target.table;
  } catch (const Error& error) {
    context.problems.addErrorElsewhere(section.locationOf("rcs_file"), error.location(), error.message());
  }
  return target;
}

}  // namespace emscape::scenario
