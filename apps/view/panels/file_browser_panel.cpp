/// The file browser.
#include <fmt/format.h>

#include <cstring>
#include <filesystem>

#include "apps/view/panels/names.h"
#include "apps/view/panels/panels.h"
#include "apps/view/panels/theme.h"

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
    case FileKind::other:
      break;
  }
  return "";
}

bool pressed(ImGuiKey key) {
  return ImGui::IsKeyPressed(ImGui::GetKeyIndex(key));
}

void openFile(Session& session, const std::optional<std::string>& file) {
  if (!file) return;
  session.perform({session.files().browser.purpose() == FileBrowser::Purpose::view ? "load_state" : "open",
                   {{"file", *file}}});
}

/// Up, Down, page keys, Home and End move the selection; Enter and Right open it; Left and Backspace go up.
void handleKeys(Session& session, bool typing) {
  FileBrowser& browser = session.files().browser;
  constexpr int kPage = 12;
  if (pressed(ImGuiKey_UpArrow)) browser.moveSelection(-1);
  if (pressed(ImGuiKey_DownArrow)) browser.moveSelection(1);
  if (pressed(ImGuiKey_PageUp)) browser.moveSelection(-kPage);
  if (pressed(ImGuiKey_PageDown)) browser.moveSelection(kPage);
  if (typing) return;
  if (pressed(ImGuiKey_Home)) browser.select(0);
  if (pressed(ImGuiKey_End)) browser.select(static_cast<int>(browser.entries().size()));
  if (pressed(ImGuiKey_Enter) || pressed(ImGuiKey_KeyPadEnter) || pressed(ImGuiKey_RightArrow)) {
    openFile(session, browser.choose());
  } else if (pressed(ImGuiKey_LeftArrow) || pressed(ImGuiKey_Backspace)) {
    browser.goUp();
  }
}

void drawEntries(PanelContext& context) {
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
      if (ImGui::IsMouseDoubleClicked(0)) openFile(session, browser.choose());
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
    ImGui::TextColored(errorColor(session.theme()), "%s", browser.error().c_str());
  } else if (entries.empty()) {
    ImGui::TextDisabled(browser.reading() ? "reading ..." : "nothing here that can be opened");
  }
}

void drawPathBar(PanelContext& context) {
  FileBrowser& browser = context.session.files().browser;
  if (ImGui::Button("Up")) browser.goUp();
  ImGui::SameLine();
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(browser.folder().c_str());
}

/// @return true if the text field has the keyboard focus
bool drawTypedPath(PanelContext& context) {
  Session& session = context.session;
  FileBrowser& browser = session.files().browser;
  static char typed[4096] = "";
  ImGui::SetNextItemWidth(-90 * context.scale);
  const bool entered = ImGui::InputTextWithHint("##path", "type a path, from the folder above on", typed,
                                                sizeof typed, ImGuiInputTextFlags_EnterReturnsTrue);
  const bool active = ImGui::IsItemActive();
  ImGui::SameLine();
  if (ImGui::Button("Open", {-1, 0}) || entered) {
    openFile(session, typed[0] != '\0' ? browser.choose(std::string(typed)) : browser.choose());
    typed[0] = '\0';
  }
  return active;
}

}  // namespace

void drawFileBrowser(PanelContext& context) {
  Session& session = context.session;
  if (!session.panels.open) return;
  FileBrowser& browser = session.files().browser;
  browser.update();
  const float s = context.scale;
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({screen.x / 2, screen.y / 2}, ImGuiCond_Appearing, {0.5F, 0.5F});
  ImGui::SetNextWindowSize({std::min(640 * s, 0.94F * screen.x), std::min(520 * s, 0.9F * screen.y)},
                           ImGuiCond_Appearing);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 6 * s);
  const bool views = browser.purpose() == FileBrowser::Purpose::view;
  if (ImGui::Begin(views ? "Load a view###open" : "Open###open", &session.panels.open,
                   ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav)) {
    constexpr std::size_t kRecent = 4;
    if (!views && !session.hasInput() && !session.files().recent.empty()) {
      ImGui::TextColored(accentColor(session.theme()), "Opened last");
      drawRecentFiles(context, kRecent);
      ImGui::Spacing();
    }
    drawPathBar(context);
    const float below = 2 * ImGui::GetFrameHeightWithSpacing() + ImGui::GetStyle().ItemSpacing.y;
    ImGui::BeginChild("entries", {0, -below}, true, ImGuiWindowFlags_NoNav);
    drawEntries(context);
    ImGui::EndChild();
    const bool typing = drawTypedPath(context);
    if (!views) {
      if (ImGui::Button("Open this folder of volumes")) openFile(session, browser.folder().string());
      ImGui::SameLine();
    }
    ImGui::TextDisabled("arrows and Enter; Left: up; Esc closes");
    if (ImGui::IsWindowFocused(ImGuiFocusedFlags_RootAndChildWindows)) handleKeys(session, typing);
  }
  ImGui::End();
  ImGui::PopStyleVar();
}

}  // namespace emscape::view
