/// The result of a measurement.
#include "apps/view/panels/panels.h"
#include "apps/view/values/position_text.h"
#include "apps/view/widgets/glyphs.h"
#include "apps/view/widgets/path_plot.h"
#include "apps/view/widgets/theme.h"
#include "apps/view/widgets/wrapped_text.h"

namespace emscape::view {

void drawMeasurePanel(PanelContext& context) {
  const Session& session = context.session;
  ImGui::TextColored(accentColor(session.theme()), "Measure");
  if (!session.tool().measurement) {
    ImGui::TextDisabled("two clicks: distance, bearing, line of sight");
    return;
  }
  const Measurement& measured = *session.tool().measurement;
  const playback::ViewState& view = session.view();
  ImGui::Text("%s, straight %s", distanceText(measured.distance_m, view).c_str(),
              distanceText(measured.slant_m, view).c_str());
  ImGui::Text("bearing %s, back %s", bearingText(measured.bearing_deg).c_str(),
              bearingText(measured.back_bearing_deg).c_str());
  for (const auto& [name, end] : {std::pair("from", &measured.from), std::pair("to", &measured.to)}) {
    ImGui::TextDisabled("%s", name);
    ImGui::SameLine();
    textWrapped(positionText(end->position, view) + ", " + heightText(end->height_msl_m, view) +
                " above sea level");
  }
  textWrapped(verdictOf(measured, view.units));
  drawPathPlot(measured.path, {ImGui::GetContentRegionAvail().x, 150 * context.scale}, session.theme(),
               view.units, context.scale);
}

}  // namespace emscape::view
