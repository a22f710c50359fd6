/// Cutting planes: position and kept side. The map layer.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/view/widgets/slider_field.h"
#include "apps/view/widgets/theme.h"
#include "base/text/display_units.h"

namespace emscape::view {
namespace {

using render::CutPlane;

bool slide(const PanelContext& context, const char* id, double& value, double min, double max,
           NumberForm form) {
  form.min = std::min(min, value);
  form.max = std::max(max, value);
  ImGui::SetNextItemWidth(-1);
  return sliderField(context, id, value, form);
}

/// Lengths of volumes without a position on the earth have no unit.
NumberForm lengthForm(const Session& session, const char* on_earth, const char* elsewhere, double extent_m) {
  if (session.picture()->annotations.georeferenced) {
    const DisplayUnit unit = heightUnit(session.view().units);
    return {on_earth, "m", "", 0, unit.name, unit.factor};
  }
  return {elsewhere, "", "", extent_m > 100 ? 0 : -1};
}

/// @return true if the plane was changed
bool drawHorizontal(const PanelContext& context, CutPlane& plane, const render::SceneBox& box) {
  return slide(context, "##altitude", plane.altitude_m, box.lower_m.z, box.upper_m.z,
               lengthForm(context.session, "altitude ", "z ", box.upper_m.z - box.lower_m.z));
}

bool drawVertical(const PanelContext& context, CutPlane& plane, const render::SceneBox& box) {
  const Vec3d size_m = box.upper_m - box.lower_m;
  const double reach_m = 0.5 * std::hypot(size_m.x, size_m.y);
  const bool turned = slide(context, "##bearing", plane.bearing_deg, 0, 360, {"bearing ", "deg", "", 0});
  const bool moved = slide(context, "##offset", plane.offset_m, -reach_m, reach_m,
                           lengthForm(context.session, "offset ", "offset ", 2 * reach_m));
  const bool cut = ImGui::Checkbox("cuts the ground", &plane.cuts_ground);
  return turned || moved || cut;
}

const char* keptText(const CutPlane& plane) {
  switch (plane.keep) {
    case CutPlane::Side::below:
      return "keeps below";
    case CutPlane::Side::above:
      return "keeps above";
    case CutPlane::Side::left:
      return "keeps left";
    case CutPlane::Side::right:
      break;
  }
  return "keeps right";
}

void drawPlane(PanelContext& context, std::size_t index, const render::SceneBox& box) {
  Session& session = context.session;
  std::vector<CutPlane> planes = session.settings().planes;
  CutPlane& plane = planes[index];
  const auto number = static_cast<double>(index + 1);
  const bool horizontal = plane.kind == CutPlane::Kind::horizontal;
  bool on = plane.on;
  if (ImGui::Checkbox(horizontal ? "horizontal" : "vertical", &on)) {
    session.perform({"plane", {{"index", number}, {"on", on}}});
  }
  ImGui::SameLine();
  if (ImGui::SmallButton(keptText(plane))) session.perform({"plane", {{"index", number}, {"flip", true}}});
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("keeps the other side");
  const float remove_width = ImGui::CalcTextSize("remove").x + 2 * ImGui::GetStyle().FramePadding.x;
  ImGui::SameLine(ImGui::GetContentRegionMax().x - remove_width);
  if (ImGui::SmallButton("remove")) {
    session.perform({"plane", {{"index", number}, {"remove", true}}});
    return;
  }
  if (horizontal ? drawHorizontal(context, plane, box) : drawVertical(context, plane, box)) {
    plane.on = true;
    session.dragPlanes(planes);
  }
}

void drawMapLayer(PanelContext& context, const render::SceneBox& box) {
  Session& session = context.session;
  const render::RenderSettings& settings = session.settings();
  ImGui::TextColored(accentColor(session.theme()), "Map layer");
  bool on = settings.map_height_agl_m.has_value();
  if (ImGui::Checkbox("values painted on the ground", &on)) session.perform({"map_layer", {{"on", on}}});
  if (!settings.map_height_agl_m) return;
  double height_m = *settings.map_height_agl_m, opacity = settings.map_opacity;
  const DisplayUnit height = heightUnit(session.view().units);
  const double reach_m = std::min(render::kMapHeightLimits.max, std::floor(box.upper_m.z - box.lower_m.z));
  if (slide(context, "##map height", height_m, 0, reach_m,
            {"", "m", " above ground", 0, height.name, height.factor}))
    session.perform({"map_layer", {{"height_agl_m", height_m}}});
  if (slide(context, "##map opacity", opacity, 0, 1, {"opacity ", "", "", 2}))
    session.perform({"map_layer", {{"opacity", opacity}}});
}

}  // namespace

void drawPlanesPanel(PanelContext& context) {
  Session& session = context.session;
  ImGui::TextColored(accentColor(session.theme()), "Cutting planes");
  if (!session.picture()) {
    ImGui::TextDisabled("no picture yet");
    return;
  }
  if (!ImGui::IsMouseDown(ImGuiMouseButton_Left)) session.endPlaneDrag();
  const std::size_t count = session.settings().planes.size();
  for (std::size_t index = 0; index < count && index < session.settings().planes.size(); ++index) {
    ImGui::PushID(static_cast<int>(index));
    drawPlane(context, index, session.picture()->box);
    ImGui::PopID();
    ImGui::Spacing();
  }
  ImGui::BeginDisabled(session.settings().planes.size() >= static_cast<std::size_t>(render::kMaxCutPlanes));
  for (const CutPlane::Kind kind : {CutPlane::Kind::horizontal, CutPlane::Kind::vertical}) {
    const bool horizontal = kind == CutPlane::Kind::horizontal;
    if (!horizontal) ImGui::SameLine();
    if (ImGui::Button(horizontal ? "+ horizontal" : "+ vertical")) {
      session.perform({"plane", {{"spec", toString(session.newPlane(kind))}}});
    }
  }
  ImGui::EndDisabled();
  ImGui::Spacing();
  drawMapLayer(context, session.picture()->box);
}

}  // namespace emscape::view
