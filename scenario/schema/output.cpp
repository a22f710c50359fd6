// Sections of the output: bands, quantities, interval.
#include "emscape/scenario/model/quantities.h"
#include "emscape/scenario/model/scenario.h"
#include "scenario/schema/sections.h"
#include "scenario/schema/values.h"

namespace emscape::scenario {
namespace {

using document::spec::byDefault;
using document::spec::choice;
using document::spec::listOf;
using document::spec::number;
using document::spec::object;
using document::spec::optional;
using document::spec::required;

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
          required("kind", choiceOf<IntervalKind>(),
                   "what a volume shows of the time from its own on: the field at its time, the largest of "
                   "each emitter, the mean power, or the probability of at least one detection"),
          optional("seconds", number("s").above(0).to(1e7),
                   "duration; by default step_s. An instant has none"),
          optional("turns", number().above(0).to(1e5),
                   "duration in turns of each scan: its turns, sweeps there and back, or cycles"),
      }};
  return spec;
}

}  // namespace

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

const ObjectSpec& outputSpec() {
  static const ObjectSpec spec{
      "output",
      "",
      {
          byDefault("quantities", listOf(choice(quantityChoices()), 1, kMaxItems).distinct(),
                    OutputSpec{}.quantities, "one volume per quantity"),
          byDefault("combine", choiceOf<CombineMode>(), toString(OutputSpec{}.combine),
                    "combination of the emitters"),
          byDefault("radar_look", choiceOf<RadarAim>(), toString(OutputSpec{}.radar_look),
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
          byDefault("exposure_group", choiceOf<ExposureGroup>(), toString(OutputSpec{}.exposure_group),
                    "exposure_ratio: the people whose reference levels hold"),
      }};
  return spec;
}

}  // namespace emscape::scenario
