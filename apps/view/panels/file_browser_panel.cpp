/// The file browser.
#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <filesystem>

#include "apps/view/panels/panels.h"
#include "apps/view/widgets/dialog.h"
#include "apps/view/widgets/names.h"
#include "apps/view/widgets/theme.h"

namespace emscape::view {
namespace {

const char* nameOf(FileKind kind) {
  switch (kind) {
    case FileKind::folder:
      return "folder";
    case FileKind::scenario:
      return "scenario";
    case FileKind::volume:
      return "volume";
    case FileKind::view:
      return "view";
    case FileKind::colors:
      return "colours";
    case FileKind::image:
      return "picture";
    case FileKind::places:
    case FileKind::places_or_tracks:
      return "places";
    case FileKind::recording:
      return "recording";
    case FileKind::other:
      break;
  }
  return "";
}

using Purpose = FileBrowser::Purpose;

struct PurposeText {
  const char* title;
  const char* button;
};

PurposeText textOf(Purpose purpose) {
  switch (purpose) {
    case Purpose::view:
      return {"Load a view###open", "Open"};
    case Purpose::scenario:
      return {"Add the scenario###open", "Add"};
    case Purpose::save_scenario:
      return {"Save the scenario as###open", "Save"};
    case Purpose::colors:
      return {"Load colours###open", "Load"};
    case Purpose::save_colors:
      return {"Save colours as###open", "Save"};
    case Purpose::drape:
      return {"Picture on the ground###open", "Show"};
    case Purpose::places:
      return {"Add places###open", "Add"};
    case Purpose::record:
      return {"Record into###open", "Choose"};
    case Purpose::input:
      break;
  }
  return {"Open###open", "Open"};
}

/// A typed name without an ending gets one.
std::string withEnding(const std::string& file, const std::string& ending) {
  return std::filesystem::path(file).has_extension() ? file : file + ending;
}

void openFile(Session& session, const std::optional<std::string>& file) {
  if (!file) return;
  const auto performAndClose = [&](const Command& command) {
    session.panels.open = false;
    session.perform(command);
  };
  switch (session.files().browser.purpose()) {
    case Purpose::input:
      session.perform({"open", {{"file", *file}}});
      break;
    case Purpose::view:
      session.perform({"load_state", {{"file", *file}}});
      break;
    case Purpose::scenario:
      session.perform({"add_scenario", {{"file", *file}}});
      break;
    case Purpose::colors:
      performAndClose({"transfer", {{"file", *file}}});
      break;
    case Purpose::drape:
      performAndClose({"drape", {{"file", *file}}});
      break;
    case Purpose::places:
      session.panels.open = false;
      addPlaces(session, *file);
      break;
    case Purpose::save_scenario: {
      const std::string ending = std::filesystem::path(session.usualScenarioFile()).extension().string();
      session.perform({"save", {{"file", withEnding(*file, ending)}}});
      break;
    }
    case Purpose::save_colors:
      performAndClose({"save_transfer", {{"file", withEnding(*file, ".transfer.json")}}});
      break;
    case Purpose::record:
      session.files().record_output = *file;
      session.panels.open = false;
  }
}

/// Text of the path field.
using TypedPath = std::array<char, 4096>;

/// Opens the typed path, or the selected entry if nothing is typed.
void openChosen(Session& session, TypedPath& typed) {
  FileBrowser& browser = session.files().browser;
  const std::string path = typed.data();
  const std::optional<std::string> file = path.empty() ? browser.choose() : browser.choose(path);
  // A name to save under stays for the case that the user does not want to replace the file.
  if (!browser.savesFile() && browser.refused().empty()) typed.fill('\0');
  openFile(session, file);
}

/// Up, Down and page keys move the selection; while nothing is typed so do Home and End, Right opens it, and
/// Left and Backspace go up.
void handleKeys(Session& session, bool is_typed) {
  FileBrowser& browser = session.files().browser;
  constexpr int kPage = 12;
  if (isKeyPressed(ImGuiKey_UpArrow, true)) browser.moveSelection(-1);
  if (isKeyPressed(ImGuiKey_DownArrow, true)) browser.moveSelection(1);
  if (isKeyPressed(ImGuiKey_PageUp, true)) browser.moveSelection(-kPage);
  if (isKeyPressed(ImGuiKey_PageDown, true)) browser.moveSelection(kPage);
  if (is_typed) return;
  if (isKeyPressed(ImGuiKey_Home)) browser.select(0);
  if (isKeyPressed(ImGuiKey_End)) browser.select(static_cast<int>(browser.entries().size()));
  if (isKeyPressed(ImGuiKey_RightArrow)) {
    openFile(session, browser.choose());
  } else if (isKeyPressed(ImGuiKey_LeftArrow) || isKeyPressed(ImGuiKey_Backspace)) {
    browser.goUp();
  }
}

void drawEntries(PanelContext& context, TypedPath& typed) {
  Session& session = context.session;
  FileBrowser& browser = session.files().browser;
  static int scrolled_to = -1;
  const std::vector<FolderEntry> entries = browser.entries();
  for (int i = 0; i < static_cast<int>(entries.size()); ++i) {
    const FolderEntry& entry = entries[static_cast<std::size_t>(i)];
    ImGui::PushID(i);
    const bool is_folder = entry.kind == FileKind::folder;
    const std::string name = is_folder ? entry.name + "/" : entry.name;
    if (is_folder) ImGui::PushStyleColor(ImGuiCol_Text, accentColor(session.theme()));
    if (selectableName(name, i == browser.selected(), ImGuiSelectableFlags_AllowDoubleClick)) {
      browser.select(i);
      scrolled_to = i;
      const bool is_entered = ImGui::IsMouseDoubleClicked(0) && (is_folder || !browser.savesFile());
      if (is_entered) openFile(session, browser.choose());
      if (!is_folder && browser.savesFile())
        std::snprintf(typed.data(), typed.size(), "%s", entry.name.c_str());
    }
    if (is_folder) ImGui::PopStyleColor();
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - 80 * context.scale);
    ImGui::TextDisabled("%s", nameOf(entry.kind));
    if (i == browser.selected() && scrolled_to != i) {
      ImGui::SetScrollHereY();
      scrolled_to = i;
    }
    ImGui::PopID();
  }
  if (!browser.error().empty()) {
    ImGui::TextColored(errorColor(session.theme()), "%s", drawable(browser.error()).c_str());
  } else if (entries.empty()) {
    ImGui::TextDisabled(browser.reading() ? "reading ..." : "nothing here that can be opened");
  }
}

void drawPathBar(PanelContext& context) {
  FileBrowser& browser = context.session.files().browser;
  if (ImGui::Button("Up")) browser.goUp();
  tabStop();
  ImGui::SameLine();
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(drawable(browser.folder()).c_str());
}

bool isPathRefused(const PanelContext& context, const TypedPath& typed) {
  const std::string& refused = context.session.files().browser.refused();
  return !refused.empty() && refused == typed.data();
}

/// Draws the path field and its button. The field has the focus while no button of the dialog has it.
void drawTypedPath(PanelContext& context, TypedPath& typed) {
  const bool has_focus = ImGui::IsWindowFocused(ImGuiFocusedFlags_RootAndChildWindows) && !isButtonFocused();
  if (has_focus && !ImGui::IsAnyItemActive()) ImGui::SetKeyboardFocusHere();
  ImGui::SetNextItemWidth(-90 * context.scale);
  ImGui::InputTextWithHint("##path", "type a path, from the folder above on", typed.data(), typed.size(),
                           isPathRefused(context, typed) ? 0 : ImGuiInputTextFlags_AutoSelectAll);
  tabStop();
  ImGui::SameLine();
  const char* const button = textOf(context.session.files().browser.purpose()).button;
  const bool is_pressed = ImGui::Button(button, {-1, 0});
  tabStop();
  if (is_pressed || (has_focus && isEnterPressed())) openChosen(context.session, typed);
}

}  // namespace

void drawFileBrowser(PanelContext& context) {
  Session& session = context.session;
  FileBrowser& browser = session.files().browser;
  if (session.panels.open) browser.update();
  const PurposeText text = textOf(browser.purpose());
  if (!beginDialog(context, text.title, session.panels.open, {640, 520}, Waits::yes, ImGuiWindowFlags_NoNav))
    return;
  static TypedPath typed;
  if (ImGui::IsWindowAppearing()) {
    std::snprintf(typed.data(), typed.size(), "%s", browser.proposed().c_str());
  }
  constexpr std::size_t kRecent = 4;
  const bool is_input = browser.purpose() == Purpose::input;
  if (is_input && !session.hasInput() && !session.files().recent.empty()) {
    ImGui::TextColored(accentColor(session.theme()), "Opened last");
    drawRecentFiles(context, kRecent);
    ImGui::Spacing();
  }
  drawPathBar(context);
  const float below = 2 * ImGui::GetFrameHeightWithSpacing() + ImGui::GetStyle().ItemSpacing.y;
  ImGui::BeginChild("entries", {0, -below}, true, ImGuiWindowFlags_NoNav);
  drawEntries(context, typed);
  ImGui::EndChild();
  const bool was_typed = typed[0] != '\0';  // before the keys of this frame edit it
  drawTypedPath(context, typed);
  if (is_input) {
    if (ImGui::Button("Open this folder of volumes")) openFile(session, browser.folder().string());
    tabStop();
    ImGui::SameLine();
  }
  if (isPathRefused(context, typed)) {
    ImGui::TextColored(errorColor(session.theme()), "there is no such file or folder");
  } else {
    ImGui::TextDisabled("arrows and Enter; Left: up; Tab: buttons; Esc closes");
  }
  if (ImGui::IsWindowFocused(ImGuiFocusedFlags_RootAndChildWindows)) handleKeys(session, was_typed);
  endDialog();
}

}  // namespace emscape::view
