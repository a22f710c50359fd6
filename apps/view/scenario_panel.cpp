/// What if: values of the scenario, changed by the same edits as --set makes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "apps/view/panels.h"
#include "apps/view/theme.h"
#include "emscape/scenario/scenario.h"

namespace emscape::view {
namespace {

/// The name of a list's item as a part of a path.
std::string pathName(const std::string& name) {
  if (name.find_first_of(".\"=\\") == std::string::npos) return name;
  std::string quoted = "\"";
  for (const char c : name) quoted += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  return quoted + "\"";
}

std::string numberText(double value) {
  return fmt::format("{:.10g}", value);
}

/// Rows of a name and a control.
class Form {
 public:
  Form(PanelContext& context, const char* id) : context_(context) {
    open_ = ImGui::BeginTable(id, 2, ImGuiTableFlags_SizingStretchProp);
    if (!open_) return;
    ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthFixed, 112 * context.scale);
    ImGui::TableSetupColumn("value", ImGuiTableColumnFlags_WidthStretch);
  }
  ~Form() {
    if (open_) ImGui::EndTable();
  }
  Form(const Form&) = delete;
  Form& operator=(const Form&) = delete;

  /// A value between limits, dragged; Ctrl + click types it.
  void slider(const char* name, const std::string& path, double value, double min, double max,
              const char* format, bool logarithmic = false) {
    row(name, path);
    const int flags = logarithmic ? ImGuiSliderFlags_Logarithmic : 0;
    const double low = std::min(min, value), high = std::max(max, value);
    if (ImGui::SliderScalar("##value", ImGuiDataType_Double, &value, &low, &high, format, flags)) {
      context_.session.dragValue(path, numberText(value));
    }
    end();
  }
  /// A value that is typed.
  void number(const char* name, const std::string& path, double value, double unit, const char* format) {
    row(name, path);
    double shown = value / unit;
    ImGui::InputDouble("##value", &shown, 0, 0, format);
    if (ImGui::IsItemDeactivatedAfterEdit() && shown * unit != value) change(path, numberText(shown * unit));
    end();
  }
  void choice(const char* name, const std::string& path, const char* value,
              const std::vector<const char*>& values) {
    row(name, path);
    if (ImGui::BeginCombo("##value", value)) {
      for (const char* one : values) {
        if (ImGui::Selectable(one, std::string(one) == value)) change(path, one);
      }
      ImGui::EndCombo();
    }
    end();
  }
  /// @return whether it was switched
  bool check(const char* name, const std::string& path, bool on) {
    row(name, path);
    const bool switched = ImGui::Checkbox("##value", &on);
    end();
    return switched;
  }
  void change(const std::string& path, const std::string& value) {
    context_.session.perform({"set", {{"path", path}, {"value", value}}});
  }

 private:
  void row(const char* name, const std::string& path) {
    ImGui::PushID(path.c_str());
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(name);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("--set '%s=…'", path.c_str());
    ImGui::TableNextColumn();
    ImGui::SetNextItemWidth(-1);
  }
  void end() {
    if (ImGui::IsItemDeactivated()) context_.session.endDrag();
    ImGui::PopID();
  }

  PanelContext& context_;
  bool open_ = false;
};

bool transmitsAtAll(const scenario::Emitter& emitter, double duration_s) {
  return emitter.active_s.empty() ||
         std::any_of(emitter.active_s.begin(), emitter.active_s.end(),
                     [&](const scenario::TimeInterval& interval) { return interval.begin_s <= duration_s; });
}

void drawEmitter(PanelContext& context, const scenario::Scenario& scenario,
                 const scenario::Emitter& emitter) {
  const std::string path = "emitters." + pathName(emitter.name) + ".";
  Form form(context, emitter.name.c_str());
  const bool on = transmitsAtAll(emitter, scenario.clock.duration_s);
  if (form.check("transmits", path + "active_s", on)) {
    // Off: a second that no step reaches.
    const double never_s = scenario.clock.duration_s + scenario.clock.step_s + 1;
    form.change(path + "active_s", on ? fmt::format("[[{:g}, {:g}]]", never_s, never_s + 1) : "null");
  }
  form.slider("power", path + "power_w", emitter.power_w, 1e-2, 1e7, "%.6g W", true);
  form.number("frequency, MHz", path + "frequency_hz", emitter.frequency_hz, 1e6, "%.6g");
  form.slider("losses", path + "losses_db", emitter.losses_db, 0, 30, "%.1f dB");
  if (emitter.scan.kind == scenario::ScanKind::rotate) {
    form.slider("rotation", path + "scan.rate_rpm", emitter.scan.rate_rpm, -60, 60, "%.1f rpm");
  }
  if (emitter.scan.kind == scenario::ScanKind::fixed || emitter.scan.kind == scenario::ScanKind::sector) {
    form.slider("azimuth", path + "scan.azimuth_deg", emitter.scan.azimuth_deg, 0, 360, "%.1f°");
  }
  if (emitter.scan.kind != scenario::ScanKind::dwell_list) {
    form.slider("elevation", path + "scan.elevation_deg", emitter.scan.elevation_deg, -10, 60, "%.1f°");
  }
  form.choice("propagation", path + "propagation", scenario::toString(emitter.propagation),
              {"free_space", "horizon", "diffraction", "two_ray", "itm", "p528"});
  if (emitter.kind == scenario::EmitterKind::radar) {
    form.slider("target", path + "receiver.target_rcs_m2", emitter.receiver.target_rcs_m2, 1e-3, 1e3,
                "%.3g m²", true);
  }
}

void drawPlatform(PanelContext& context, const scenario::Platform& platform) {
  const std::string path = "platforms." + pathName(platform.name) + ".position.";
  if (!platform.track_file.empty() || platform.track.size() != 1) {
    ImGui::TextDisabled("moves: %s", platform.track_file.c_str());
    return;
  }
  const scenario::SitePosition& position = platform.track.front().position;
  Form form(context, platform.name.c_str());
  if (position.height_agl_m) {
    form.slider("above ground", path + "height_agl_m", *position.height_agl_m, 0, 3000, "%.1f m", true);
  }
  if (position.height_msl_m) {
    form.slider("above sea", path + "height_msl_m", *position.height_msl_m, 0, 12000, "%.1f m");
  }
  if (position.height_ellipsoid_m) {
    form.slider("above ellipsoid", path + "height_ellipsoid_m", *position.height_ellipsoid_m, 0, 12000,
                "%.1f m");
  }
  form.number("latitude", path + "latitude_deg", position.latitude_deg, 1, "%.6f");
  form.number("longitude", path + "longitude_deg", position.longitude_deg, 1, "%.6f");
}

void drawAir(PanelContext& context, const scenario::Atmosphere& atmosphere) {
  Form form(context, "air");
  form.slider("k factor", "atmosphere.k_factor", atmosphere.k_factor, 0.5, 4, "%.3f");
  form.slider("rain", "atmosphere.rain_mm_h", atmosphere.rain_mm_h, 0, 100, "%.1f mm/h");
  form.slider("temperature", "atmosphere.temperature_k", atmosphere.temperature_k, 230, 320, "%.1f K");
  form.slider("vapour", "atmosphere.vapour_g_m3", atmosphere.vapour_g_m3, 0, 30, "%.1f g/m³");
}

/// A heading that folds, with a dot of the kind's colour.
bool section(const std::string& name, const char* group, std::optional<ImVec4> dot, bool open, float scale) {
  ImGui::PushID(group);
  const bool is_open = ImGui::TreeNodeEx(
      name.c_str(), ImGuiTreeNodeFlags_Framed | ImGuiTreeNodeFlags_SpanAvailWidth |
                        (open ? ImGuiTreeNodeFlags_DefaultOpen : 0) | ImGuiTreeNodeFlags_NoTreePushOnOpen);
  if (dot) {
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    ImGui::GetWindowDrawList()->AddCircleFilled({high.x - 14 * scale, (low.y + high.y) / 2}, 4.5F * scale,
                                                ImGui::ColorConvertFloat4ToU32(*dot));
  }
  ImGui::PopID();
  return is_open;
}

}  // namespace

void drawScenarioPanel(PanelContext& context) {
  Session& session = context.session;
  const std::shared_ptr<const scenario::Scenario> scenario = session.scenario();
  const float s = context.scale;
  ImGui::TextColored(accentColor(session.theme()), "What if");
  if (!scenario) {
    ImGui::TextDisabled("volumes: there is no scenario to change");
    return;
  }
  const auto button = [&](const char* name, const char* command, bool enabled, const char* tip) {
    ImGui::BeginDisabled(!enabled);
    if (ImGui::SmallButton(name)) perform(context, command);
    ImGui::EndDisabled();
    if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) ImGui::SetTooltip("%s", tip);
  };
  ImGui::SameLine(0, 16 * s);
  button("undo", R"({"do":"undo"})", session.canUndo(), "Ctrl+Z");
  ImGui::SameLine();
  button("redo", R"({"do":"redo"})", session.canRedo(), "Ctrl+Shift+Z");
  ImGui::SameLine();
  button("copy as command", R"({"do":"copy_command"})", true, "Ctrl+Shift+C");
  const std::size_t edits = scenario->edits().size();
  if (edits > 0) {
    ImGui::TextDisabled("%zu value%s changed", edits, edits == 1 ? "" : "s");
  }
  ImGui::Spacing();
  bool is_first = true;
  for (const scenario::Emitter& emitter : scenario->emitters) {
    if (section(emitter.name, "emitter", emitterColor(emitter.kind, session.theme()), is_first, s)) {
      drawEmitter(context, *scenario, emitter);
    }
    is_first = false;
  }
  ImGui::Spacing();
  for (const scenario::Platform& platform : scenario->platforms) {
    if (section(platform.name, "platform", std::nullopt, false, s)) drawPlatform(context, platform);
  }
  ImGui::Spacing();
  if (section("Air", "air", std::nullopt, false, s)) drawAir(context, scenario->atmosphere);
}

}  // namespace emscape::view
