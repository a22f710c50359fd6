/// Dialogs of the map: go to a position; places, a picture and range rings on the ground.
#include <fmt/format.h>

#include <algorithm>

#include "apps/view/panels/panels.h"
#include "apps/view/widgets/dialog.h"
#include "apps/view/widgets/names.h"
#include "apps/view/widgets/refusal.h"
#include "base/text/display_units.h"

namespace emscape::view {
namespace {

constexpr float kFieldWidth = 360;

/// The button after a field that fills it from the file browser.
void browseButton(Session& session, FileBrowser::Purpose purpose) {
  ImGui::SameLine();
  if (ImGui::Button("Browse")) session.browse(purpose);
  tabStop();
}

/// Texts, each with a button. @return the index of the one to be removed; its size: none
std::size_t listToRemove(const std::vector<std::string>& texts) {
  std::size_t removed = texts.size();
  for (std::size_t i = 0; i < texts.size(); ++i) {
    ImGui::PushID(static_cast<int>(i));
    if (ImGui::SmallButton("remove")) removed = i;
    tabStop();
    ImGui::SameLine();
    ImGui::TextUnformatted(drawable(texts[i]).c_str());
    ImGui::PopID();
  }
  return removed;
}

void drawDrape(PanelContext& context) {
  static FieldText typed{};
  Session& session = context.session;
  ImGui::PushID("drape");
  ImGui::TextDisabled("Picture on the ground (GeoTIFF, MBTiles)");
  if (!session.view().drape.empty() && listToRemove({session.view().drape}) == 0)
    session.perform({"drape", {{"file", ""}}});
  if (ImGui::IsWindowAppearing()) {
    typed.fill('\0');
    ImGui::SetKeyboardFocusHere();
  }
  ImGui::SetNextItemWidth(kFieldWidth * context.scale);
  actionField(context, "##file", "file", typed, "Show", [&session](const std::string& file) {
    return file.empty() || session.perform({"drape", {{"file", file}}});
  });
  browseButton(session, FileBrowser::Purpose::drape);
  ImGui::PopID();
}

void drawPlaces(PanelContext& context) {
  static FieldText typed{};
  Session& session = context.session;
  ImGui::PushID("places");
  ImGui::TextDisabled("Places (GeoJSON, GeoPackage, ...)");
  std::vector<std::string> files = session.view().places;
  const std::size_t removed = listToRemove(files);
  if (removed < files.size()) {
    files.erase(files.begin() + static_cast<std::ptrdiff_t>(removed));
    session.perform({"places", {{"files", files}}});
  }
  if (ImGui::IsWindowAppearing()) typed.fill('\0');
  ImGui::SetNextItemWidth(kFieldWidth * context.scale);
  actionField(context, "##file", "file", typed, "Add", [&session](const std::string& file) {
    const bool is_taken = file.empty() || addPlaces(session, file);
    if (is_taken) typed.fill('\0');
    return is_taken;
  });
  browseButton(session, FileBrowser::Purpose::places);
  ImGui::PopID();
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
  const auto& emitters = scenario->emitters;
  const auto has_name = [](const scenario::Emitter& each) { return each.name == emitter; };
  if (std::none_of(emitters.begin(), emitters.end(), has_name)) emitter = emitters.front().name;
  ImGui::SetNextItemWidth(0.5F * kFieldWidth * context.scale);
  if (beginComboOfName("##emitter", emitter)) {
    for (const scenario::Emitter& each : emitters) {
      pushNameId(each.name);
      if (selectableName(each.name, each.name == emitter)) emitter = each.name;
      ImGui::PopID();
    }
    ImGui::EndCombo();
  } else {
    tabStop();
  }
  ImGui::SameLine();
  ImGui::SetNextItemWidth(0.3F * kFieldWidth * context.scale);
  const NumberForm form{"every ", "m", "", -1, unit.name, unit.factor, {}, 1, 1e7};
  numberField(context, "##spacing", spacing_m, form);
  tabStop();
  ImGui::SameLine();
  const bool is_refused = isRefused(ImGui::GetID("##spacing"));  // it would act with the value before
  ImGui::BeginDisabled(is_refused);
  const bool is_added = ImGui::Button("Add") && !is_refused;
  tabStop();
  ImGui::EndDisabled();
  if (is_added) {
    texts.push_back(toString(playback::RangeRings{emitter, spacing_m, 0}));
    session.perform({"range_rings", {{"rings", texts}}});
  }
}

}  // namespace

bool addPlaces(Session& session, const std::string& file) {
  std::vector<std::string> files = session.view().places;
  if (std::find(files.begin(), files.end(), file) != files.end()) {
    session.tell(file + " is shown already", true);
    return false;
  }
  files.push_back(file);
  return session.perform({"places", {{"files", files}}});
}

void drawGoToPosition(PanelContext& context) {
  Session& session = context.session;
  if (!beginDialog(context, "Go to position", session.panels.position)) return;
  static FieldText typed{};
  if (ImGui::IsWindowAppearing()) {
    typed.fill('\0');
    ImGui::SetKeyboardFocusHere();
  }
  ImGui::SetNextItemWidth(kFieldWidth * context.scale);
  actionField(context, "##position", "36.3N 84.2W, 36°30'12\"N 84°12'W, 16S GF 12345 67890", typed, "Go",
              [&session](const std::string& position) {
                const bool is_taken = session.perform({"goto_position", {{"position", position}}});
                session.panels.position = !is_taken;
                return is_taken;
              });
  endDialog();
}

void drawMapDialog(PanelContext& context) {
  Session& session = context.session;
  if (!beginDialog(context, "Map", session.panels.map)) return;
  drawDrape(context);
  ImGui::Spacing();
  drawPlaces(context);
  ImGui::Spacing();
  drawRings(context);
  endDialog();
}

}  // namespace emscape::view
