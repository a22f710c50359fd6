// Section of an emitter.
#include <map>

#include "emscape/scenario/model/scenario.h"
#include "propagation/registry/model_info.h"
#include "scenario/schema/sections.h"
#include "scenario/schema/values.h"

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
using propagation::ModelInfo;
using propagation::Polarization;

/// The section of a propagation model in an emitter.
const ObjectSpec& settingsSpec(const ModelInfo& model) {
  static const std::map<propagation::PropagationModel, ObjectSpec> specs = [] {
    const propagation::ModelSettings defaults;
    std::map<propagation::PropagationModel, ObjectSpec> all;
    for (const ModelInfo& row : propagation::models()) {
      ObjectSpec& spec = all[row.model] = {row.name, "", {}};
      for (const propagation::Setting& setting : row.settings) {
        const double value = setting.get(defaults);
        const ValueSpec any = setting.is_whole ? kInteger : number(setting.unit);
        const ValueSpec plain = any.from(setting.min).to(setting.max);
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

const ObjectSpec& waveformSpec() {
  static const ObjectSpec spec{
      "waveform",
      "",
      {
          required("prf_hz", number("Hz").above(0).to(1e8), "pulse repetition frequency"),
          required("pulse_width_s", number("s").above(0).to(1),
                   "of the transmitted pulse, before compression; shorter than 1 / prf_hz"),
          optional("instrumented_range_m", number("m").above(0).to(1e8),
                   "radars: beyond which the radar does not look"),
          optional("limits_detection", simple(ValueType::boolean),
                   "radars: true (the default): nothing is detected beyond the instrumented and the "
                   "unambiguous range, "
                   "and echoes that arrive while the radar transmits are weaker by the part that is lost; "
                   "false: detection wherever there are echoes"),
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
              "kind", choiceOf<MtiKind>(),
              "canceller: binomial weights of alternating sign; pulse_doppler: a bank of coherent filters"),
          byDefault("pulses", kInteger.from(2).to(1024), double(Mti{}.pulses),
                    "that the filter weighs; canceller: at most 10"),
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
          optional("land", choiceOf<LandKind>(),
                   "kind of land, for its constant gamma; posts above 0 m, and all others without sea_state"),
          optional("land_gamma_db", number("dB").from(-80).to(30),
                   "gamma at the radar's frequency, in place of land"),
          optional("sea_state", kInteger.from(0).to(6), "of the posts at or below mean sea level"),
          optional("rain", simple(ValueType::boolean), "true: echo of the atmosphere's rain_mm_h"),
          optional("range_cell_m", number("m").above(0).to(1e6),
                   "length of the resolution cell; by default c pulse_width_s / 2, that of a pulse without "
                   "compression"),
          optional("mti", object(mtiSpec()), "Doppler filter; by default none"),
          optional("independent_samples", kInteger.from(1).to(1e6),
                   "of the clutter among the pulses integrated; by default all of them, as noise"),
          optional(
              "target_radial_speed_m_s", number("m/s").from(-20000).to(20000),
              "in volumes; by default the mean response of all speeds (canceller), the middle between two "
              "blind speeds (pulse_doppler)"),
      }};
  return spec;
}

const ObjectSpec& blinkSpec() {
  const ValueSpec span = number("s").above(0).to(1e7);
  static const ObjectSpec spec{
      "blink",
      "",
      {
          required("on_s", span, "time for which it radiates"),
          required("off_s", span, "time between"),
          optional(
              "begin_s", kTime,
              "a time at which it begins to radiate, 0 if not given: jammers that take turns differ in it"),
      }};
  return spec;
}

}  // namespace

const ObjectSpec& emitterSpec() {
  static const ObjectSpec spec{
      "emitter",
      "kind",
      withPropagation(
          {
              required("name", kName, "on pictures and in volumes"),
              required("platform", kName, "name of its platform"),
              required("kind", choiceOf<EmitterKind>(), "what it is; its further keys depend on it"),
              byDefault("enabled", simple(ValueType::boolean), "true",
                        "false: switched off; the results are those of an emitter that never transmits"),
              required("frequency_hz", kFrequency, "carrier"),
              byDefault("bandwidth_hz", number("Hz").from(0).to(1e11), Emitter{}.bandwidth_hz,
                        "of the signal; 0: narrower than any receiver"),
              required("power_w", number("W").above(0).to(1e12), "peak, at the transmitter's output"),
              byDefault("losses_db", kLoss, Emitter{}.losses_db, "transmit path, one way"),
              byDefault("polarization", choiceOf<Polarization>(), toString(Emitter{}.polarization),
                        "of the transmitted wave"),
              required("antenna", object(antennaSpec()), "pattern and gain"),
              optional("scan", object(scanSpec()), "motion of the beam; by default fixed along the heading"),
          },
          {
              required("receiver", object(radarReceiverSpec()), "the radar's own", {"radar"}),
              optional("waveform", object(waveformSpec()),
                       "the pulses; without it the mean power is taken as power_w", {"radar", "jammer"}),
              optional("clutter", object(clutterSpec()),
                       "echoes of land, sea and rain, for sclnr_db and detection_probability; needs waveform",
                       {"radar"}),
              optional("active_s", listOf(listOf(kTime, 2, 2), 1, kMaxItems),
                       "[begin, end) of the times at which it radiates, such as [[0, 30], [60, 90]]; always "
                       "by default"),
              optional(
                  "blink", object(blinkSpec()),
                  "on and off by turns, within active_s, to the end of the scenario; at most 10000 times"),
          }),
      {},
      {{"clutter", "waveform"}}};
  return spec;
}

}  // namespace emscape::scenario
