/// Editor of the scenario's values; makes the same edits as --set.
#include <fmt/format.h>
#include <imgui_internal.h>

#include <algorithm>
#include <array>
#include <map>
#include <unordered_set>

#include "apps/view/panels/panels.h"
#include "apps/view/panels/parameter_rows.h"
#include "apps/view/values/edit_text.h"
#include "apps/view/values/search_text.h"
#include "apps/view/widgets/names.h"
#include "apps/view/widgets/theme.h"
#include "apps/view/widgets/wrapped_text.h"
#include "emscape/base/error.h"
#include "emscape/scenario/file/scenario_file.h"

namespace emscape::view {
namespace {

using scenario::ParameterGroup;

constexpr std::size_t kSearchFrom = 8;  // with more emitters there is a search field

/// A section of the scenario with a collapsible heading.
struct Section {
  std::string name;
  std::string path;
  std::optional<scenario::EmitterKind> kind = {};  ///< of an emitter
  bool is_enabled = true;
  std::optional<scenario::Side> side = {};  ///< of the emitter's platform
};

/// Sections below a heading.
struct SectionGroup {
  const char* name;
  std::vector<const char*> kinds;  ///< of the items that can be added
  std::vector<Section> sections = {};
};

/// State of the panel between frames.
struct PanelState {
  playback::ScenarioPtr scenario;  // source of the following
  std::vector<SectionGroup> section_groups;
  std::map<std::string, ParameterGroup> groups;
  std::set<std::string> edited;
  std::string changes;  // "3 values changed"
  std::size_t disabled_count = 0;
  std::unordered_set<std::string> open;  // paths of sections
  std::string selected;                  // path of the section that is marked
  bool arrives = false;                  // it is scrolled to
  std::string shown;                     // path of the section that is scrolled to
  bool is_new = true;
  std::array<char, 256> searched{};
  RowState rows;
  std::vector<std::string> edit_texts;  // made when they are asked for

  void take(const playback::ScenarioPtr& next) {
    if (next == scenario) return;
    // A stream brings and renames items, too, but these are not the user's.
    const bool is_edited_further =
        scenario && scenario->file == next->file && scenario->edits() != next->edits();
    const std::vector<playback::RenamedItem> renamed =
        is_edited_further ? playback::renamedItems(*scenario, *next) : std::vector<playback::RenamedItem>();
    rename(renamed);
    std::unordered_set<std::string> before;
    for (const SectionGroup& group : section_groups) {
      for (const Section& section : group.sections)
        before.insert(playback::renamedPath(renamed, section.path));
    }
    scenario = next;
    groups.clear();
    edited = playback::editedPaths(next->edits());
    changes = changeCountOf(*next);
    edit_texts.clear();
    SectionGroup emitters{"Emitters", {"radar", "transmitter", "jammer"}};
    disabled_count = 0;
    for (const scenario::Emitter& emitter : next->emitters) {
      emitters.sections.push_back({emitter.name, "emitters." + scenario::pathStep(emitter.name), emitter.kind,
                                   emitter.enabled,
                                   next->platforms[static_cast<std::size_t>(emitter.platform)].side});
      disabled_count += emitter.enabled ? 0 : 1;
    }
    const auto groupOf = [](const char* name, const char* kind, const std::string& list,
                            const auto&... items) {
      SectionGroup group{name, {kind}};
      const auto add = [&](const auto& some) {
        for (const auto& item : some)
          group.sections.push_back({item.name, list + "." + scenario::pathStep(item.name)});
      };
      (add(items), ...);
      return group;
    };
    section_groups = {
        emitters, groupOf("Platforms", "platform", "platforms", next->platforms),
        groupOf("Receivers", "receiver", "receivers", next->receivers, next->placed_receivers),
        groupOf("Targets", "target", "targets", next->targets),
        SectionGroup{
            "Scenario",
            {},
            {{"Air", "atmosphere"}, {"Ground", "ground"}, {"Output", "output"}, {"Region", "region"}}}};
    std::unordered_set<std::string> still_open;
    for (const SectionGroup& group : section_groups) {
      for (const Section& section : group.sections) {
        if (is_edited_further && before.count(section.path) == 0) {
          open.insert(section.path);
          if (shown.empty()) shown = section.path;  // an emitter rather than the platform that came with it
        }
        if (open.count(section.path) > 0) still_open.insert(section.path);
      }
    }
    open = std::move(still_open);
    if (std::exchange(is_new, false) && !emitters.sections.empty())
      open.insert(emitters.sections.front().path);
  }

  /// Sections and rows with another name stay as they are.
  void rename(const std::vector<playback::RenamedItem>& renamed) {
    if (renamed.empty()) return;
    const auto nameOf = [&](const std::string& path) { return playback::renamedPath(renamed, path); };
    std::unordered_set<std::string> open_now;
    for (const std::string& path : open) open_now.insert(nameOf(path));
    open = std::move(open_now);
    selected = nameOf(selected);
    scenarioFocus().rename(nameOf);
  }

  /// Opens the section of what is selected, once.
  void follow(const std::string& path) {
    if (path == selected) return;
    selected = path;
    arrives = !path.empty();
    if (arrives) open.insert(path);
  }

  const ParameterGroup& groupAt(const std::string& path) {
    const auto known = groups.find(path);
    if (known != groups.end()) return known->second;
    return groups.emplace(path, scenario::parametersOf(*scenario, path)).first->second;
  }

  /// The edits in words.
  const std::vector<std::string>& editTexts(const Session& session) {
    if (edit_texts.empty()) edit_texts = view::editTexts(*session.original(), scenario->edits());
    return edit_texts;
  }

  /// True if a value of a section differs from the file.
  bool isEdited(const std::string& path) const {
    const std::string within = path + ".";
    const auto at = edited.lower_bound(within);
    return edited.count(path) > 0 || (at != edited.end() && at->compare(0, within.size(), within) == 0);
  }
};

void drawBody(PanelContext& context, PanelState& state, const Section& section) {
  ParameterRows rows(context, state.edited, scenarioFocus(), state.rows);
  pushNameId(section.path);
  try {
    rows.draw(state.groupAt(section.path));
  } catch (const Error& error) {
    textWrapped(error.message());
  }
  ImGui::PopID();
}

void switchEmitter(PanelContext& context, const Section& section) {
  context.session.perform({"enable", {{"emitter", section.name}, {"on", !section.is_enabled}}});
}

/// The on/off switch of an emitter, over its heading.
void drawSwitch(PanelContext& context, const Section& section, const ImVec2& at) {
  const float s = context.scale;
  const ImVec2 size{26 * s, 14 * s}, before = ImGui::GetCursorScreenPos();
  ImGui::SetCursorScreenPos(at);
  if (ImGui::InvisibleButton("switch", size)) switchEmitter(context, section);
  if (ImGui::IsItemHovered())
    ImGui::SetTooltip(section.is_enabled ? "transmits; click: switch off" : "off; click: switch on");
  const bool on = section.is_enabled;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec4 color = on ? accentColor(context.session.theme()) : mutedColor(context.session.theme());
  const float r = size.y / 2;
  list.AddRectFilled(at, {at.x + size.x, at.y + size.y},
                     ImGui::ColorConvertFloat4ToU32({color.x, color.y, color.z, on ? 0.75F : 0.35F}), r);
  list.AddCircleFilled({on ? at.x + size.x - r : at.x + r, at.y + r}, r - 2 * s,
                       ImGui::GetColorU32(on ? ImGuiCol_Text : ImGuiCol_TextDisabled));
  ImGui::SetCursorScreenPos(before);
}

void drawHeadingMenu(PanelContext& context, const PanelState& state, const Section& section, bool is_item) {
  if (!ImGui::BeginPopup("menu")) return;
  const auto perform = [&](const char* verb) { context.session.perform({verb, {{"path", section.path}}}); };
  if (section.kind && ImGui::MenuItem(section.is_enabled ? "Switch off" : "Switch on"))
    switchEmitter(context, section);
  if (is_item && ImGui::MenuItem("Duplicate")) perform("duplicate");
  if (is_item && ImGui::MenuItem("Delete")) perform("remove");
  if (ImGui::MenuItem("Take back the changes", nullptr, false, state.isEdited(section.path)))
    perform("revert");
  ImGui::EndPopup();
}

/// A collapsible heading; at its end the marks of changes and kind, the switch, and the menu.
void drawHeading(PanelContext& context, PanelState& state, const Section& section, bool is_item) {
  const float s = context.scale;
  const render::Theme theme = context.session.theme();
  RowFocus& focus = scenarioFocus();
  pushNameId(section.path);
  const bool was_open = state.open.count(section.path) > 0;
  bool open = was_open;
  if (focus.isEntered(section.path)) open = !open;
  if (focus.isSpaced(section.path))
    section.kind ? switchEmitter(context, section) : static_cast<void>(open = !open);
  if (focus.steps(section.path) != 0) open = focus.steps(section.path) > 0;
  ImGui::SetNextItemOpen(open);
  const bool is_off = !section.is_enabled;
  if (is_off) ImGui::PushStyleColor(ImGuiCol_Text, mutedColor(theme));
  const float reserved = (section.kind ? 74 : is_item ? 40 : 16) * s;
  headingOfName("section", section.name, ImGuiTreeNodeFlags_AllowItemOverlap, reserved);
  if (is_off) ImGui::PopStyleColor();
  // A heading that is clipped reports that it is closed.
  if (ImGui::IsItemToggledOpen()) {
    open = !was_open;
    focus.startAt(section.path);
    if (is_item && open && section.path != state.selected) {
      state.selected = section.path;  // it is in sight
      context.session.perform({"select", {{"path", section.path}}});
    }
  }
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  const float middle = (low.y + high.y) / 2;
  if (ImGui::IsItemClicked(ImGuiMouseButton_Right)) ImGui::OpenPopup("menu");
  ImDrawList& list = *ImGui::GetWindowDrawList();
  if (section.path == state.selected) {
    if (std::exchange(state.arrives, false)) ImGui::SetScrollHereY(0);
    list.AddRectFilled({low.x, low.y}, {low.x + 3 * s, high.y},
                       ImGui::ColorConvertFloat4ToU32(accentColor(theme)));
  }
  if (focus.has(section.path)) {
    list.AddRect(low, high, ImGui::ColorConvertFloat4ToU32(accentColor(theme)),
                 ImGui::GetStyle().FrameRounding, 0, 1.5F * s);
    if (focus.arrives(section.path)) ImGui::ScrollToItem(ImGuiScrollFlags_KeepVisibleEdgeY);
  }
  if (state.shown == section.path) {
    state.shown.clear();
    ImGui::SetScrollHereY(0);
  }
  float right = high.x - 8 * s;
  if (is_item) {
    const ImVec2 before = ImGui::GetCursorScreenPos();
    ImGui::SetCursorScreenPos({right - 16 * s, low.y + 2 * s});
    if (ImGui::InvisibleButton("more", {18 * s, high.y - low.y - 4 * s})) ImGui::OpenPopup("menu");
    const bool is_hovered = ImGui::IsItemHovered();
    if (is_hovered) ImGui::SetTooltip("duplicate, delete, take back");
    ImGui::SetCursorScreenPos(before);
    const ImU32 ink = ImGui::GetColorU32(is_hovered ? ImGuiCol_Text : ImGuiCol_TextDisabled);
    for (int i = -1; i <= 1; ++i)
      list.AddCircleFilled({right - 8 * s, middle + 4.5F * s * static_cast<float>(i)}, 1.5F * s, ink);
    right -= 22 * s;
  }
  if (section.kind) {
    drawSwitch(context, section, {right - 26 * s, middle - 7 * s});
    right -= 32 * s;
    list.AddCircleFilled({right - 4 * s, middle}, 4.5F * s,
                         ImGui::ColorConvertFloat4ToU32(emitterColor(*section.kind, section.side, theme)));
    right -= 14 * s;
  }
  if (state.isEdited(section.path)) {
    list.AddCircleFilled({low.x + 4 * s, middle}, 3 * s, ImGui::ColorConvertFloat4ToU32(accentColor(theme)));
  }
  drawHeadingMenu(context, state, section, is_item);
  ImGui::PopID();
  if (open) {
    state.open.insert(section.path);
  } else {
    state.open.erase(section.path);
  }
}

/// The name of a group, with a button that adds an item to it.
void drawGroupName(PanelContext& context, const SectionGroup& group) {
  ImGui::PushID(group.name);
  ImGui::PushStyleColor(ImGuiCol_Text, mutedColor(context.session.theme()));
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(group.name);
  ImGui::PopStyleColor();
  const auto add = [&](const char* kind) { context.session.perform({"add", {{"what", kind}}}); };
  if (!group.kinds.empty()) {
    const float width = ImGui::CalcTextSize("+ add").x + 2 * ImGui::GetStyle().FramePadding.x;
    ImGui::SameLine(ImGui::GetContentRegionMax().x - width);
    if (ImGui::SmallButton("+ add"))
      group.kinds.size() == 1 ? add(group.kinds.front()) : ImGui::OpenPopup("add");
    if (ImGui::BeginPopup("add")) {
      for (const char* kind : group.kinds) {
        if (ImGui::MenuItem(kind)) add(kind);
      }
      ImGui::EndPopup();
    }
  }
  ImGui::PopID();
}

/// Draws only visible sections: runs of closed sections are clipped.
/// @return false if the search finds none
bool drawSections(PanelContext& context, PanelState& state, const SectionGroup& group) {
  std::vector<const Section*> shown;
  for (const Section& section : group.sections) {
    if (isFound(state.searched.data(), section.name)) shown.push_back(&section);
  }
  if (shown.empty() && state.searched[0] != '\0') return false;
  drawGroupName(context, group);
  RowFocus& focus = scenarioFocus();
  const bool is_item = !group.kinds.empty();
  const auto isOpen = [&](const Section* section) { return state.open.count(section->path) > 0; };
  for (auto at = shown.begin(); at != shown.end();) {
    if (isOpen(*at)) {
      focus.add((*at)->path);
      drawHeading(context, state, **at, is_item);
      if (isOpen(*at)) drawBody(context, state, **at);
      ++at;
      continue;
    }
    const auto end = std::find_if(at, shown.end(), isOpen);
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(end - at), ImGui::GetFrameHeightWithSpacing());
    for (auto one = at; one != end; ++one) {
      focus.add((*one)->path);
      const auto index = static_cast<int>(one - at);
      if (focus.arrives((*one)->path)) clipper.ForceDisplayRangeByIndices(index, index + 1);
    }
    while (clipper.Step()) {
      for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i)
        drawHeading(context, state, **(at + i), is_item);
    }
    at = end;
  }
  ImGui::Spacing();
  return true;
}

/// The edits, each with a button that takes it back. Only visible ones are drawn.
void drawEdits(PanelContext& context, PanelState& state) {
  if (!ImGui::BeginPopup("edits")) return;
  constexpr std::size_t kMaxCharacters = 60;
  constexpr int kMaxLines = 20;
  const std::vector<scenario::Edit> edits = state.scenario->edits();
  const std::vector<std::string>& texts = state.editTexts(context.session);
  const float line = ImGui::GetTextLineHeightWithSpacing();
  const auto count = static_cast<int>(edits.size());
  const float width =
      ImGui::CalcTextSize("undo this").x + static_cast<float>(kMaxCharacters) * 0.6F * ImGui::GetFontSize();
  if (count > kMaxLines) ImGui::BeginChild("list", {width, line * kMaxLines});
  std::string reverted;
  ImGuiListClipper clipper;
  clipper.Begin(count, line);
  while (clipper.Step()) {
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
      const std::string &path = edits[static_cast<std::size_t>(i)].path,
                        &text = texts[static_cast<std::size_t>(i)];
      pushNameId(path);
      if (ImGui::SmallButton("undo this")) reverted = path;
      ImGui::SameLine();
      const bool is_long = text.size() > kMaxCharacters;
      std::size_t end = kMaxCharacters;
      while (is_long && (text[end] & 0xC0) == 0x80) --end;  // not within a character
      ImGui::TextUnformatted(drawable(is_long ? text.substr(0, end) + " …" : text).c_str());
      tooltipOfLongName(text, is_long);
      ImGui::PopID();
    }
  }
  if (count > kMaxLines) ImGui::EndChild();
  ImGui::Separator();
  if (ImGui::SmallButton("undo all")) {
    ImGui::CloseCurrentPopup();
    context.session.perform({"revert"});
  }
  if (!reverted.empty()) context.session.perform({"revert", {{"path", reverted}}});
  ImGui::EndPopup();
}

/// Undo and redo, and a line on the changes that is always there: the rows below stay where they are.
void drawHead(PanelContext& context, PanelState& state) {
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
  if (state.disabled_count > 0) {
    ImGui::SameLine(0, 2 * spacing);
    ImGui::TextDisabled("%zu emitter%s off", state.disabled_count, state.disabled_count == 1 ? "" : "s");
  }
  const bool has_changes = !state.changes.empty();
  ImGui::BeginDisabled(!has_changes);
  const std::string changes = has_changes ? state.changes + " …" : "nothing changed";
  if (ImGui::SmallButton((changes + "###edits").c_str())) ImGui::OpenPopup("edits");
  ImGui::EndDisabled();
  if (has_changes && ImGui::IsItemHovered()) ImGui::SetTooltip("the changes; undo one or all");
  drawEdits(context, state);
  button("copy as command", R"({"do":"copy_command"})", true, "Ctrl+Shift+C", spacing);
}

}  // namespace

bool scenarioPanelTakes(const KeyChord& chord) {
  return scenarioFocus().takes(chord);
}

bool scenarioPanelTakesTab(const Session& session) {
  const RowFocus& focus = scenarioFocus();
  return focus.isShown() && !isDialogOpen(session.panels) &&
         (focus.hasKeyboard() || !ImGui::GetIO().WantTextInput);
}

void drawScenarioPanel(PanelContext& context) {
  static PanelState state;
  const playback::ScenarioPtr scenario = context.session.scenario();
  ImGui::TextColored(accentColor(context.session.theme()), "What if");
  if (!scenario) {
    ImGui::TextDisabled("volumes: there is no scenario to change");
    return;
  }
  state.take(scenario);
  state.follow(context.session.selected());
  drawHead(context, state);
  RowFocus& focus = scenarioFocus();
  focus.beginFrame(isDialogOpen(context.session.panels));
  const std::size_t emitter_count = state.scenario->emitters.size();
  if (emitter_count > kSearchFrom || state.searched[0] != '\0') {
    ImGui::SetNextItemWidth(-1);
    ImGui::InputTextWithHint("##search", "search emitters and platforms", state.searched.data(),
                             state.searched.size());
  }
  // With other panels above, all share the scroll bar of the side.
  const Panels& panels = context.session.panels;
  const bool scrolls = !panels.colors && !panels.planes && !panels.probe;
  if (scrolls) ImGui::BeginChild("sections");
  // Clicked before the rows, which may take the focus.
  const bool is_clicked =
      ImGui::IsMouseClicked(ImGuiMouseButton_Left) || ImGui::IsMouseClicked(ImGuiMouseButton_Right);
  const bool is_elsewhere = !ImGui::IsWindowHovered(ImGuiHoveredFlags_AllowWhenBlockedByActiveItem |
                                                    ImGuiHoveredFlags_AllowWhenBlockedByPopup) &&
                            !isPopupOpen();
  bool is_found = false;
  for (const SectionGroup& group : state.section_groups) is_found |= drawSections(context, state, group);
  if (!is_found) ImGui::TextDisabled("nothing has such a name");
  focus.endFrame(is_clicked && is_elsewhere);
  if (scrolls) ImGui::EndChild();
}

}  // namespace emscape::view
