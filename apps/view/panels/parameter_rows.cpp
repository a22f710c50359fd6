#include "apps/view/panels/parameter_rows.h"

#include <fmt/format.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "apps/view/widgets/names.h"
#include "apps/view/widgets/refusal.h"
#include "apps/view/widgets/slider_field.h"
#include "apps/view/widgets/theme.h"
#include "apps/view/widgets/wrapped_text.h"
#include "base/files/json_writing.h"
#include "base/geodesy/position_text.h"
#include "base/text/quantity_text.h"
#include "base/text/shell_word.h"
#include "emscape/base/error.h"
#include "scenario/file/source.h"

namespace emscape::view {
namespace {

using scenario::Parameter;
using scenario::ParameterGroup;
using Type = Parameter::Type;

/// Significant digits of typed numbers, and of those on screen.
constexpr int kTypedDigits = 10, kShownDigits = 6;
constexpr float kNameWidth = 152;
constexpr const char* kByDefault = "by default";

bool isNumber(const Parameter& parameter) {
  return parameter.type == Type::number || parameter.type == Type::integer;
}

std::string numberText(double value) {
  return fmt::format("{:.{}g}", value, kTypedDigits);
}

std::string rangeOf(const Parameter& parameter) {
  return (parameter.minimum_excluded ? "above " : "") +
         rangeText(parameter.minimum, parameter.maximum, unitSigns(parameter.unit));
}

RowText textOf(const Parameter& parameter) {
  if (isNumber(parameter)) return RowText::number;
  const bool is_typed =
      parameter.type == Type::text || (parameter.type == Type::list && parameter.choices.empty());
  return is_typed ? RowText::all : RowText::none;
}

bool isCoordinate(const Parameter& parameter) {
  return parameter.key == "latitude_deg" || parameter.key == "longitude_deg";
}

/// @param factor  of a number without a unit
std::optional<double> numberOf(const Parameter& parameter, const std::string& text, double factor) {
  return isCoordinate(parameter) ? parseCoordinate(text, parameter.key == "latitude_deg")
                                 : parseQuantity(text, parameter.unit, factor);
}

/// Why a text is not a number of a parameter.
std::string faultOfText(const Parameter& parameter, const std::string& text) {
  const auto is_read = [&](const std::string& other) { return numberOf(parameter, other, 1).has_value(); };
  const std::string fault =
      quantityFault(text, isCoordinate(parameter) ? "" : readUnits(parameter.unit), is_read);
  if (!isCoordinate(parameter) || fault.find("is not a number") == std::string::npos) return fault;
  return fault + (parameter.key == "latitude_deg" ? " such as 44.41, 44.41N or 44°24'30\"N, nor a position"
                                                  : " such as -71.4, 71.4W or 71°24'W, nor a position");
}

/// "44,41" may be a number with a decimal comma.
bool mayBeDecimal(const std::string& text) {
  const std::size_t comma = text.find(',');
  return comma != std::string::npos && comma + 1 < text.size() && text[comma + 1] != ' ' &&
         text.find('.') == std::string::npos && text.find_first_not_of("+-0123456789,") == std::string::npos;
}

std::string tooltipOf(const Parameter& parameter) {
  std::string text = parameter.name + (parameter.description.empty() ? "" : ": " + parameter.description);
  if (isNumber(parameter)) {
    if (std::isfinite(parameter.minimum) || std::isfinite(parameter.maximum))
      text += "\n" + rangeOf(parameter);
    text +=
        "\nDouble click, Ctrl + click or Enter: type, also in other units. Drag: change; with Shift: fine.";
  }
  if (!parameter.is_given) text += "\ndefault";
  return text + fmt::format("\n--set '{}=…'", parameter.path);
}

/// The value in its unit, as it is shown and typed.
std::string shownText(const Parameter& parameter, int digits) {
  if (!isNumber(parameter) || parameter.value.empty()) return parameter.value;
  char* rest = nullptr;
  const double value = std::strtod(parameter.value.c_str(), &rest);
  if (*rest != '\0') return parameter.value;
  std::string text = quantityText(value, parameter.unit, digits);
  const std::string signs = unitSigns(parameter.unit);
  if (signs == parameter.unit) return text;
  const bool is_angle = signs == "°";  // written without a blank
  text.replace(text.size() - parameter.unit.size() - (is_angle ? 1 : 0), std::string::npos, signs);
  return text;
}

bool isGiven(const ParameterGroup& group) {
  return std::any_of(group.parameters.begin(), group.parameters.end(),
                     [](const Parameter& parameter) { return parameter.is_given; });
}

std::string titleOf(const Parameter& parameter, const std::string& choice) {
  const auto found = std::find(parameter.choices.begin(), parameter.choices.end(), choice);
  return found == parameter.choices.end()
             ? choice
             : parameter.titles[static_cast<std::size_t>(found - parameter.choices.begin())];
}

/// The items of a list of words: "[a, b]".
std::vector<std::string> itemsOf(const std::string& list) {
  std::vector<std::string> items;
  std::string word;
  for (const char c : list) {
    const bool is_part = c != '[' && c != ']' && c != ',' && c != ' ' && c != '"';
    if (is_part) word += c;
    if (!is_part && !word.empty()) items.push_back(std::exchange(word, {}));
  }
  if (!word.empty()) items.push_back(word);
  return items;
}

}  // namespace

bool ParameterRows::begin(const char* id) {
  if (!ImGui::BeginTable(id, 2, ImGuiTableFlags_SizingStretchProp)) return false;
  ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthFixed, kNameWidth * context_.scale);
  ImGui::TableSetupColumn("value", ImGuiTableColumnFlags_WidthStretch);
  return true;
}

void ParameterRows::end() {
  ImGui::EndTable();
}

void ParameterRows::label(const std::string& name, const std::string& tooltip, bool is_edited) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  const ImVec2 at = ImGui::GetCursorScreenPos(), padding = ImGui::GetStyle().FramePadding;
  const float width = ImGui::GetContentRegionAvail().x;
  const ImVec4 color =
      is_edited ? accentColor(context_.session.theme()) : ImGui::GetStyleColorVec4(ImGuiCol_Text);
  ImGui::InvisibleButton("label", {std::max(1.0F, width), ImGui::GetFrameHeight()});
  ImGui::PushStyleColor(ImGuiCol_Text, color);
  drawName(*ImGui::GetWindowDrawList(), name + (is_edited ? " •" : ""), {at.x, at.y + padding.y},
           at.x + width);
  ImGui::PopStyleColor();
  if (ImGui::IsItemHovered() && !ImGui::IsItemActive()) {
    ImGui::BeginTooltip();
    ImGui::TextUnformatted(wrapped(tooltip, 360 * context_.scale).c_str());
    ImGui::EndTooltip();
  }
}

void ParameterRows::draw(const ParameterGroup& group) {
  if (!begin(group.path.c_str())) return;
  drawGroup(group);
  end();
}

void ParameterRows::drawGroup(const ParameterGroup& group) {
  const auto isBasic = [&](const Parameter& parameter) {
    return !parameter.is_expert || parameter.is_given || edited_.count(parameter.path) > 0;
  };
  bool has_more = false;
  for (const Parameter& parameter : group.parameters) {
    has_more = has_more || !isBasic(parameter);
    if (isBasic(parameter)) drawRow(parameter);
  }
  if (has_more && drawSubheading(group.path + ".more", "more", false)) {
    for (const Parameter& parameter : group.parameters) {
      if (!isBasic(parameter)) drawRow(parameter);
    }
  }
  for (const ParameterGroup& inner : group.groups) {
    if (!drawSubheading(inner.path, inner.title, isGiven(inner))) continue;
    ImGui::PushID(inner.name.c_str());
    drawGroup(inner);
    ImGui::PopID();
  }
}

bool ParameterRows::drawSubheading(const std::string& id, const std::string& name, bool is_open_first) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  focus_.add(id);
  ImGuiStorage& storage = *ImGui::GetStateStorage();
  const ImGuiID key = ImGui::GetID(id.c_str());
  bool opens = storage.GetBool(key, is_open_first);
  if (focus_.isEntered(id) || focus_.isSpaced(id)) opens = !opens;
  if (focus_.steps(id) != 0) opens = focus_.steps(id) > 0;
  ImGui::SetNextItemOpen(opens);
  ImGui::PushStyleColor(ImGuiCol_Text, accentColor(context_.session.theme()));
  const bool is_open = ImGui::TreeNodeEx(
      ("##" + id).c_str(), ImGuiTreeNodeFlags_SpanFullWidth | ImGuiTreeNodeFlags_NoTreePushOnOpen);
  ImGui::PopStyleColor();
  ImGui::SameLine();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float right = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
  const ImRect& inside = ImGui::GetCurrentWindow()->InnerClipRect;
  list.PushClipRect({at.x, inside.Min.y}, {right, inside.Max.y});  // over both columns
  ImGui::PushStyleColor(ImGuiCol_Text, accentColor(context_.session.theme()));
  drawName(list, name, at, right);
  ImGui::PopStyleColor();
  list.PopClipRect();
  ImGui::Dummy({1, ImGui::GetTextLineHeight()});
  storage.SetBool(key, is_open);
  showFocus(id, RowText::none);
  return is_open;
}

void ParameterRows::drawRow(const Parameter& parameter) {
  ImGui::PushID(parameter.key.c_str());
  focus_.add(parameter.path, textOf(parameter));
  takeRejection(parameter.path);
  restoreValue(parameter.path);
  label(parameter.name, tooltipOf(parameter), edited_.count(parameter.path) > 0);
  if (ImGui::IsItemClicked()) focus_.take(parameter.path);
  drawLabelMenu(parameter);
  ImGui::TableNextColumn();
  ImGui::SetNextItemWidth(-1);
  const bool is_refused = state_.refused.path == parameter.path;
  if (is_refused) ImGui::PushStyleColor(ImGuiCol_Border, errorColor(context_.session.theme()));
  switch (parameter.type) {
    case Type::number:
    case Type::integer:
    case Type::text:
      drawValue(parameter);
      break;
    case Type::boolean:
      drawBoolean(parameter);
      break;
    case Type::choice:
      drawChoice(parameter);
      break;
    case Type::list:
      parameter.choices.empty() ? drawValue(parameter) : drawItems(parameter);
      break;
  }
  if (is_refused) ImGui::PopStyleColor();
  showFocus(parameter.path, textOf(parameter));
  drawRefusal(parameter.path);
  ImGui::PopID();
}

void ParameterRows::drawLabelMenu(const Parameter& parameter) const {
  if (!ImGui::BeginPopupContextItem("menu")) return;
  if (ImGui::MenuItem("Default", nullptr, false, !parameter.required && parameter.is_given)) {
    set(parameter.path, "null");
  }
  if (ImGui::MenuItem("Take back the change", nullptr, false, edited_.count(parameter.path) > 0)) {
    context_.session.perform({"revert", {{"path", parameter.path}}});
  }
  if (ImGui::MenuItem("Copy as --set")) {
    ImGui::SetClipboardText(shellWord(parameter.path + "=" + parameter.value).c_str());
  }
  ImGui::EndPopup();
}

void ParameterRows::showFocus(const std::string& path, RowText text) {
  if (ImGui::IsItemClicked() && !focus_.isTyping(path))
    text == RowText::none ? focus_.startAt(path) : focus_.take(path);
  if (!focus_.has(path)) return;
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  ImGui::GetWindowDrawList()->AddRect(low, high,
                                      ImGui::ColorConvertFloat4ToU32(accentColor(context_.session.theme())),
                                      ImGui::GetStyle().FrameRounding, 0, 1.5F * context_.scale);
  if (focus_.arrives(path)) ImGui::ScrollToItem(ImGuiScrollFlags_KeepVisibleEdgeY);
}

void ParameterRows::drawValue(const Parameter& parameter) {
  const std::string& path = parameter.path;
  const RefusedText& refused = state_.refused;
  const bool is_refused = refused.path == path && !refused.text.empty();
  const std::string typed_text = is_refused ? refused.text : shownText(parameter, kTypedDigits);
  if (focus_.isTyping(path)) {
    const std::optional<std::string> text = focus_.drawField();
    if (text) enter(parameter, *text);
    const bool is_taken_back = !text && !focus_.isTyping(path) && isKeyPressed(ImGuiKey_Escape);
    if (is_taken_back && refused.path == path) state_.refused = {};
    return;
  }
  std::optional<ValueSlider> slider;
  double value = 0;
  if (isNumber(parameter) && !parameter.value.empty() && !is_refused) {
    char* rest = nullptr;
    value = std::strtod(parameter.value.c_str(), &rest);
    if (*rest == '\0') slider = sliderOf(parameter, value);
  }
  const std::string shown = is_refused ? refused.text : shownText(parameter, kShownDigits);
  ValueFrame frame{shown.empty() ? kByDefault : shown, ImGui::GetStyleColorVec4(ImGuiCol_Text), {}};
  if (is_refused) frame.ink = errorColor(context_.session.theme());
  if (!is_refused && !parameter.is_given) frame.ink = mutedColor(context_.session.theme());
  if (slider) frame.position = slider->positionOf(value);
  const bool is_long = drawValueFrame("##value", frame, ImGui::GetContentRegionAvail().x, context_.scale);
  tooltipOfLongName(shown, is_long && !ImGui::IsItemActive());
  const bool types = wantsTyping() || (ImGui::IsItemClicked() && !slider) || focus_.isEntered(path);
  const std::string characters = focus_.typed(path);
  if (types || !characters.empty()) {
    if (std::exchange(state_.drag.is_moved, false)) context_.session.endDrag();
    state_.drag.path.clear();
    focus_.type(path, characters.empty() ? typed_text : characters, characters.empty());
  } else if (slider) {
    handleSlider(parameter, *slider, value);
  }
}

void ParameterRows::handleSlider(const Parameter& parameter, const ValueSlider& slider, double value) {
  const double pixel = 1 / std::max(1.0, static_cast<double>(ImGui::GetItemRectSize().x));
  auto& drag_state = state_.drag;
  if (const int steps = focus_.steps(parameter.path)) {
    const double step = slider.stepAt(value, pixel);
    const double next = (std::round(value / step) + steps) * step;
    set(parameter.path, numberText(std::clamp(next, parameter.minimum, parameter.maximum)));
  }
  if (ImGui::IsItemActivated())
    drag_state = {parameter.path, numberText(value), slider.positionOf(value), false};
  if (drag_state.path != parameter.path) return;
  const double rate = slider.dragRate(1 / pixel);
  if (dragPosition(drag_state.position, drag_state.is_moved, context_.scale, rate)) {
    const double fine = rate * (ImGui::GetIO().KeyShift ? 0.1 : 1);
    drag(parameter, numberText(slider.steppedValueAt(drag_state.position, fine * pixel)));
  }
  if (drag_state.is_moved && isKeyPressed(ImGuiKey_Escape)) {
    context_.session.cancelDrag();
    drag_state.path.clear();
    ImGui::ClearActiveID();
  } else if (ImGui::IsItemDeactivated()) {
    if (drag_state.is_moved) context_.session.endDrag();
    drag_state.path.clear();
  }
}

/// A value that is held still makes one edit.
void ParameterRows::drag(const Parameter& parameter, const std::string& value) {
  if (value == std::exchange(state_.drag.sent, value)) return;
  context_.session.dragValue(parameter.path, value);
}

/// A whole position that is typed as latitude or longitude sets both. @return false if the text is none
bool ParameterRows::enterPosition(const Parameter& parameter, const std::string& text) {
  if (!isCoordinate(parameter) || numberOf(parameter, text, 1) || mayBeDecimal(text)) return false;
  try {
    const ParsedPosition position = parsePosition(text);
    const std::string section = parameter.path.substr(0, parameter.path.size() - parameter.key.size());
    const auto edit = [&](const char* key, double degrees) {
      return toString(scenario::Edit{section + key, fmt::format("{:.7f}", degrees)});
    };
    context_.session.perform(
        {"set_together",
         {{"edits",
           {edit("latitude_deg", position.latitude_deg), edit("longitude_deg", position.longitude_deg)}}}});
    return true;
  } catch (const Error&) {
    return false;
  }
}

/// A number without a unit is in the unit that was shown.
void ParameterRows::enter(const Parameter& parameter, const std::string& typed) {
  const std::string& path = parameter.path;
  const std::size_t begin = typed.find_first_not_of(' ');
  const std::string text =
      begin == std::string::npos ? "" : typed.substr(begin, typed.find_last_not_of(' ') + 1 - begin);
  if (state_.refused.path == path) state_.refused = {};
  if (text.empty()) {
    if (parameter.required)
      state_.refused = {path, typed, parameter.name + ": a text is needed", context_.session.scenario(),
                        /*is_own=*/true};
    else if (parameter.is_given)
      set(path, "null");
    return;
  }
  if (!isNumber(parameter)) {
    if (text == parameter.value) return;
    state_.sent_path = path;
    state_.sent_text = text;
    return set(path, parameter.type == Type::text ? dumpJson(Json(text)) : text);
  }
  if (enterPosition(parameter, text)) return;
  const double value = std::strtod(parameter.value.c_str(), nullptr);
  const double factor = prefixedUnit(value, parameter.unit, kTypedDigits).factor;
  const std::optional<double> number = numberOf(parameter, text, factor);
  const auto refuse = [&](const std::string& why) {
    state_.refused = {path, text, why, context_.session.scenario()};
  };
  const bool is_word = !number && text.find_first_of("0123456789") == std::string::npos;
  const bool is_above =
      number && (parameter.minimum_excluded ? *number > parameter.minimum : *number >= parameter.minimum);
  if (number && !(is_above && *number <= parameter.maximum)) {
    return refuse(fmt::format("{}: {} is not allowed; {}", parameter.name, text, rangeOf(parameter)));
  }
  if (number && parameter.type == Type::integer && *number != std::round(*number)) {
    return refuse(
        fmt::format("{}: a whole number is needed; allowed: {}", parameter.name, rangeOf(parameter)));
  }
  if (!number && !(is_word && !parameter.choices.empty())) {
    return refuse(
        fmt::format("{}: {}; allowed: {}", parameter.name, faultOfText(parameter, text), rangeOf(parameter)));
  }
  const std::string next = number ? numberText(*number) : text;
  if (next == numberText(value) && parameter.is_given) return;
  state_.sent_path = path;
  state_.sent_text = text;
  const bool is_default = number && *number == std::strtod(parameter.default_value.c_str(), nullptr);
  set(path, is_default && !parameter.default_value.empty() && isAdded(path) ? "null" : next);
}

void ParameterRows::drawBoolean(const Parameter& parameter) {
  bool on = parameter.value == "true";
  const bool is_switched = ImGui::Checkbox("##value", &on);
  if (focus_.isEntered(parameter.path) || focus_.isSpaced(parameter.path)) on = !on;
  if (!is_switched && on == (parameter.value == "true")) return;
  const std::string next = on ? "true" : "false";
  set(parameter.path, next == parameter.default_value ? "null" : next);
}

void ParameterRows::drawChoice(const Parameter& parameter) {
  if (focus_.isEntered(parameter.path) || focus_.isSpaced(parameter.path))
    ImGui::ActivateItem(ImGui::GetID("##value"));
  const std::string shown = parameter.value.empty() ? kByDefault : titleOf(parameter, parameter.value);
  if (!beginComboOfName("##value", shown)) return;
  for (std::size_t i = 0; i < parameter.choices.size(); ++i) {
    const std::string& choice = parameter.choices[i];
    pushNameId(choice);
    const bool is_chosen = selectableName(parameter.titles[i], choice == parameter.value);
    if (choice == parameter.value) ImGui::SetItemDefaultFocus();
    ImGui::PopID();
    if (!is_chosen || choice == parameter.value) continue;
    state_.sent_path = parameter.path;
    state_.sent_text.clear();
    context_.session.perform({"choose", {{"path", parameter.path}, {"value", choice}}});
  }
  ImGui::EndCombo();
}

void ParameterRows::drawItems(const Parameter& parameter) {
  if (focus_.isEntered(parameter.path) || focus_.isSpaced(parameter.path))
    ImGui::ActivateItem(ImGui::GetID("##value"));
  std::vector<std::string> items = itemsOf(parameter.value);
  std::string shown;
  for (const std::string& item : items) shown += (shown.empty() ? "" : ", ") + titleOf(parameter, item);
  if (!beginComboOfName("##value", shown)) return;
  for (std::size_t i = 0; i < parameter.choices.size(); ++i) {
    const std::string& choice = parameter.choices[i];
    const auto found = std::find(items.begin(), items.end(), choice);
    bool on = found != items.end();
    ImGui::PushID(static_cast<int>(i));
    ImGui::BeginDisabled(on && items.size() == 1);  // one stays
    if (ImGui::Checkbox("##item", &on)) {
      on ? static_cast<void>(items.push_back(choice)) : static_cast<void>(items.erase(found));
      state_.sent_path = parameter.path;
      state_.sent_text.clear();
      set(parameter.path, fmt::format("[{}]", fmt::join(items, ", ")));
    }
    ImGui::EndDisabled();
    ImGui::SameLine();
    ImGui::TextUnformatted(drawable(parameter.titles[i]).c_str());
    ImGui::PopID();
  }
  ImGui::EndCombo();
}

/// Marks the row whose edit the session has refused.
void ParameterRows::takeRejection(const std::string& path) {
  const std::optional<Rejection>& rejection = context_.session.rejection();
  const bool is_own = rejection && !rejection->edits.empty() && rejection->edits.front().path == path;
  if (is_own && state_.sent_path == path) {
    state_.refused = {path, std::exchange(state_.sent_text, {}), rejection->message,
                      context_.session.scenario()};
    state_.sent_path.clear();
  }
  const RefusedText& refused = state_.refused;
  if (!rejection && state_.sent_path != path && refused.path == path && refused.text.empty() &&
      !refused.is_own)
    state_.refused = {};
  context_.shows_rejection = context_.shows_rejection || (is_own && state_.refused.path == path);
}

/// Esc, and each change of the scenario such as undo, show the value again in place of a refused text.
void ParameterRows::restoreValue(const std::string& path) {
  if (state_.refused.path != path) return;
  const bool is_escaped = focus_.isEscaped(path);
  if (is_escaped) focus_.take(path);  // the next Esc leaves the row
  if (is_escaped || state_.refused.scenario != context_.session.scenario()) state_.refused = {};
}

void ParameterRows::drawRefusal(const std::string& path) {
  if (state_.refused.path != path || focus_.isTyping(path)) return;
  if (focus_.has(path) || ImGui::IsItemHovered()) emscape::view::drawRefusal(context_, state_.refused.why);
}

/// True if the file has no value at a path.
bool ParameterRows::isAdded(const std::string& path) const {
  const playback::ScenarioPtr scenario = context_.session.scenario();
  return scenario && scenario->source && scenario::isAdded(*scenario->source, path);
}

void ParameterRows::set(const std::string& path, const std::string& value) const {
  context_.session.perform({"set", {{"path", path}, {"value", value}}});
}

}  // namespace emscape::view
