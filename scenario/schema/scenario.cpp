// The scenario file as a whole.
#include "emscape/scenario/model/scenario.h"

#include "scenario/schema/sections.h"
#include "scenario/schema/values.h"

namespace emscape::scenario {
namespace {

using document::ValueType;
using document::spec::byDefault;
using document::spec::listOf;
using document::spec::number;
using document::spec::object;
using document::spec::optional;
using document::spec::required;
using document::spec::simple;

}  // namespace

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

}  // namespace emscape::scenario
