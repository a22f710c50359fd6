#include "apps/view/widgets/dialog.h"

#include <GLFW/glfw3.h>
#include <imgui_internal.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "apps/view/widgets/refusal.h"
#include "apps/view/widgets/theme.h"

namespace emscape::view {
namespace {

struct Place {
  ImVec2 from, to;
};

/// Where the dialogs were drawn last, by title.
Place& placeOf(const char* title) {
  static std::map<std::string, Place> places;
  return places[title];
}

/// An item to which Tab goes.
struct TabStop {
  ImGuiID item;
  bool is_text;  ///< gets the cursor; else a mark, with which Enter and Space press it
};

/// A dialog that was drawn in this frame or the one before.
struct OpenDialog {
  const char* title;
  ImGuiID window;
  bool waits;  ///< the rest of the window waits for it
  int frame;
  std::vector<TabStop> stops{}, stops_before{};  ///< of this frame and the one before
  ImGuiID focused = 0;                           ///< a stop; 0: none
  bool arrives = false;                          ///< at it, in this frame
  bool has_answers = false;                      ///< the arrow keys go from stop to stop, too

  /// The stop with the focus; null: none has it.
  const TabStop* focusedStop() const {
    const auto found = std::find_if(stops_before.begin(), stops_before.end(),
                                    [this](const TabStop& stop) { return stop.item == focused; });
    return found == stops_before.end() ? nullptr : &*found;
  }
};

/// The open dialogs; the one that was opened last is at the end.
std::vector<OpenDialog>& openDialogs() {
  static std::vector<OpenDialog> dialogs;
  const int frame = ImGui::GetFrameCount();
  dialogs.erase(std::remove_if(dialogs.begin(), dialogs.end(),
                               [&](const OpenDialog& dialog) { return frame - dialog.frame > 1; }),
                dialogs.end());
  return dialogs;
}

/// Of the dialog with this title. Titles with the same text from ### on are one window, which keeps the name
/// of the first: windows are told by number.
ImGuiID windowOf(const char* title) {
  return ImHashStr(title);
}

void noteOpen(const char* title, Waits waits) {
  std::vector<OpenDialog>& dialogs = openDialogs();
  const auto known = std::find_if(dialogs.begin(), dialogs.end(),
                                  [&](const OpenDialog& dialog) { return dialog.window == windowOf(title); });
  if (known != dialogs.end()) {
    known->title = title;
    known->frame = ImGui::GetFrameCount();
  } else {
    OpenDialog& dialog = dialogs.emplace_back();
    dialog.title = title;
    dialog.window = windowOf(title);
    dialog.waits = waits == Waits::yes;
    dialog.frame = ImGui::GetFrameCount();
  }
}

bool isOnTop(ImGuiID window) {
  const std::vector<OpenDialog>& dialogs = openDialogs();
  return !dialogs.empty() && dialogs.back().window == window;
}

/// The dialog of the present window; null: it is none.
OpenDialog* presentDialog() {
  for (OpenDialog& dialog : openDialogs()) {
    if (dialog.window == ImGui::GetCurrentWindow()->RootWindow->ID) return &dialog;
  }
  return nullptr;
}

/// True if keys are for the dialog of the present window: not the key that opened it, or closed a list.
bool takesKeys() {
  const ImGuiWindow* const window = ImGui::GetCurrentWindow()->RootWindow;
  return !window->Appearing && !wasPopupOpen() && isOnTop(window->ID);
}

/// Tab, and with answers the arrow keys, go from stop to stop.
void moveFocus(OpenDialog& dialog) {
  dialog.stops_before = std::exchange(dialog.stops, {});
  dialog.arrives = false;
  const ImGuiIO& io = ImGui::GetIO();
  if (!takesKeys() || dialog.stops_before.empty() || io.KeyCtrl || io.KeyAlt) return;
  // ImGuiIO::KeyMap has no Tab while a dialog is open: Dear ImGui's own would skip all but text fields.
  const bool is_tab = ImGui::IsKeyPressed(GLFW_KEY_TAB, true);
  const auto isPressed = [&](ImGuiKey a, ImGuiKey b) {
    return dialog.has_answers && (isKeyPressed(a, true) || isKeyPressed(b, true));
  };
  const bool goes_on = (is_tab && !io.KeyShift) || isPressed(ImGuiKey_RightArrow, ImGuiKey_DownArrow);
  const bool goes_back = (is_tab && io.KeyShift) || isPressed(ImGuiKey_LeftArrow, ImGuiKey_UpArrow);
  if (goes_on == goes_back) return;
  const TabStop* const from = dialog.focusedStop();
  const auto count = static_cast<int>(dialog.stops_before.size());
  const int index = from != nullptr ? static_cast<int>(from - dialog.stops_before.data()) : goes_on ? -1 : 0;
  ImGui::ClearActiveID();  // a field gives its text
  dialog.focused =
      dialog.stops_before[static_cast<std::size_t>((index + (goes_on ? 1 : -1) + count) % count)].item;
  dialog.arrives = true;
}

/// Gives the focus to the dialog on top, however it was lost, while the rest of the window waits.
void keepFocus(const char* title) {
  const std::vector<OpenDialog>& dialogs = openDialogs();
  const bool waits =
      std::any_of(dialogs.begin(), dialogs.end(), [](const OpenDialog& dialog) { return dialog.waits; });
  if (!waits || !isOnTop(windowOf(title)) || isPopupOpen()) return;
  const ImGuiWindow* const focused = ImGui::GetCurrentContext()->NavWindow;
  if (focused == nullptr || focused->RootWindow->ID != windowOf(title)) ImGui::SetNextWindowFocus();
}

void drawShadow(ImDrawList& list, const Place& place, float scale) {
  constexpr int kRings = 8;
  const float reach = 2 * scale;
  for (int ring = kRings; ring > 0; --ring) {
    const float by = reach * static_cast<float>(ring);
    list.AddRectFilled({place.from.x - by, place.from.y - by / 2}, {place.to.x + by, place.to.y + 1.5F * by},
                       IM_COL32(0, 0, 0, 14), 6 * scale + by);
  }
}

/// Dims the window and takes the mouse from what lies below the dialog.
void drawBehind(const char* title, float scale, Waits waits) {
  const bool dims = waits == Waits::yes;
  const Place place = placeOf(title);
  const float reach = 24 * scale;
  ImGui::SetNextWindowPos(dims ? ImVec2(0, 0) : ImVec2(place.from.x - reach, place.from.y - reach));
  ImGui::SetNextWindowSize(
      dims ? ImGui::GetIO().DisplaySize
           : ImVec2(place.to.x - place.from.x + 2 * reach, place.to.y - place.from.y + 2 * reach));
  ImGuiWindowFlags flags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoSavedSettings |
                           ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoBackground;
  if (!dims) flags |= ImGuiWindowFlags_NoInputs;
  ImGui::Begin((std::string(title) + "##behind").c_str(), nullptr, flags);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.PushClipRectFullScreen();  // without the window's padding
  if (dims) {
    list.AddRectFilled({0, 0}, ImGui::GetIO().DisplaySize, ImGui::GetColorU32(ImGuiCol_ModalWindowDimBg));
  }
  if (place.to.x > place.from.x) drawShadow(list, place, scale);
  list.PopClipRect();
  ImGui::End();
}

}  // namespace

bool beginDialog(PanelContext& context, const char* title, bool& open, const ImVec2& size, Waits waits,
                 ImGuiWindowFlags flags) {
  if (!open) {
    placeOf(title) = {};
    return false;
  }
  const float s = context.scale, margin = 8 * s;
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  const ImVec2 most{std::max(1.0F, screen.x - 2 * margin), std::max(1.0F, screen.y - 2 * margin)};
  noteOpen(title, waits);
  drawBehind(title, s, waits);
  keepFocus(title);
  ImGui::SetNextWindowPos({screen.x / 2, screen.y / 2}, ImGuiCond_Appearing, {0.5F, 0.5F});
  ImGui::SetNextWindowSizeConstraints({0, 0}, most);
  if (size.x > 0) ImGui::SetNextWindowSize({size.x * s, size.y * s}, ImGuiCond_Appearing);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 6 * s);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, std::max(1.0F, s));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(16 * s, 14 * s));
  if (size.x <= 0) flags |= ImGuiWindowFlags_AlwaysAutoResize;
  ImGui::Begin(title, &open, flags | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings);
  const ImVec2 at = ImGui::GetWindowPos(), own = ImGui::GetWindowSize();
  // Stays inside when the window shrinks or the dialog is moved.
  const ImVec2 inside{std::clamp(at.x, margin, std::max(margin, screen.x - margin - own.x)),
                      std::clamp(at.y, margin, std::max(margin, screen.y - margin - own.y))};
  if (inside.x != at.x || inside.y != at.y) ImGui::SetWindowPos(inside);
  placeOf(title) = {inside, {inside.x + own.x, inside.y + own.y}};
  if (OpenDialog* const dialog = presentDialog(); dialog != nullptr) moveFocus(*dialog);
  return true;
}

void tabStop() {
  OpenDialog* const dialog = presentDialog();
  if (dialog == nullptr) return;
  const ImGuiID item = ImGui::GetItemID();
  const bool is_text = (ImGui::GetCurrentContext()->LastItemData.InFlags & ImGuiItemFlags_Inputable) != 0;
  dialog->stops.push_back({item, is_text});
  if (is_text && ImGui::IsItemActive()) dialog->focused = item;
  if (item != dialog->focused) return;
  const bool arrives = std::exchange(dialog->arrives, false);
  if (arrives) ImGui::ScrollToItem(ImGuiScrollFlags_KeepVisibleEdgeY);
  if (is_text) {
    if (arrives) ImGui::SetKeyboardFocusHere(-1);
    return;
  }
  ImGui::GetWindowDrawList()->AddRect(ImGui::GetItemRectMin(), ImGui::GetItemRectMax(),
                                      ImGui::GetColorU32(ImGuiCol_NavHighlight),
                                      ImGui::GetStyle().FrameRounding, 0, 0.14F * ImGui::GetFontSize());
  // Space plays: it must not answer a question that has just come.
  const bool is_pressed = isEnterPressed() || (!dialog->has_answers && isKeyPressed(ImGuiKey_Space));
  if (takesKeys() && is_pressed) ImGui::ActivateItem(item);
}

bool isButtonFocused() {
  const OpenDialog* const dialog = presentDialog();
  const TabStop* const stop = dialog != nullptr ? dialog->focusedStop() : nullptr;
  return stop != nullptr && !stop->is_text;
}

ImVec2 besideDialogs(const ImVec2& at, const ImVec2& size, const ImVec2& low, const ImVec2& high, float gap) {
  const std::vector<OpenDialog>& dialogs = openDialogs();
  if (dialogs.empty()) return at;
  const Place dialog = placeOf(dialogs.back().title);
  const auto isFree = [&](const ImVec2& from) {
    return from.x >= low.x && from.y >= low.y && from.x + size.x <= high.x && from.y + size.y <= high.y &&
           (from.x >= dialog.to.x || from.x + size.x <= dialog.from.x || from.y >= dialog.to.y ||
            from.y + size.y <= dialog.from.y);
  };
  for (const ImVec2& from : {at, ImVec2(at.x, dialog.to.y + gap), ImVec2(at.x, dialog.from.y - gap - size.y),
                             ImVec2(dialog.to.x + gap, at.y), ImVec2(dialog.from.x - gap - size.x, at.y)}) {
    if (isFree(from)) return from;
  }
  return {at.x, high.y - size.y};  // over its buttons rather than its title
}

void endDialog() {
  ImGui::End();
  ImGui::PopStyleVar(3);
}

bool defaultButton(const char* text) {
  const bool is_refused = hasRefusedField();  // the dialog would act with the value before
  ImGui::BeginDisabled(is_refused);
  const bool pressed = ImGui::Button((std::string(text) + " (Enter)").c_str());
  tabStop();
  ImGui::EndDisabled();
  ImGui::SameLine();
  return !is_refused && (pressed || (takesKeys() && !isButtonFocused() && isEnterPressed()));
}

int drawAnswers(const std::string& question, const std::vector<const char*>& answers, int first) {
  ImGuiStorage& storage = *ImGui::GetStateStorage();
  const ImGuiID asked_id = ImGui::GetID("asked");
  const auto asked = static_cast<int>(ImGui::GetID(question.c_str()));
  const bool is_new = ImGui::IsWindowAppearing() || storage.GetInt(asked_id) != asked;
  storage.SetInt(asked_id, asked);
  OpenDialog* const dialog = presentDialog();
  if (dialog != nullptr) dialog->has_answers = true;
  int given = -1;
  for (int i = 0; i < static_cast<int>(answers.size()); ++i) {
    if (i > 0) ImGui::SameLine();
    if (ImGui::Button(answers[static_cast<std::size_t>(i)])) given = i;
    if (is_new && i == first && dialog != nullptr) dialog->focused = ImGui::GetItemID();
    tabStop();
  }
  return given;
}

}  // namespace emscape::view
