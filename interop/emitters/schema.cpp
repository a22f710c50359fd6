// The table of emitter databases.
#include <algorithm>

#include "interop/emitters/emitter_database.h"
#include "scenario/schema/sections.h"
#include "scenario/schema/values.h"

namespace emscape::interop {
namespace {

using document::KeySpec;
using document::ObjectSpec;
using document::ValueType;
using document::spec::byDefault;
using document::spec::choice;
using document::spec::listOf;
using document::spec::number;
using document::spec::object;
using document::spec::optional;
using document::spec::required;
using document::spec::textOf;

/// The section of a scenario's emitter without what only a scenario has, and with some keys that a
/// recording may tell.
ObjectSpec emitterSpecWithout(const std::vector<std::string>& optional_keys, const std::string& name) {
  ObjectSpec spec = scenario::emitterSpec();
  spec.name = name;
  const auto is_of_scenarios = [](const KeySpec& key) {
    return key.name == "name" || key.name == "platform" || key.name == "active_s";
  };
  spec.keys.erase(std::remove_if(spec.keys.begin(), spec.keys.end(), is_of_scenarios), spec.keys.end());
  for (KeySpec& key : spec.keys) {
    if (std::find(optional_keys.begin(), optional_keys.end(), key.name) != optional_keys.end())
      key.required = false;
  }
  return spec;
}

const ObjectSpec& rowEmitterSpec() {
  static const ObjectSpec spec = emitterSpecWithout({"frequency_hz", "power_w"}, "database emitter");
  return spec;
}

const ObjectSpec& defaultEmitterSpec() {
  static const ObjectSpec spec =
      emitterSpecWithout({"frequency_hz", "power_w", "antenna", "receiver"}, "default emitter");
  return spec;
}

const ObjectSpec& matchSpec() {
  const auto pattern = textOf(ValueType::text, 2000).printable();
  const auto code = scenario::kInteger.from(0).to(255);
  static const ObjectSpec spec{
      "match",
      "",
      {
          optional("dis_name", scenario::kInteger.from(0).to(65535),
                   "DIS: emitter name (SISO-REF-010, UID 75)"),
          optional("dis_radio", scenario::kInteger.from(0).to(65535),
                   "DIS: number of the radio of a transmitter"),
          optional("function", code, "DIS: function of the emitter system (UID 76)"),
          optional("beam_function", listOf(code, 1, 256), "DIS: functions of the beam (UID 78), one of them"),
          optional("index", listOf(scenario::kInteger.from(0).to(65535), 1, 1000),
                   "DIS: beam parameter indices, one of them"),
          optional("dis_entity_type", pattern,
                   "DIS: kind.domain.country.category.subcategory.specific.extra; patterns, as 1.2.225.*"),
          optional("acmi_name", pattern, "ACMI: Name of the object; patterns with * and ?, separated by |"),
          optional("acmi_type", pattern, "ACMI: Type of the object, as Sea+*"),
          optional("asi_beam", pattern, "SIMDIS: description of the beam; patterns"),
          optional("cot_type", pattern, "Cursor on Target: beginning of the type, as a-f-S"),
          optional("beam_name", pattern, "name of the beam, in any format; patterns"),
          optional("object_name", pattern, "name of the object, in any format; patterns"),
      }};
  return spec;
}

const ObjectSpec& rowSpec() {
  static const ObjectSpec spec{
      "emitter row",
      "",
      {
          byDefault("name", scenario::kName, std::string("emitter"), "of the emitter, after its platform's"),
          optional("source", textOf(ValueType::text, 2000), "of the figures"),
          required("match", object(matchSpec()), "conditions; all that are given must hold"),
          byDefault("antenna_height_m", number("m").from(0).to(1000), 0.0,
                    "of the antenna above the object's reference point; its platform is raised by it"),
          required("emitter", object(rowEmitterSpec()),
                   "as in scenarios; frequency, power and scan are those of the recording where it has them"),
      }};
  return spec;
}

}  // namespace

const ObjectSpec& emitterDatabaseSpec() {
  static const ObjectSpec spec{
      "emitter database",
      "",
      {
          required("schema_version", scenario::kInteger.from(1).to(1), "of this format"),
          byDefault("emitters", listOf(object(rowSpec()), 0, scenario::kMaxItems), {},
                    "rows in the order in which they are tried"),
          optional("unmatched", choice({"warn", "ignore", "default"}),
                   "beams that no row matches: left out and named (warn, by default), left out, or given the "
                   "default"),
          optional("default", object(defaultEmitterSpec()),
                   "emitter of beams that no row matches; without an antenna a Gaussian beam as wide as the "
                   "beam's sweep"),
      }};
  return spec;
}

std::string emitterDatabaseJsonSchema() {
  return document::jsonSchema(emitterDatabaseSpec(), "Emscape emitter database",
                              "Emitters by what recordings say of them");
}

}  // namespace emscape::interop
