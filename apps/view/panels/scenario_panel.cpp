/// Editor of the scenario's values; makes the same edits as --set.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <unordered_set>

#include "apps/view/panels/names.h"
#include "apps/view/panels/panels.h"
#include "apps/view/panels/parameter_rows.h"
#include "apps/view/panels/theme.h"
#include "apps/view/parts/shown_quantity.h"
#include "emscape/base/error.h"

namespace emscape::view {
namespace {

using scenario::ParameterGroup;

constexpr std::size_t kSearchFrom = 8;  // with more emitters there is a search field

/// A section of the scenario with a collapsible heading.
struct Section {
  std::string name;
  std::string path;
  std::optional<scenario::EmitterKind> kind;  ///< of an emitter
};

/// State of the panel between frames.
struct PanelState {
  playback::ScenarioPtr scenario;  // source of the following
  std::vector<Section> emitters, platforms, others;
  std::map<std::string, ParameterGroup> groups;
  std::set<std::string> edited;
  std::unordered_set<std::string> open;  // paths of sections
  bool is_new = true;
  ImGuiTextFilter filter;
  Typing typing;

  void take(const playback::ScenarioPtr& next) {
    if (next == scenario) return;
    scenario = next;
    groups.clear();
    edited.clear();
    for (const scenario::Edit& edit : next->edits()) edited.insert(edit.path);
    emitters.clear();
    platforms.clear();
    others.clear();
    for (const scenario::Emitter& emitter : next->emitters) {
      emitters.push_back({emitter.name, "emitters." + scenario::pathStep(emitter.name), emitter.kind});
    }
    for (const scenario::Platform& platform : next->platforms) {
      platforms.push_back({platform.name, "platforms." + scenario::pathStep(platform.name), {}});
    }
    for (const scenario::ReceiverProfile& receiver : next->receivers) {
      others.push_back({receiver.name, "receivers." + scenario::pathStep(receiver.name), {}});
    }
    for (const scenario::PlacedReceiver& receiver : next->placed_receivers) {
      others.push_back({receiver.name, "receivers." + scenario::pathStep(receiver.name), {}});
    }
    for (const scenario::Target& target : next->targets) {
      others.push_back({target.name, "targets." + scenario::pathStep(target.name), {}});
    }
    others.push_back({"Air", "atmosphere", {}});
    others.push_back({"Ground", "ground", {}});
    others.push_back({"Output", "output", {}});
    others.push_back({"Region", "region", {}});
    if (std::exchange(is_new, false) && !emitters.empty()) open.insert(emitters.front().path);
  }

  const ParameterGroup& groupAt(const std::string& path) {
    const auto known = groups.find(path);
    if (known != groups.end()) return known->second;
    return groups.emplace(path, scenario::parametersOf(*scenario, path)).first->second;
  }
};

bool transmitsAtAll(const scenario::Emitter& emitter, double duration_s) {
  return emitter.active_s.empty() ||
         std::any_of(emitter.active_s.begin(), emitter.active_s.end(),
                     [&](const scenario::TimeInterval& interval) { return interval.begin_s <= duration_s; });
}

/// Switches the emitter on or off; off sets an active interval after the last step.
void drawSwitch(PanelContext& context, ParameterRows& rows, const PanelState& state, const Section& section) {
  const std::vector<scenario::Emitter>& emitters = state.scenario->emitters;
  const auto emitter = std::find_if(emitters.begin(), emitters.end(),
                                    [&](const scenario::Emitter& one) { return one.name == section.name; });
  if (emitter == emitters.end() || !rows.begin("switch")) return;
  const scenario::Clock& clock = state.scenario->clock;
  const std::string path = section.path + ".active_s";
  bool on = transmitsAtAll(*emitter, clock.duration_s);
  rows.label("transmits", "--set '" + path + "=…'", state.edited.count(path) > 0);
  ImGui::TableNextColumn();
  if (ImGui::Checkbox("##transmits", &on)) {
    const double never_s = clock.duration_s + clock.step_s + 1;
    context.session.perform(
        {"set",
         {{"path", path},
          {"value", on ? std::string("null") : fmt::format("[[{:g}, {:g}]]", never_s, never_s + 1)}}});
  }
  ParameterRows::end();
}

void drawQuantity(PanelContext& context, ParameterRows& rows, const scenario::Scenario& scenario) {
  if (!rows.begin("quantity")) return;
  rows.label("shown", "The quantity in the picture\n--quantity NAME", false);
  ImGui::TableNextColumn();
  ImGui::SetNextItemWidth(-1);
  const std::string& chosen = context.session.view().quantity;
  const std::string shown = chosen.empty() ? scenario.output.quantities.front() : chosen;
  if (beginComboOfName("##quantity", shown)) {
    for (const std::string& name : quantitiesOf(scenario)) {
      pushNameId(name);
      if (selectableName(name, name == shown)) context.session.perform({"quantity", {{"name", name}}});
      ImGui::PopID();
    }
    ImGui::EndCombo();
  }
  ParameterRows::end();
}

void drawBody(PanelContext& context, PanelState& state, const Section& section) {
  ParameterRows rows(context, state.edited, state.typing);
  pushNameId(section.path);
  try {
    if (section.kind) drawSwitch(context, rows, state, section);
    if (section.path == "output") drawQuantity(context, rows, *state.scenario);
    rows.draw(state.groupAt(section.path));
  } catch (const Error& error) {
    ImGui::TextWrapped("%s", drawable(error.message()).c_str());
  }
  ImGui::PopID();
}

/// A collapsible heading, with a dot in the kind's colour.
void drawHeading(PanelState& state, const Section& section, render::Theme theme, float scale) {
  pushNameId(section.path);
  ImGui::SetNextItemOpen(state.open.count(section.path) > 0);
  const bool open = headingOfName("section", section.name);
  if (section.kind) {
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    ImGui::GetWindowDrawList()->AddCircleFilled(
        {high.x - 14 * scale, (low.y + high.y) / 2}, 4.5F * scale,
        ImGui::ColorConvertFloat4ToU32(emitterColor(*section.kind, theme)));
  }
  ImGui::PopID();
  if (open) {
    state.open.insert(section.path);
  } else {
    state.open.erase(section.path);
  }
}

/// Draws only visible sections: runs of closed sections are clipped.
void drawSections(PanelContext& context, PanelState& state, const std::vector<Section>& sections) {
  const render::Theme theme = context.session.theme();
  std::vector<const Section*> shown;
  for (const Section& section : sections) {
    if (state.filter.PassFilter(section.name.c_str())) shown.push_back(&section);
  }
  const auto isOpen = [&](const Section* section) { return state.open.count(section->path) > 0; };
  for (auto at = shown.begin(); at != shown.end();) {
    if (isOpen(*at)) {
      drawHeading(state, **at, theme, context.scale);
      if (isOpen(*at)) drawBody(context, state, **at);
      ++at;
      continue;
    }
    const auto end = std::find_if(at, shown.end(), isOpen);
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(end - at), ImGui::GetFrameHeightWithSpacing());
    while (clipper.Step()) {
      for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
        drawHeading(state, **(at + i), theme, context.scale);
      }
    }
    at = end;
  }
  if (!shown.empty()) ImGui::Spacing();
}

void drawHead(PanelContext& context, const PanelState& state) {
  const Session& session = context.session;
  const auto button = [&](const char* name, const char* command, bool enabled, const char* tip,
                          float spacing) {
    sameLineIfRoom(ImGui::CalcTextSize(name).x + 2 * ImGui::GetStyle().FramePadding.x, spacing);
    ImGui::BeginDisabled(!enabled);
    if (ImGui::SmallButton(name)) perform(context, command);
    ImGui::EndDisabled();
    if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) ImGui::SetTooltip("%s", tip);
  };
  const float spacing = ImGui::GetStyle().ItemSpacing.x;
  button("undo", R"({"do":"undo"})", session.canUndo(), "Ctrl+Z", 2 * spacing);
  button("redo", R"({"do":"redo"})", session.canRedo(), "Ctrl+Shift+Z", spacing);
  button("copy as command", R"({"do":"copy_command"})", true, "Ctrl+Shift+C", spacing);
  if (!state.edited.empty()) {
    ImGui::TextDisabled("%zu value%s changed", state.edited.size(), state.edited.size() == 1 ? "" : "s");
  }
}

}  // namespace

void drawScenarioPanel(PanelContext& context) {
  static PanelState state;
  const playback::ScenarioPtr scenario = context.session.scenario();
  ImGui::TextColored(accentColor(context.session.theme()), "What if");
  if (!scenario) {
    ImGui::TextDisabled("volumes: there is no scenario to change");
    return;
  }
  state.take(scenario);
  drawHead(context, state);
  if (state.emitters.size() > kSearchFrom || state.filter.IsActive()) {
    ImGui::SetNextItemWidth(-1);
    if (ImGui::InputTextWithHint("##search", "search emitters and platforms", state.filter.InputBuf,
                                 IM_ARRAYSIZE(state.filter.InputBuf))) {
      state.filter.Build();
    }
  }
  ImGui::Spacing();
  ImGui::BeginChild("sections");
  drawSections(context, state, state.emitters);
  drawSections(context, state, state.platforms);
  drawSections(context, state, state.others);
  ImGui::EndChild();
}

}  // namespace emscape::view
