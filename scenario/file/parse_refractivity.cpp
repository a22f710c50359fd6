// Refractivity of a scenario: from its keys to profiles, and the members of an ensemble.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "base/math/random.h"
#include "base/text/utc.h"
#include "document/schema_check.h"
#include "propagation/parabolic_equation/air/bulk_duct.h"
#include "propagation/parabolic_equation/air/refractivity_field.h"
#include "propagation/registry/model_info.h"
#include "scenario/air/refractivity_file.h"
#include "scenario/file/parse_sections.h"

namespace emscape::scenario {
namespace {

using namespace propagation;
using document::NodeKind;

constexpr std::uint32_t kMaxDraws = 1000;
constexpr double kFarAboveSea_m = 50;

/// 32-bit FNV-1a: a counter for each key, independent of the other keys of the table.
std::uint32_t hashOf(const std::string& key) {
  std::uint32_t hash = 2166136261u;
  for (const char c : key) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619u;
  return hash;
}

/// The numbers of a section: as given, or drawn for a member of an ensemble.
class Values {
 public:
  explicit Values(const Section& section) : section_(section) {}

  /// Numbers of a member from here on. @param draw  counts the attempts for the same member
  void select(int member, std::uint32_t draw) {
    member_ = member;
    draw_ = draw;
  }
  /// The mean values from here on.
  void selectMean() { member_ = -1; }

  double operator()(const std::string& key) const {
    const Section spread = spreadOf(key);
    if (spread.node() == nullptr) return section_.number(key);
    const double mean = spread.number("mean");
    if (member_ < 0) return mean;
    const std::uint32_t word = philox4x32({static_cast<std::uint32_t>(member_), draw_, hashOf(key), 0},
                                          {static_cast<std::uint32_t>(section_.integer("seed")), 0})[0];
    const double value = mean + spread.number("deviation") * normalQuantile(fractionOf(word));
    const std::string fault = faultOf(key, fmt::format("{:.6g}", value), value);
    if (!fault.empty()) throw Error(ErrorCode::bad_input, fault);
    return value;
  }

  /// The keys that have a deviation.
  std::vector<std::string> spreadKeys() const {
    std::vector<std::string> keys;
    for (const document::MapEntry& entry : section_.node()->entries) {
      if (entry.value->kind == NodeKind::map) keys.push_back(entry.key);
    }
    return keys;
  }
  /// The fault of a value; empty if there is none.
  std::string faultOf(const std::string& key, const std::string& text, double value) const {
    const std::string kind = section_.text("kind");
    return document::rangeFault("'" + key + "'", text, value, refractivitySpec().find(key, &kind)->value);
  }

 private:
  Section spreadOf(const std::string& key) const {
    const std::string kind = section_.text("kind");
    static const ObjectSpec none{"", "", {}};
    const KeySpec* row = refractivitySpec().find(key, &kind);
    return row != nullptr && row->value.object != nullptr ? section_.section(key)
                                                          : Section(no_file_, nullptr, none);
  }

  const Section& section_;
  int member_ = -1;
  std::uint32_t draw_ = 0;
  std::string no_file_;
};

BulkAir bulkOf(const Section& section, const Values& values) {
  BulkInputs inputs;
  inputs.air_temperature_k = values("air_temperature_k");
  inputs.sea_temperature_k = values("sea_temperature_k");
  inputs.relative_humidity_percent = values("relative_humidity_percent");
  inputs.wind_m_s = values("wind_m_s");
  inputs.pressure_hpa = values("pressure_hpa");
  inputs.salinity_psu = section.number("salinity_psu");
  inputs.sensor_height_m = section.number("sensor_height_m");
  inputs.wind_height_m = section.optionalNumber("wind_height_m").value_or(inputs.sensor_height_m);
  return bulkAir(inputs);
}

/// @param measured  of profile and soundings, else not read
RefractivityField fieldOf(const Section& section, const Values& values, const RefractivityField& measured) {
  RefractivityField field;
  const auto holds = [&](RefractivityProfile profile) { field.profiles = {std::move(profile)}; };
  switch (section.choice<RefractivityKind>("kind")) {
    case RefractivityKind::standard:
      holds(standardRefractivity(values("surface_m_units")));
      break;
    case RefractivityKind::linear:
      holds(linearRefractivity(values("gradient_m_per_km") / 1000, values("surface_m_units")));
      break;
    case RefractivityKind::evaporation_duct:
      holds(evaporationDuct(values("duct_height_m"), values("surface_m_units")));
      break;
    case RefractivityKind::surface_duct:
      holds(surfaceDuct(values("top_m"), values("deficit_m_units"), values("surface_m_units")));
      break;
    case RefractivityKind::trilinear:
      holds(trilinearRefractivity(values("base_m"), values("top_m"), values("deficit_m_units"),
                                  values("surface_m_units")));
      break;
    case RefractivityKind::profile:
    case RefractivityKind::soundings:
      field = measured;
      for (RefractivityProfile& profile : field.profiles) profile = withUpperAir(std::move(profile));
      break;
    case RefractivityKind::bulk:
      holds(bulkOf(section, values).profile);
      break;
  }
  if (section.has("evaporation_duct_height_m"))
    field.evaporation_duct_m = values("evaporation_duct_height_m");
  return field;
}

/// The file of profile and soundings; null, and a problem, if it is faulty.
std::shared_ptr<const RefractivityFile> fileOf(const Section& section, ParseContext& context) {
  if (!context.addNamed(section, "file")) return nullptr;
  const std::string name = context.resolve(section.text("file"));
  const bool is_sounding = section.choice<RefractivityKind>("kind") == RefractivityKind::soundings;
  const std::string time = !is_sounding ? "" : section.has("time") ? section.text("time") : context.epoch_utc;
  const std::string identity = name + "|" + section.text("kind") + "|" + time;
  std::shared_ptr<const RefractivityFile>& file = context.files.refractivity[identity];
  if (context.before != nullptr && context.before->refractivity.count(identity) != 0) {
    file = context.before->refractivity.at(identity);
  }
  try {
    if (!file) {
      file = std::make_shared<const RefractivityFile>(is_sounding ? readSounding(name, parseUtc_ms(time))
                                                                  : readRefractivity(name));
    }
  } catch (const Error& error) {
    const SourceLocation at = error.location().file.empty() ? section.locationOf("file") : error.location();
    context.problems.addErrorElsewhere(section.locationOf("file"), at, error.message());
    return nullptr;
  }
  for (const std::string& warning : file->warnings)
    context.problems.addWarning(section.locationOf("file"), warning);
  return file;
}

/// A member: its values are drawn again until they are within their limits and the profile is possible.
RefractivityField memberOf(const Section& section, Values& values, const RefractivityField& measured,
                           int member) {
  for (std::uint32_t draw = 0;; ++draw) {
    values.select(member, draw);
    try {
      return fieldOf(section, values, measured);
    } catch (const Error& error) {
      if (draw + 1 < kMaxDraws) continue;
      throw Error(ErrorCode::bad_input,
                  fmt::format("member {} of the ensemble: {} draws gave no possible values; the last: {}",
                              member + 1, kMaxDraws, error.message()));
    }
  }
}

void warnOfEnsemble(const Section& section, const Values& values, ParseContext& context) {
  const std::vector<std::string> spread_keys = values.spreadKeys();
  const int members = section.integer("members");
  if (members == 1 && !spread_keys.empty()) {
    context.problems.addWarning(
        section.locationOf(spread_keys.front()),
        fmt::format("'{}' has a deviation, but 'members' is 1: its mean is taken", spread_keys.front()));
  }
  if (members > 1 && spread_keys.empty()) {
    context.problems.addWarning(
        section.locationOf("members"),
        fmt::format("'members' is {}, but no value has a deviation: there is one member", members));
  }
  if (section.has("quantile") && (members == 1 || spread_keys.empty())) {
    context.problems.addWarning(
        section.locationOf("quantile"),
        "'quantile' applies to an ensemble, which needs 'members' above 1 and a value "
        "with a deviation");
  }
}

constexpr double kFarInTime_h = 12, kFar_km = 300;

/// "sounding of USM00072649, 2023-11-18T12:00:00Z, 6 h before the epoch and 312 km from the region's origin"
/// @param wanted  what the sounding is nearest to: "epoch" or "time"
std::string sourceOf(const RefractivityFile& file, const std::string& wanted, const std::string& wanted_utc,
                     const Section& section, ParseContext& context) {
  if (!file.sounding) return file.description;
  const SoundingOrigin& sounding = *file.sounding;
  std::vector<std::string> parts, far;
  if (const auto wanted_ms = parseUtc_ms(wanted_utc)) {
    const double after_h = static_cast<double>(sounding.time_ms - *wanted_ms) / 3.6e6,
                 hours = std::abs(after_h);
    const std::string text =
        (hours < 72 ? fmt::format("{:.3g} h", hours) : fmt::format("{:.0f} days", hours / 24)) +
        (after_h < 0 ? " before the " : " after the ") + wanted;
    parts.push_back(hours == 0 ? "at the " + wanted : text);
    if (hours > kFarInTime_h) far.push_back(text);
  } else {
    parts.push_back("the last one, as there is no epoch");
  }
  if (sounding.position) {
    const GeodeticPosition& at = *sounding.position;
    const double km = geodesicInverse(at.latitude_deg, at.longitude_deg, context.origin.latitude_deg,
                                      context.origin.longitude_deg)
                          .distance_m /
                      1000;
    parts.push_back(fmt::format("{:.0f} km from the region's origin", km));
    if (km > kFar_km) far.push_back(parts.back());
  } else {
    parts.push_back("its place is not in the file");
  }
  if (!far.empty()) {
    context.problems.addWarning(
        section.locationOf("file"),
        fmt::format("the sounding in use, of {} at {}, is {}: the air there and then may be another; give a "
                    "nearer file, or the 'time' of one of its soundings",
                    sounding.station, sounding.time_utc, fmt::join(far, " and ")));
  }
  return fmt::format("{}; {}", file.description, fmt::join(parts, ", "));
}

/// Height of a platform above sea level, if it is known without the terrain; empty if unknown.
std::optional<double> highest_msl_m(const Platform& platform, bool has_terrain) {
  std::optional<double> highest_m;
  for (const TrackPoint& point : platform.track) {
    const SitePosition& position = point.position;
    const std::optional<double> height_m = position.height_msl_m ? position.height_msl_m
                                           : has_terrain         ? std::nullopt
                                                                 : position.height_agl_m;
    if (height_m) highest_m = std::max(highest_m.value_or(*height_m), *height_m);
  }
  return highest_m;
}

/// @param measured  the profiles of the file
void warnOfMeasuredHeights(const RefractivityField& measured, const Scenario& scenario,
                           const Section& section, ParseContext& context) {
  double first_m = -HUGE_VAL, last_m = HUGE_VAL;
  for (const RefractivityProfile& profile : measured.profiles) {
    first_m = std::max(first_m, profile.levels.front().height_msl_m);
    last_m = std::min(last_m, profile.levels.back().height_msl_m);
  }
  if (first_m > kFarAboveSea_m && scenario.ground.kind == GroundKind::sea) {
    context.problems.addWarning(
        section.locationOf("file"),
        fmt::format("the first level is {:.0f} m above the sea: below it the gradient of the first layer is "
                    "continued",
                    first_m));
  }
  for (const Emitter& emitter : scenario.emitters) {
    const std::optional<double> height_m = highest_msl_m(
        scenario.platforms[static_cast<std::size_t>(emitter.platform)], scenario.terrain.has_value());
    if (!height_m || *height_m <= last_m) continue;
    context.problems.addWarning(
        section.locationOf("file"),
        fmt::format("the profile ends at {:.0f} m, below '{}' at {:.0f} m: the air above it is standard",
                    last_m, emitter.name, *height_m));
  }
}

}  // namespace

std::shared_ptr<const Refractivity> parseRefractivity(const Section& atmosphere, ParseContext& context) {
  if (!atmosphere.has("refractivity")) return nullptr;
  const Section section = atmosphere.section("refractivity");
  if (atmosphere.has("k_factor")) {
    context.problems.addError(section.location(),
                              "'refractivity' and 'k_factor' exclude each other; kind: linear has a gradient "
                              "of 156.96 M-units per km over k_factor");
  }
  if (!section.sound()) return nullptr;
  Values values(section);
  bool is_sound = true;
  for (const std::string& key : values.spreadKeys()) {
    const Section spread = section.section(key);
    const std::string fault =
        values.faultOf(key, fmt::format("{:.10g}", spread.number("mean")), spread.number("mean"));
    if (fault.empty()) continue;
    context.problems.addError(spread.locationOf("mean"), "the mean of " + fault);
    is_sound = false;
  }
  RefractivityField measured;
  std::string source;
  if (section.has("file")) {
    const auto file = fileOf(section, context);
    if (!file) return nullptr;
    measured = file->field;
    const bool has_time = section.has("time");
    source = section.text("file") + ": " +
             sourceOf(*file, has_time ? "time" : "epoch", has_time ? section.text("time") : context.epoch_utc,
                      section, context);
  }
  if (!is_sound) return nullptr;
  warnOfEnsemble(section, values, context);
  auto refractivity = std::make_shared<Refractivity>();
  refractivity->source = source;
  try {
    values.selectMean();
    refractivity->air = fieldOf(section, values, measured);
    if (section.integer("members") > 1 && !values.spreadKeys().empty()) {
      for (int member = 0; member < section.integer("members"); ++member)
        refractivity->members.push_back(memberOf(section, values, measured, member));
      refractivity->quantile = section.optionalNumber("quantile");
    }
    values.selectMean();
    if (section.choice<RefractivityKind>("kind") == RefractivityKind::bulk &&
        !bulkOf(section, values).duct_height_m) {
      context.problems.addWarning(
          section.locationOf("kind"),
          "the height of the evaporation duct is not defined: M falls up to 100 m, or the air between sensor "
          "and sea would be above saturation; the profile is used as it is");
    }
  } catch (const Error& error) {
    context.problems.addError(section.location(), error.message());
    return nullptr;
  }
  return refractivity;
}

double kFactorOf(const Section& atmosphere, double otherwise) {
  const Section section = atmosphere.section("refractivity");
  if (!section.sound() || section.choice<RefractivityKind>("kind") != RefractivityKind::linear)
    return otherwise;
  const double gradient_m = Values(section)("gradient_m_per_km") / 1000;
  const double k_factor = kFlatteningGradient_m / gradient_m;
  return k_factor >= 0.5 && k_factor <= 10 ? k_factor : otherwise;
}

void warnOfRefractivity(const Scenario& scenario, const Section& root, ParseContext& context) {
  if (!scenario.atmosphere.refractivity) return;
  const Section section = root.section("atmosphere").section("refractivity");
  std::string others, of_k_factor;
  for (const Emitter& emitter : scenario.emitters) {
    const ModelInfo& model = modelInfo(emitter.propagation.model);
    if (std::string(model.name) == "parabolic_equation") continue;
    std::string& names = model.on_effective_earth ? of_k_factor : others;
    names += fmt::format("{}'{}' ({})", names.empty() ? "" : ", ", emitter.name, model.name);
  }
  if (!of_k_factor.empty()) {
    context.problems.addWarning(
        section.location(),
        fmt::format(
            "'refractivity' is for parabolic_equation; the models of {} bend rays by k_factor, {:.4g}",
            of_k_factor, scenario.atmosphere.k_factor));
  }
  if (!others.empty()) {
    context.problems.addWarning(
        section.location(),
        fmt::format("'refractivity' is for parabolic_equation; the models of {} do not read it", others));
  }
  if (section.has("file"))
    warnOfMeasuredHeights(context.files.refractivity.begin()->second->field, scenario, section, context);
}

}  // namespace emscape::scenario
