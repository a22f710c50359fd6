/// The probe: values at a point, with their explanation.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/view/panels/panels.h"
#include "apps/view/values/position_text.h"
#include "apps/view/widgets/names.h"
#include "apps/view/widgets/path_plot.h"
#include "apps/view/widgets/theme.h"
#include "apps/view/widgets/wrapped_text.h"
#include "emfield/link/path_report.h"
#include "emscape/render/annotate/legend.h"

namespace emscape::view {
namespace {

constexpr std::size_t kMaxShown = 40;  // emitters

/// Two columns: a name in a muted colour, and wrapped text.
class Table {
 public:
  Table(const char* id, float name_width, render::Theme theme)
      : open_(ImGui::BeginTable(id, 2)), muted_(mutedColor(theme)) {
    if (!open_) return;
    ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthFixed, name_width);
    ImGui::TableSetupColumn("text", ImGuiTableColumnFlags_WidthStretch);
  }
  ~Table() {
    if (open_) ImGui::EndTable();
  }
  Table(const Table&) = delete;
  Table& operator=(const Table&) = delete;

  void row(const std::string& name, const std::string& text) const {
    if (!open_) return;
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextColored(muted_, "%s", drawable(name).c_str());
    ImGui::TableNextColumn();
    textWrapped(text);
  }

 private:
  bool open_;
  ImVec4 muted_;
};

void drawPlace(const ProbeResult& result, const playback::ViewState& view, float s) {
  const playback::ProbeReading& reading = *result.reading;
  const Table table("place", 96 * s, view.theme);
  if (reading.position) {
    table.row("position", positionText(*reading.position, view));
    table.row("height",
              heightText(*reading.height_msl_m, view) + " above sea level" +
                  (reading.height_agl_m ? ", " + heightText(*reading.height_agl_m, view) + " above ground"
                                        : std::string()));
  } else {
    table.row("position", fmt::format("{:g}, {:g}, {:g}", reading.position_m.x, reading.position_m.y,
                                      reading.position_m.z));
  }
  table.row("time", fmt::format("t = {:g} s", result.time_s));
}

void drawTerms(const emfield::PathBudget& budget, render::Theme theme, float s) {
  if (!ImGui::BeginTable("terms", 2)) return;
  ImGui::TableSetupColumn("term", ImGuiTableColumnFlags_WidthStretch);
  ImGui::TableSetupColumn("value", ImGuiTableColumnFlags_WidthFixed, 104 * s);
  for (const emfield::BudgetTerm& term : budget.terms) {
    const bool is_sum = term.kind == emfield::BudgetTerm::Kind::sum;
    const std::string value =
        emfield::valueText(term.value) +
        (term.unit.empty() || std::isinf(term.value) ? "" : " " + render::unitText(term.unit));
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    textWrapped((is_sum ? "= " : "") + term.label);
    if (!term.note.empty() && ImGui::IsItemHovered())
      ImGui::SetTooltip("%s", drawable(withDegreeSigns(term.note)).c_str());
    ImGui::TableNextColumn();
    const float free = ImGui::GetContentRegionAvail().x - ImGui::CalcTextSize(value.c_str()).x;
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + std::max(free, 0.0F));
    ImGui::TextColored(is_sum ? accentColor(theme) : ImGui::GetStyleColorVec4(ImGuiCol_Text), "%s",
                       value.c_str());
  }
  ImGui::EndTable();
}

void drawObstacles(const emfield::PathBudget& budget, render::Theme theme, float s) {
  if (budget.obstacles.empty()) return;
  const Table table("obstacles", 96 * s, theme);
  for (const emfield::PathObstacle& obstacle : budget.obstacles) {
    const std::string remark = emfield::remarkOf(obstacle);
    table.row(fmt::format("at {:.2f} km", obstacle.range_m / 1000),
              fmt::format("ground at {:.0f} m, clearance {:+.1f} m, {:+.2f} Fresnel radii; alone {:.1f} dB{}",
                          obstacle.ground_msl_m, obstacle.clearance_m, obstacle.clearanceInFresnelRadii(),
                          obstacle.knife_edge_db, remark.empty() ? "" : "; " + remark));
  }
}

void drawPath(PanelContext& context, const emfield::PathBudget& budget) {
  const render::Theme theme = context.session.theme();
  const float s = context.scale;
  textWrapped(withDegreeSigns(budget.verdict));
  drawPathPlot(budget, {ImGui::GetContentRegionAvail().x, 150 * s}, theme, context.session.view().units, s);
  drawTerms(budget, theme, s);
  ImGui::TextDisabled("%s:", toString(budget.model));
  ImGui::SameLine();
  textWrapped(budget.excess.why);
  drawObstacles(budget, theme, s);
  {
    const Table table("geometry", 96 * s, theme);
    for (const emfield::ReportLine& line : emfield::geometryLines(budget))
      table.row(line.name, withDegreeSigns(line.text));
  }
  for (const std::string& warning : budget.warnings) {
    ImGui::TextColored(stateColor(render::ControllerState::busy), "Warning:");
    ImGui::SameLine();
    textWrapped(withDegreeSigns(warning));
  }
  if (ImGui::SmallButton("copy as command")) {
    context.session.perform({"copy_profile", {{"emitter", budget.emitter}}});
  }
  ImGui::Spacing();
}

void drawEmitters(PanelContext& context, const ProbeResult& result) {
  const std::vector<playback::EmitterProbe>& emitters = result.reading->emitters;
  const std::size_t shown = std::min(result.contributions.size(), kMaxShown);
  for (std::size_t i = 0; i < shown; ++i) {
    const Contribution& contribution = result.contributions[i];
    const playback::EmitterProbe& emitter = emitters[contribution.emitter];
    pushNameId(emitter.emitter);
    const bool is_open = headingOfName("emitter", emitter.emitter);
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    const std::string value =
        valueText(contribution.value, contribution.unit, contribution.text, context.session.view());
    const ImVec2 text = ImGui::CalcTextSize(value.c_str());
    const float free = high.x - low.x - ImGui::CalcTextSize(emitter.emitter.c_str()).x - 48 * context.scale;
    if (text.x < free) {
      ImGui::GetWindowDrawList()->AddText(
          {high.x - text.x - 8 * context.scale, (low.y + high.y - text.y) / 2},
          ImGui::ColorConvertFloat4ToU32(accentColor(context.session.theme())), value.c_str());
    } else if (!is_open) {
      textWrapped(value);
    }
    if (is_open && emitter.budget) drawPath(context, *emitter.budget);
    if (is_open && !emitter.budget) textWrapped(emitter.refusal);
    ImGui::PopID();
  }
  if (shown < result.contributions.size()) {
    ImGui::TextDisabled("and %zu that contribute less", result.contributions.size() - shown);
  }
}

void drawReading(PanelContext& context, const ProbeResult& result) {
  const render::Theme theme = context.session.theme();
  const playback::ProbeReading& reading = *result.reading;
  const PointField point = pointFieldOf(result);
  const bool is_value =
      point == PointField::differs ||
      (point == PointField::same && reading.sample.kind == playback::VolumeSample::Kind::value);
  ImGui::SetWindowFontScale(1.25F);
  ImGui::PushStyleColor(ImGuiCol_Text,
                        is_value ? accentColor(theme) : ImGui::GetStyleColorVec4(ImGuiCol_Text));
  const playback::ViewState& view = context.session.view();
  const volume::VolumeInfo& info = context.session.picture()->info();
  const std::string value = valueText(reading, info, view);
  const std::string at_point = [&]() -> std::string {
    if (point == PointField::same) return value;
    if (point == PointField::of_volume_only) return "no field at the point itself";
    const double exact = *pointValueOf(result);
    const std::string unit = info.unit.empty() ? "" : " " + info.unit;
    return valueText(exact, info.unit, fmt::format("{:.4g}{}", exact, unit), view) + " at the point itself";
  }();
  textWrapped(at_point);
  ImGui::PopStyleColor();
  ImGui::SetWindowFontScale(1);
  if (point != PointField::same) {
    ImGui::PushStyleColor(ImGuiCol_Text, stateColor(render::ControllerState::busy));
    textWrapped(value + " in the picture, between voxel centres");
    ImGui::PopStyleColor();
  }
  ImGui::TextDisabled("%s", drawable(render::quantityTitle(result.quantity, info.unit)).c_str());
  drawPlace(result, view, context.scale);
  if (context.session.prober().isLocked()) drawHistory(context);
  if (reading.emitters.empty()) return;
  ImGui::Spacing();
  ImGui::PushStyleColor(ImGuiCol_Text, mutedColor(theme));
  textWrapped(point == PointField::same
                  ? "at the point itself (the value above is that of the volume, between voxel centres)"
                  : "at the point itself");
  ImGui::PopStyleColor();
  drawEmitters(context, result);
}

}  // namespace

void drawProbePanel(PanelContext& context) {
  const Session& session = context.session;
  const Prober& prober = session.prober();
  ImGui::TextColored(accentColor(session.theme()), "Probe");
  ImGui::SameLine();
  if (ImGui::SmallButton(prober.isLocked() ? "unlock (P)" : "lock (P)"))
    perform(context, R"({"do":"lock_probe"})");
  ImGui::SameLine();
  const bool follows = !session.status().failed;
  ImGui::TextDisabled("%s", !follows            ? "of the field before"
                            : prober.isLocked() ? "follows time and edits"
                                                : "under the cursor");
  const ProbeResult* result = prober.result();
  if (result == nullptr) {
    textWrapped("Move the cursor over the picture; Ctrl + click locks the probe at a point.");
  } else if (!result->error.empty()) {
    ImGui::PushStyleColor(ImGuiCol_Text, errorColor(session.theme()));
    textWrapped(result->error);
    ImGui::PopStyleColor();
  } else if (!result->reading) {
    ImGui::TextDisabled("outside the volume");
  } else {
    drawReading(context, *result);
  }
}

void drawProbeMarker(const PanelContext& context, const Area& picture) {
  const Session& session = context.session;
  const std::optional<Vec3d>& point_m = session.prober().locked_m();
  if (!session.picture() || !session.prober().isOn() || !point_m) return;
  const playback::LivePicture& shown = *session.picture();
  const render::Projected pixel = render::project(shown.camera, shown.size, shown.box.toDrawn(*point_m));
  if (!pixel.in_front) return;
  const ImVec2 at{picture.x + static_cast<float>(pixel.x) + 0.5F,
                  picture.y + static_cast<float>(pixel.y) + 0.5F};
  const float s = context.scale;
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.PushClipRect({picture.x, picture.y}, {picture.x + picture.width, picture.y + picture.height});
  const auto cross = [&](ImU32 ink, float width) {
    list.AddCircle(at, 8 * s, ink, 0, width);
    for (const ImVec2& along : {ImVec2(1, 0), ImVec2(-1, 0), ImVec2(0, 1), ImVec2(0, -1)}) {
      list.AddLine({at.x + along.x * 4 * s, at.y + along.y * 4 * s},
                   {at.x + along.x * 14 * s, at.y + along.y * 14 * s}, ink, width);
    }
  };
  cross(IM_COL32(10, 12, 16, 200), 3.5F * s);
  cross(IM_COL32(255, 214, 102, 255), 1.6F * s);
  list.PopClipRect();
}

}  // namespace emscape::view
