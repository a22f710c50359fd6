/// Dialogs of the map: go to a position; places, a picture and range rings on the ground.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "apps/view/panels/panels.h"
#include "apps/view/widgets/dialog.h"
#include "apps/view/widgets/names.h"
#include "base/text/display_units.h"

namespace emscape::view {
namespace {

constexpr float kFieldWidth = 360;

/// Text of a field.
using TypedMapText = std::array<char, 4096>;

/// A text field with a button. @return true if Enter or the button took the text
/// @param browses  purpose of a button that opens the file browser; none: there is no such button
bool textAndButton(PanelContext& context, const char* id, const char* hint, TypedMapText& typed,
                   const char* button, std::optional<FileBrowser::Purpose> browses = std::nullopt) {
  ImGui::PushID(id);
  ImGui::SetNextItemWidth(kFieldWidth * context.scale);
  const bool entered =
      ImGui::InputTextWithHint("##text", hint, typed.data(), typed.size(),
                               ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
  ImGui::SameLine();
  const bool pressed = ImGui::Button(button, {64 * context.scale, 0});
  if (browses) {
    ImGui::SameLine();
    if (ImGui::Button("Browse")) context.session.browse(*browses);
  }
  ImGui::PopID();
  return entered || pressed;
}

/// Texts, each with a button. @return the index of the one to be removed; its size: none
std::size_t listToRemove(const std::vector<std::string>& texts) {
  std::size_t removed = texts.size();
  for (std::size_t i = 0; i < texts.size(); ++i) {
    ImGui::PushID(static_cast<int>(i));
    if (ImGui::SmallButton("remove")) removed = i;
    ImGui::SameLine();
    ImGui::TextUnformatted(drawable(texts[i]).c_str());
    ImGui::PopID();
  }
  return removed;
}

void drawDrape(PanelContext& context) {
  static TypedMapText typed{};
  Session& session = context.session;
  ImGui::TextDisabled("Picture on the ground (GeoTIFF, MBTiles)");
  if (!session.view().drape.empty() && listToRemove({session.view().drape}) == 0)
    session.perform({"drape", {{"file", ""}}});
  if (textAndButton(context, "drape", "file", typed, "Show", FileBrowser::Purpose::drape) && typed[0] != '\0')
    session.perform({"drape", {{"file", typed.data()}}});
}

void drawPlaces(PanelContext& context) {
  static TypedMapText typed{};
  Session& session = context.session;
  ImGui::TextDisabled("Places (GeoJSON, GeoPackage, ...)");
  std::vector<std::string> files = session.view().places;
  const std::size_t removed = listToRemove(files);
  if (removed < files.size()) {
    files.erase(files.begin() + static_cast<std::ptrdiff_t>(removed));
    session.perform({"places", {{"files", files}}});
  }
  if (textAndButton(context, "places", "file", typed, "Add", FileBrowser::Purpose::places) &&
      typed[0] != '\0') {
    addPlaces(session, typed.data());
    typed.fill('\0');
  }
}

void drawRings(PanelContext& context) {
  static double spacing_m = 10e3;
  static std::string emitter;
  Session& session = context.session;
  const playback::ScenarioPtr scenario = session.scenario();
  if (!scenario || scenario->emitters.empty()) return;
  ImGui::TextDisabled("Range rings");
  std::vector<std::string> texts, words;
  for (const playback::RangeRings& rings : session.view().range_rings) {
    texts.push_back(toString(rings));
    words.push_back(rings.emitter + ", every " + roundDistanceText(rings.spacing_m, session.view().units) +
                    (rings.count > 0 ? fmt::format(", {} rings", rings.count) : ""));
  }
  const std::size_t removed = listToRemove(words);
  if (removed < texts.size()) {
    texts.erase(texts.begin() + static_cast<std::ptrdiff_t>(removed));
    session.perform({"range_rings", {{"rings", texts}}});
  }
  const DisplayUnit unit = distanceUnit(session.view().units);
  if (emitter.empty()) emitter = scenario->emitters.front().name;
  ImGui::SetNextItemWidth(0.5F * kFieldWidth * context.scale);
  if (beginComboOfName("##emitter", emitter)) {
    for (const scenario::Emitter& each : scenario->emitters) {
      pushNameId(each.name);
      if (selectableName(each.name, each.name == emitter)) emitter = each.name;
      ImGui::PopID();
    }
    ImGui::EndCombo();
  }
  ImGui::SameLine();
  ImGui::SetNextItemWidth(0.3F * kFieldWidth * context.scale);
  const NumberForm form{"every ", "m", "", -1, unit.name, unit.factor, {}, 1, 1e7};
  numberField(context, "##spacing", spacing_m, form);
  ImGui::SameLine();
  if (ImGui::Button("Add")) {
    texts.push_back(toString(playback::RangeRings{emitter, spacing_m, 0}));
    session.perform({"range_rings", {{"rings", texts}}});
  }
}

}  // namespace

void addPlaces(Session& session, const std::string& file) {
  std::vector<std::string> files = session.view().places;
  if (std::find(files.begin(), files.end(), file) != files.end())
    return session.tell(file + " is shown already", true);
  files.push_back(file);
  session.perform({"places", {{"files", files}}});
}

void drawGoToPosition(PanelContext& context) {
  Session& session = context.session;
  if (!beginDialog(context, "Go to position", session.panels.position, {}, Waits::no)) return;
  static TypedMapText typed{};
  if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
  if (textAndButton(context, "position", "36.3N 84.2W, 36°30'12\"N 84°12'W, 16S GF 12345 67890", typed, "Go"))
    session.panels.position = !session.perform({"goto_position", {{"position", typed.data()}}});
  endDialog();
}

void drawMapDialog(PanelContext& context) {
  Session& session = context.session;
  if (!beginDialog(context, "Map", session.panels.map, {}, Waits::no)) return;
  drawDrape(context);
  ImGui::Spacing();
  drawPlaces(context);
  ImGui::Spacing();
  drawRings(context);
  endDialog();
}

}  // namespace emscape::view
