#include "apps/view/widgets/dialog.h"

#include <imgui_internal.h>

#include <algorithm>
#include <cstring>
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

/// A dialog that was drawn in this frame or the one before.
struct OpenDialog {
  const char* title;
  bool waits;  ///< the rest of the window waits for it
  int frame;
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

void noteOpen(const char* title, Waits waits) {
  std::vector<OpenDialog>& dialogs = openDialogs();
  const auto known = std::find_if(dialogs.begin(), dialogs.end(), [&](const OpenDialog& dialog) {
    return std::strcmp(dialog.title, title) == 0;
  });
  if (known != dialogs.end()) {
    known->frame = ImGui::GetFrameCount();
  } else {
    dialogs.push_back({title, waits == Waits::yes, ImGui::GetFrameCount()});
  }
}

bool isOnTop(const char* title) {
  const std::vector<OpenDialog>& dialogs = openDialogs();
  return !dialogs.empty() && std::strcmp(dialogs.back().title, title) == 0;
}

/// Gives the focus to the dialog on top, however it was lost, while the rest of the window waits.
void keepFocus(const char* title) {
  const std::vector<OpenDialog>& dialogs = openDialogs();
  const bool waits =
      std::any_of(dialogs.begin(), dialogs.end(), [](const OpenDialog& dialog) { return dialog.waits; });
  if (!waits || !isOnTop(title) || isPopupOpen()) return;
  const ImGuiWindow* const focused = ImGui::GetCurrentContext()->NavWindow;
  if (focused == nullptr || std::strcmp(focused->RootWindow->Name, title) != 0) ImGui::SetNextWindowFocus();
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
  return true;
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
  ImGui::EndDisabled();
  ImGui::SameLine();
  const bool takes_keys = !is_refused && !ImGui::IsWindowAppearing() && !wasPopupOpen() &&
                          isOnTop(ImGui::GetCurrentWindow()->RootWindow->Name);
  return pressed || (takes_keys && isEnterPressed());
}

int drawAnswers(const PanelContext& context, const std::string& question,
                const std::vector<const char*>& answers, int first) {
  const auto count = static_cast<int>(answers.size());
  ImGuiStorage& storage = *ImGui::GetStateStorage();
  const ImGuiID asked_id = ImGui::GetID("asked"), marked_id = ImGui::GetID("marked");
  const auto asked = static_cast<int>(ImGui::GetID(question.c_str()));
  const bool is_same = !ImGui::IsWindowAppearing() && storage.GetInt(asked_id) == asked;
  int marked = is_same ? storage.GetInt(marked_id) : first;
  const bool takes_keys =
      !ImGui::IsWindowAppearing() && !wasPopupOpen() && isOnTop(ImGui::GetCurrentWindow()->RootWindow->Name);
  if (takes_keys) {
    const bool is_tab = isKeyPressed(ImGuiKey_Tab, true), goes_back = ImGui::GetIO().KeyShift;
    const auto isPressed = [](ImGuiKey a, ImGuiKey b) {
      return isKeyPressed(a, true) || isKeyPressed(b, true);
    };
    if ((is_tab && !goes_back) || isPressed(ImGuiKey_RightArrow, ImGuiKey_DownArrow)) ++marked;
    if ((is_tab && goes_back) || isPressed(ImGuiKey_LeftArrow, ImGuiKey_UpArrow)) marked += count - 1;
    marked %= count;
  }
  storage.SetInt(asked_id, asked);
  storage.SetInt(marked_id, marked);
  int given = takes_keys && isEnterPressed() ? marked : -1;
  for (int i = 0; i < count; ++i) {
    if (i > 0) ImGui::SameLine();
    if (ImGui::Button(answers[static_cast<std::size_t>(i)])) given = i;
    if (i != marked) continue;
    ImGui::GetWindowDrawList()->AddRect(ImGui::GetItemRectMin(), ImGui::GetItemRectMax(),
                                        ImGui::ColorConvertFloat4ToU32(accentColor(context.session.theme())),
                                        ImGui::GetStyle().FrameRounding, 0, 2 * context.scale);
  }
  return given;
}

}  // namespace emscape::view
