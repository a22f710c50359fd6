#include "apps/view/values/shown_quantity.h"

#include <fmt/format.h>

#include <algorithm>

#include "emscape/base/error.h"
#include "emscape/emfield/solver/field_solver.h"
#include "emscape/render/annotate/legend.h"
#include "emscape/scenario/model/quantities.h"
#include "scenario/file/quantity_needs.h"

namespace emscape::view {
namespace {

/// The names of the channels of a quantity. @throws Error if the scenario does not have it
std::vector<std::string> channelsOf(const scenario::Scenario& scenario, const std::string& quantity) {
  const scenario::Quantity of = scenario::quantityFromName(quantity);
  std::string unmet = scenario::unmetNeed(of, scenario, scenario.output);
  if (unmet.empty()) unmet = scenario::unmetInterval(of, scenario.output.interval.kind);
  if (!unmet.empty()) throw Error(ErrorCode::bad_input, unmet);
  std::vector<std::string> names;
  for (const emfield::Channel& channel : emfield::channelsOf(scenario, {quantity})) {
    names.push_back(channel.name);
  }
  return names;
}

}  // namespace

std::string missingQuantity(const scenario::Scenario& scenario, const std::string& name) {
  if (name.empty()) return "";
  try {
    const std::vector<std::string> channels = channelsOf(scenario, name.substr(0, name.find(':')));
    const bool is_channel = name.find(':') != std::string::npos;
    if (!is_channel || std::find(channels.begin(), channels.end(), name) != channels.end()) return "";
    return fmt::format("quantity '{}': there is no such channel; there are {}", name,
                       fmt::join(channels, ", "));
  } catch (const Error& error) {
    return error.message();
  }
}

ShownQuantity titled(const std::string& name) {
  std::string unit;
  const std::string quantity = name.substr(0, name.find(':'));
  for (const scenario::QuantityInfo& info : scenario::quantityTable()) {
    if (info.name == quantity) unit = info.unit;
  }
  const std::string title = render::quantityTitle(name, unit);
  return {name, unit.empty() ? title : title + ", " + render::unitText(unit)};
}

std::vector<std::string> quantitiesOf(const scenario::Scenario& scenario) {
  const bool has_jammer = std::any_of(
      scenario.emitters.begin(), scenario.emitters.end(),
      [](const scenario::Emitter& emitter) { return emitter.kind == scenario::EmitterKind::jammer; });
  std::vector<std::string> quantities = scenario.output.quantities;
  for (const scenario::QuantityInfo& info : scenario::quantityTable()) {
    const bool is_allowed =
        hasInterval(info, scenario.output.interval.kind) && (has_jammer || !info.needs_jammer);
    const bool is_known = std::find(quantities.begin(), quantities.end(), info.name) != quantities.end();
    if (is_allowed && !is_known) quantities.emplace_back(info.name);
  }
  std::vector<std::string> names;
  for (const std::string& quantity : quantities) {
    if (!missingQuantity(scenario, quantity).empty()) continue;
    for (const std::string& name : channelsOf(scenario, quantity)) names.push_back(name);
  }
  return names;
}

}  // namespace emscape::view
