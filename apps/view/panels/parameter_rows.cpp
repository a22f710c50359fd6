#include "apps/view/panels/parameter_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>

#include "apps/view/panels/names.h"
#include "apps/view/panels/theme.h"
#include "base/files/json_writing.h"
#include "base/text/quantity_text.h"
#include "base/text/shell_word.h"

namespace emscape::view {
namespace {

using scenario::Parameter;
using scenario::ParameterGroup;

/// The part of the allowed range that a slider spans; other values are typed after Ctrl + click.
struct SliderRange {
  const char* key;
  double min, max;
  bool is_logarithmic = false;
};
constexpr std::array<SliderRange, 33> kSliderRanges{{
    {"power_w", 1e-2, 1e7, true},
    {"losses_db", 0, 30},
    {"gain_dbi", -10, 60},
    {"beamwidth_az_deg", 0.1, 360, true},
    {"beamwidth_el_deg", 0.1, 180, true},
    {"side_lobe_db", -80, 0},
    {"columns", 1, 256},
    {"rows", 1, 256},
    {"azimuth_deg", -180, 360},
    {"elevation_deg", -10, 60},
    {"heading_deg", 0, 360},
    {"rate_rpm", -60, 60},
    {"rate_deg_s", 0.1, 360, true},
    {"bars", 1, 16},
    {"noise_figure_db", 0, 20},
    {"antenna_temperature_k", 0, 1000},
    {"processing_gain_db", -20, 60},
    {"cross_polar_isolation_db", 0, 60},
    {"pulses", 1, 256},
    {"pfa", 1e-12, 0.1, true},
    {"target_rcs_m2", 1e-3, 1e3, true},
    {"height_agl_m", 0, 3000, true},
    {"height_msl_m", 0, 12000},
    {"height_ellipsoid_m", 0, 12000},
    {"k_factor", 0.5, 4},
    {"pressure_hpa", 600, 1100},
    {"temperature_k", 230, 320},
    {"vapour_g_m3", 0, 30},
    {"rain_mm_h", 0, 100},
    {"irregularity_m", 0, 500},
    {"roughness_m", 0, 10},
    {"floor", -200, 0},
    {"count_threshold_dbwm2", -150, 0},
}};
/// Significant digits of typed numbers, and of numbers set by a slider.
constexpr int kTypedDigits = 10, kDraggedDigits = 5;
/// Values with wider ranges, and coordinates, are typed.
constexpr double kMaxSliderWidth = 1000;

std::optional<SliderRange> sliderRangeOf(const Parameter& parameter) {
  for (const SliderRange& range : kSliderRanges) {
    if (parameter.key == range.key) return range;
  }
  const bool is_place = parameter.key == "latitude_deg" || parameter.key == "longitude_deg";
  if (is_place || parameter.unit == "Hz" || !(parameter.maximum - parameter.minimum <= kMaxSliderWidth))
    return std::nullopt;
  return SliderRange{"", parameter.minimum, parameter.maximum};
}

std::string numberText(double value, int digits = kTypedDigits) {
  return fmt::format("{:.{}g}", value, digits);
}

std::string tooltipOf(const Parameter& parameter) {
  std::string text = parameter.description;
  const bool is_number =
      parameter.type == Parameter::Type::number || parameter.type == Parameter::Type::integer;
  if (is_number && (std::isfinite(parameter.minimum) || std::isfinite(parameter.maximum))) {
    text += (text.empty() ? "" : "\n") + rangeText(parameter.minimum, parameter.maximum, parameter.unit);
  }
  if (!parameter.is_given) text += text.empty() ? "default" : "\ndefault";
  return text + fmt::format("{}--set '{}=…'", text.empty() ? "" : "\n", parameter.path);
}

bool isGiven(const ParameterGroup& group) {
  return std::any_of(group.parameters.begin(), group.parameters.end(),
                     [](const Parameter& parameter) { return parameter.is_given; });
}

/// Covers the text of a field that is not edited, if Dear ImGui cannot draw it.
void drawOverField(const std::string& text, const ImVec2& at) {
  if (ImGui::IsItemActive() || drawable(text) == text) return;
  const ImVec2 padding = ImGui::GetStyle().FramePadding, end = ImGui::GetItemRectMax();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled({at.x + 1, at.y + 1}, {end.x - 1, end.y - 1}, ImGui::GetColorU32(ImGuiCol_FrameBg));
  drawName(list, text, {at.x + padding.x, at.y + padding.y}, end.x - padding.x);
}

}  // namespace

bool ParameterRows::begin(const char* id) {
  if (!ImGui::BeginTable(id, 2, ImGuiTableFlags_SizingStretchProp)) return false;
  ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthFixed, 138 * context_.scale);
  ImGui::TableSetupColumn("value", ImGuiTableColumnFlags_WidthStretch);
  return true;
}

void ParameterRows::end() {
  ImGui::EndTable();
}

void ParameterRows::label(const std::string& name, const std::string& tooltip, bool is_edited) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::AlignTextToFramePadding();
  const ImVec4 color =
      is_edited ? accentColor(context_.session.theme()) : ImGui::GetStyleColorVec4(ImGuiCol_Text);
  ImGui::TextColored(color, "%s%s", drawable(name).c_str(), is_edited ? " •" : "");
  if (ImGui::IsItemHovered()) {
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(360 * context_.scale);
    ImGui::TextUnformatted(drawable(tooltip).c_str());
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
  }
}

void ParameterRows::draw(const ParameterGroup& group) {
  if (!begin(group.path.c_str())) return;
  drawGroup(group);
  end();
}

void ParameterRows::drawGroup(const ParameterGroup& group) {
  for (const Parameter& parameter : group.parameters) drawRow(parameter);
  for (const ParameterGroup& inner : group.groups) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    std::string name = inner.name;
    std::replace(name.begin(), name.end(), '_', ' ');
    ImGui::PushStyleColor(ImGuiCol_Text, accentColor(context_.session.theme()));
    const bool open = ImGui::TreeNodeEx(
        name.c_str(), ImGuiTreeNodeFlags_SpanFullWidth | ImGuiTreeNodeFlags_NoTreePushOnOpen |
                          (isGiven(inner) ? ImGuiTreeNodeFlags_DefaultOpen : 0));
    ImGui::PopStyleColor();
    if (!open) continue;
    ImGui::PushID(inner.name.c_str());
    drawGroup(inner);
    ImGui::PopID();
  }
}

void ParameterRows::drawRow(const Parameter& parameter) {
  ImGui::PushID(parameter.key.c_str());
  label(parameter.name, tooltipOf(parameter), edited_.count(parameter.path) > 0);
  drawLabelMenu(parameter);
  ImGui::TableNextColumn();
  ImGui::SetNextItemWidth(-1);
  switch (parameter.type) {
    case Parameter::Type::number:
    case Parameter::Type::integer:
      drawNumber(parameter);
      break;
    case Parameter::Type::choice:
      drawChoice(parameter);
      break;
    case Parameter::Type::text:
    case Parameter::Type::list:
      drawText(parameter);
      break;
  }
  drawRejection(parameter.path);
  ImGui::PopID();
}

void ParameterRows::drawLabelMenu(const Parameter& parameter) const {
  if (!ImGui::BeginPopupContextItem("menu")) return;
  if (ImGui::MenuItem("Default", nullptr, false, !parameter.required && parameter.is_given)) {
    set(parameter.path, "null");
  }
  if (ImGui::MenuItem("Copy as --set")) {
    ImGui::SetClipboardText(shellWord(parameter.path + "=" + parameter.value).c_str());
  }
  ImGui::EndPopup();
}

void ParameterRows::drawNumber(const Parameter& parameter) {
  const std::optional<SliderRange> range = sliderRangeOf(parameter);
  if (!range || parameter.value.empty()) return drawTypedNumber(parameter);
  const double given = std::strtod(parameter.value.c_str(), nullptr);
  // Values are shown, and typed after Ctrl + click, in the unit with its prefix.
  const PrefixedUnit unit = prefixedUnit(given, parameter.unit);
  double value = given / unit.factor;
  const double low = std::min(range->min, given) / unit.factor,
               high = std::max(range->max, given) / unit.factor;
  const bool is_integer = parameter.type == Parameter::Type::integer;
  // Dear ImGui derives the smallest value of a logarithmic slider from the precision.
  const char* number = is_integer ? "%.0f" : range->is_logarithmic ? "%.12g" : "%.6g";
  const std::string format = number + (unit.unit.empty() ? "" : " " + unit.unit);
  const bool is_changed =
      ImGui::SliderScalar("##value", ImGuiDataType_Double, &value, &low, &high, format.c_str(),
                          range->is_logarithmic ? ImGuiSliderFlags_Logarithmic : 0);
  const bool is_typed = ImGui::GetIO().WantTextInput && !ImGui::IsItemActivated();
  if (is_changed && !is_typed) {
    context_.session.dragValue(parameter.path, numberText(value * unit.factor, kDraggedDigits));
  }
  if (ImGui::IsItemDeactivated()) context_.session.endDrag();
  // A typed number is taken when it is complete: its first digits alone may change the unit.
  const auto typed = takeTyped(parameter.path, is_typed, numberText(value * unit.factor));
  if (typed && *typed != numberText(given)) set(parameter.path, *typed);
}

void ParameterRows::drawChoice(const Parameter& parameter) {
  if (!beginComboOfName("##value", parameter.value.empty() ? "by default" : parameter.value)) return;
  for (const std::string& choice : parameter.choices) {
    pushNameId(choice);
    const bool is_chosen = selectableName(choice, choice == parameter.value);
    ImGui::PopID();
    if (!is_chosen || choice == parameter.value) continue;
    context_.session.perform({"choose", {{"path", parameter.path}, {"value", choice}}});
  }
  ImGui::EndCombo();
}

std::optional<std::string> ParameterRows::drawField(const Parameter& parameter, const std::string& shown,
                                                    const char* hint) {
  std::array<char, 1024> text{};
  std::strncpy(text.data(), shown.c_str(), text.size() - 1);
  Glyphs::ofWindow().need(shown);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::InputTextWithHint("##value", hint, text.data(), text.size());
  drawOverField(shown, at);
  const std::optional<std::string> typed = takeTyped(parameter.path, true, text.data());
  return typed == shown ? std::nullopt : typed;
}

std::optional<std::string> ParameterRows::takeTyped(const std::string& path, bool is_typed,
                                                    const std::string& text) {
  // In the frame of its activation another field may still return its text.
  if (is_typed && ImGui::IsItemActive() && !ImGui::IsItemActivated()) typing_ = {path, text};
  if (!ImGui::IsItemDeactivatedAfterEdit() || typing_.path != path) return std::nullopt;
  const std::string typed = std::exchange(typing_, {}).text;
  if (isKeyPressed(ImGuiKey_Escape)) return std::nullopt;
  return typed;
}

void ParameterRows::drawText(const Parameter& parameter) {
  const std::optional<std::string> typed = drawField(parameter, parameter.value, "by default");
  if (!typed) return;
  const bool is_text = parameter.type == Parameter::Type::text;
  set(parameter.path, typed->empty() ? "null" : is_text ? dumpJson(Json(*typed)) : *typed);
}

/// A number without a unit is in the unit that was shown.
void ParameterRows::drawTypedNumber(const Parameter& parameter) {
  const double value = std::strtod(parameter.value.c_str(), nullptr);
  const std::optional<std::string> typed =
      drawField(parameter, parameter.value.empty() ? "" : quantityText(value, parameter.unit, kTypedDigits),
                "by default");
  if (!typed) return;
  const std::optional<double> number =
      parseQuantity(*typed, parameter.unit, prefixedUnit(value, parameter.unit, kTypedDigits).factor);
  // Any other text is rejected by the scenario's check.
  set(parameter.path, typed->empty() ? "null" : number ? numberText(*number) : *typed);
}

void ParameterRows::drawRejection(const std::string& path) {
  const std::optional<Rejection>& rejection = context_.session.rejection();
  if (!rejection || rejection->edits.empty() || rejection->edits.front().path != path) return;
  ImGui::PushStyleColor(ImGuiCol_Text, errorColor(context_.session.theme()));
  // The row already shows the value's name.
  const std::string location = scenario::toString(rejection->edits.front()) + ": ";
  const bool has_location = rejection->message.compare(0, location.size(), location) == 0;
  ImGui::TextWrapped("%s", rejection->message.c_str() + (has_location ? location.size() : 0));
  ImGui::PopStyleColor();
}

void ParameterRows::set(const std::string& path, const std::string& value) const {
  context_.session.perform({"set", {{"path", path}, {"value", value}}});
}

}  // namespace emscape::view
