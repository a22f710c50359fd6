#include "scenario/file/new_items.h"

#include <fmt/format.h>

#include <algorithm>

#include "document/edit_path.h"
#include "document/text_edit.h"
#include "scenario/file/schema.h"
#include "scenario/file/source.h"
#include "scenario/model/named_items.h"

namespace emscape::scenario {
namespace {

using document::DocumentNode;
using document::DocumentNodePtr;

constexpr double kNewHeight_m = 10;

DocumentNode textNode(const std::string& text) {
  DocumentNode node;
  node.kind = document::NodeKind::scalar;
  node.text = text;
  node.quoted = true;
  return node;
}

std::string quotedText(const std::string& text) {
  return document::flowText(textNode(text), /*json=*/true);
}

/// Names that a list of the scenario has.
std::vector<std::string> namesIn(const Scenario& scenario, const std::string& list) {
  std::vector<std::string> names;
  const auto add = [&names](const auto& items) {
    for (const auto& item : items) names.push_back(item.name);
  };
  if (list == "platforms") add(scenario.platforms);
  if (list == "emitters") add(scenario.emitters);
  if (list == "targets") add(scenario.targets);
  if (list == "receivers") {
    add(scenario.receivers);
    add(scenario.placed_receivers);
  }
  return names;
}

/// The name, or the name with the first number that makes it a new one.
std::string unusedName(const std::string& name, const std::vector<std::string>& used) {
  const auto isUsed = [&](const std::string& candidate) {
    return std::find(used.begin(), used.end(), candidate) != used.end();
  };
  std::string candidate = name;
  for (int n = 2; isUsed(candidate); ++n) candidate = fmt::format("{} {}", name, n);
  return candidate;
}

void requireNewName(const std::string& name, const std::vector<std::string>& used) {
  if (std::find(used.begin(), used.end(), name) != used.end())
    throw Error(ErrorCode::bad_input, fmt::format("there is already one named '{}'", name));
}

/// The keys of a position. It has one height.
std::string positionText(const SitePosition& position) {
  std::string text = fmt::format("latitude_deg: {:.7f}, longitude_deg: {:.7f}", position.latitude_deg,
                                 position.longitude_deg);
  const std::pair<const char*, std::optional<double>> heights[]{
      {"height_agl_m", position.height_agl_m},
      {"height_msl_m", position.height_msl_m},
      {"height_ellipsoid_m", position.height_ellipsoid_m}};
  for (const auto& [key, height_m] : heights) {
    if (height_m) text += fmt::format(", {}: {:.10g}", key, *height_m);
  }
  return text;
}

SitePosition atHeight(const GroundPosition& position, double height_agl_m) {
  return {position.latitude_deg, position.longitude_deg, {}, height_agl_m, {}};
}

/// The position of a drawn point, without a height of its own at that of the platform so far.
SitePosition atHeight(const DrawnPoint& point, const SitePosition& platform) {
  if (point.height_agl_m) return atHeight(point.position, *point.height_agl_m);
  SitePosition position = platform;
  position.latitude_deg = point.position.latitude_deg;
  position.longitude_deg = point.position.longitude_deg;
  return position;
}

/// The keys of a new item after name and platform.
std::string commonKeysOf(const Scenario& scenario, const std::string& kind) {
  if (kind == "transmitter")
    return "kind: transmitter, frequency_hz: 3.0e+8, power_w: 100, antenna: {pattern: isotropic}";
  if (kind == "radar") {
    return "kind: radar, frequency_hz: 3.0e+9, power_w: 2.0e+4, antenna: {pattern: gaussian, "
           "beamwidth_az_deg: 3, beamwidth_el_deg: 10}, scan: {kind: rotate, rate_rpm: 6}, receiver: "
           "{noise_figure_db: 4, bandwidth_hz: 1.0e+6}";
  }
  if (kind == "jammer") {
    const auto radar =
        std::find_if(scenario.emitters.begin(), scenario.emitters.end(),
                     [](const Emitter& emitter) { return emitter.kind == EmitterKind::radar; });
    return fmt::format(
        "kind: jammer, frequency_hz: {:.10g}, bandwidth_hz: 1.0e+7, power_w: 100, antenna: {{pattern: "
        "isotropic}}",
        radar == scenario.emitters.end() ? 3e9 : radar->frequency_hz);
  }
  return kind == "receiver" ? "noise_figure_db: 6, bandwidth_hz: 1.0e+6" : "rcs_m2: 1";
}

/// @throws Error (bad_input) if the path does not lead to an emitter, platform, receiver or target
document::ResolvedPath itemAt(const Scenario& scenario, const std::string& path) {
  if (!scenario.source || !scenario.source->root)
    throw Error(ErrorCode::bad_input, "the scenario was not read from a file: its values cannot be edited");
  document::ResolvedPath found = document::resolvePath(path, scenario.source->root, scenarioSpec());
  if (!found.missing.empty()) throw Error(ErrorCode::bad_input, found.missing);
  const std::string& list = std::get<std::string>(found.steps.front());
  const bool is_item = found.steps.size() == 2 && (list == "emitters" || list == "platforms" ||
                                                   list == "receivers" || list == "targets");
  if (!is_item)
    throw Error(ErrorCode::bad_input,
                fmt::format("{} is not an emitter, platform, receiver or target", found.name));
  return found;
}

Edit newPlatform(const Scenario& scenario, const std::string& name,
                 const std::optional<GroundPosition>& position) {
  const GroundPosition origin{scenario.region.origin.latitude_deg, scenario.region.origin.longitude_deg};
  return {"platforms." + pathStep(name),
          fmt::format("{{name: {}, position: {{{}}}}}", quotedText(name),
                      positionText(atHeight(position.value_or(origin), kNewHeight_m)))};
}

}  // namespace

const std::vector<std::string>& itemKinds() {
  static const std::vector<std::string> kinds{"radar",    "transmitter", "jammer",
                                              "platform", "receiver",    "target"};
  return kinds;
}

std::vector<Edit> editsToAdd(const Scenario& scenario, const NewItem& item) {
  if (std::find(itemKinds().begin(), itemKinds().end(), item.kind) == itemKinds().end()) {
    throw Error(ErrorCode::bad_input,
                fmt::format("'{}' cannot be added: expected {}", item.kind, fmt::join(itemKinds(), ", ")));
  }
  const bool is_emitter = item.kind == "radar" || item.kind == "transmitter" || item.kind == "jammer";
  const std::string list = is_emitter ? "emitters" : item.kind + "s";
  const std::vector<std::string> used = namesIn(scenario, list);
  if (!item.name.empty()) requireNewName(item.name, used);
  const std::string name = item.name.empty() ? unusedName("new " + item.kind, used) : item.name;
  if (item.kind == "platform") return {newPlatform(scenario, name, item.position)};
  std::vector<Edit> edits;
  std::string platform = item.platform;
  if (item.position) {
    if (!platform.empty())
      throw Error(ErrorCode::bad_input, "a new item is on a platform or at a position, not both");
    platform = unusedName(name, namesIn(scenario, "platforms"));
    edits.push_back(newPlatform(scenario, platform, item.position));
  } else if (platform.empty()) {
    platform = scenario.platforms.front().name;
  } else {
    indexOfNamed(scenario.platforms, platform, "platform");
  }
  edits.push_back(
      {list + "." + pathStep(name), fmt::format("{{name: {}, platform: {}, {}}}", quotedText(name),
                                                quotedText(platform), commonKeysOf(scenario, item.kind))});
  return edits;
}

std::vector<Edit> editsWithReferences(const Scenario& scenario, const Edit& edit) {
  std::vector<Edit> edits{edit};
  if (!scenario.source || !scenario.source->root) return edits;
  document::NodePath steps;
  try {
    steps = document::resolvePath(edit.path, scenario.source->root, scenarioSpec()).steps;
  } catch (const Error&) {
    return edits;  // whoever applies it reports the fault
  }
  if (steps.size() != 3 || steps.back() != document::PathStep("name")) return edits;
  const auto& list = std::get<std::string>(steps.front());
  const auto index = std::get<std::size_t>(steps[1]);
  const DocumentNodePtr name = document::valueAt(scenario.source->root, steps);
  if (!name) return edits;
  const auto add = [&](const std::string& of, const auto& items) {
    for (const auto& item : items) {
      if (item.platform == static_cast<int>(index))
        edits.push_back({of + "." + pathStep(item.name) + ".platform", edit.value});
    }
  };
  if (list == "platforms") {
    add("emitters", scenario.emitters);
    add("receivers", scenario.placed_receivers);
    add("targets", scenario.targets);
    for (const Emitter& emitter : scenario.emitters) {
      if (emitter.scan.kind == ScanKind::victim && emitter.scan.victim == static_cast<int>(index))
        edits.push_back({"emitters." + pathStep(emitter.name) + ".scan.victim", edit.value});
    }
  }
  const char* const of_output = list == "emitters" ? "wanted_emitter" : "receiver";
  const DocumentNodePtr named = document::valueAt(scenario.source->root, {"output", of_output});
  if ((list == "emitters" || list == "receivers") && named && named->text == name->text)
    edits.push_back({std::string("output.") + of_output, edit.value});
  return edits;
}

Edit editToRemove(const Scenario& scenario, const std::string& path) {
  const document::ResolvedPath found = itemAt(scenario, path);
  if (std::get<std::string>(found.steps.front()) == "platforms") {
    const int platform = static_cast<int>(std::get<std::size_t>(found.steps.back()));
    std::string carried;
    const auto collect = [&](const auto& items) {
      for (const auto& item : items) {
        if (item.platform == platform) carried += (carried.empty() ? "'" : ", '") + item.name + "'";
      }
    };
    collect(scenario.emitters);
    collect(scenario.placed_receivers);
    collect(scenario.targets);
    for (const Emitter& emitter : scenario.emitters) {
      if (emitter.scan.kind != ScanKind::victim || emitter.scan.victim != platform) continue;
      throw Error(
          ErrorCode::bad_input,
          fmt::format("{} is the victim of '{}': give its scan another one first", found.name, emitter.name));
    }
    if (!carried.empty()) {
      throw Error(ErrorCode::bad_input,
                  fmt::format("{} carries {}: remove these, or give them another platform, first", found.name,
                              carried));
    }
  }
  return {path, "null"};
}

Edit editToDuplicate(const Scenario& scenario, const std::string& path, const std::string& name) {
  const document::ResolvedPath found = itemAt(scenario, path);
  const DocumentNodePtr node = document::valueAt(scenario.source->root, found.steps);
  const auto key = std::find_if(node->entries.begin(), node->entries.end(),
                                [](const document::MapEntry& entry) { return entry.key == "name"; });
  const std::string list = std::get<std::string>(found.steps.front());
  const std::vector<std::string> used = namesIn(scenario, list);
  if (!name.empty()) requireNewName(name, used);
  const std::string new_name = name.empty() ? unusedName(key->value->text, used) : name;
  DocumentNode copy = *node;
  copy.entries[static_cast<std::size_t>(key - node->entries.begin())].value =
      std::make_shared<DocumentNode>(textNode(new_name));
  return {list + "." + pathStep(new_name), document::flowText(copy, /*json=*/false)};
}

std::vector<Edit> editsForTrack(const Scenario& scenario, const std::string& platform,
                                const std::vector<DrawnPoint>& points, double begin_s,
                                std::optional<double> speed_mps) {
  const Platform& moved = scenario.platforms[indexOfNamed(scenario.platforms, platform, "platform")];
  if (points.size() < 2) throw Error(ErrorCode::bad_input, "a track needs at least 2 points");
  std::vector<double> along_m{0};
  for (std::size_t i = 1; i < points.size(); ++i) {
    const GroundPosition &from = points[i - 1].position, &to = points[i].position;
    const double leg_m =
        geodesicInverse(from.latitude_deg, from.longitude_deg, to.latitude_deg, to.longitude_deg).distance_m;
    if (leg_m <= 0)
      throw Error(ErrorCode::bad_input, fmt::format("points {} and {} of the track are the same", i, i + 1));
    along_m.push_back(along_m.back() + leg_m);
  }
  if (speed_mps && !(*speed_mps > 0)) throw Error(ErrorCode::bad_input, "the speed must be above 0 m/s");
  const double left_s = scenario.clock.duration_s - begin_s;
  const double speed = speed_mps ? *speed_mps : along_m.back() / (left_s > 0 ? left_s : 60);
  const SitePosition& first = moved.track.front().position;
  std::string list;
  for (std::size_t i = 0; i < points.size(); ++i) {
    list += fmt::format("{}{{t_s: {:.10g}, {}}}", list.empty() ? "" : ", ", begin_s + along_m[i] / speed,
                        positionText(atHeight(points[i], first)));
  }
  const std::string path = "platforms." + pathStep(platform);
  std::vector<Edit> edits;
  for (const char* key : {".attitude", ".position"}) {  // of a fixed site
    const bool is_given = scenario.source && scenario.source->root &&
                          document::resolvePath(path + key, scenario.source->root, scenarioSpec()).exists;
    if (is_given) edits.push_back({path + key, "null"});
  }
  // The platform was somewhere before, and stays where the line ends.
  edits.push_back({path + ".track", fmt::format("{{points: [{}], outside: hold}}", list)});
  return edits;
}

}  // namespace emscape::scenario
