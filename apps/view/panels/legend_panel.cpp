/// The list of quantities at the heading of the picture's legend.
#include "apps/view/panels/panels.h"
#include "apps/view/widgets/theme.h"
#include "emscape/render/annotate/overlay.h"

namespace emscape::view {

void drawLegendMenu(PanelContext& context, const Area& picture) {
  Session& session = context.session;
  if (!session.picture() || !session.picture()->annotations.legend) return;
  const std::vector<ShownQuantity>& quantities = session.quantities();
  if (quantities.size() < 2) return;
  const float s = context.scale;
  const render::PixelArea heading =
      render::legendHeading(session.picture()->size, session.picture()->annotations);
  const auto at = [&](double x, double y) {
    return ImVec2(picture.x + static_cast<float>(x), picture.y + static_cast<float>(y));
  };
  const ImVec2 from = at(heading.x, heading.y),
               to = at(heading.x + heading.width, heading.y + heading.height);
  const float margin = 4 * s, arrow = 5 * s;
  ImGui::SetNextWindowPos({from.x - margin, from.y - margin});
  ImGui::SetNextWindowSize({to.x - from.x + 3 * margin + 2 * arrow, to.y - from.y + 2 * margin});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1, 1));
  ImGui::Begin("legend", nullptr, kFixedPanel | ImGuiWindowFlags_NoScrollbar);
  ImGui::PopStyleVar(2);
  if (ImGui::InvisibleButton("quantity", ImGui::GetWindowSize())) ImGui::OpenPopup("quantities");
  const bool is_open = ImGui::IsPopupOpen("quantities");
  if (ImGui::IsItemHovered() && !is_open) ImGui::SetTooltip("Chooses the quantity");
  ImDrawList& list = *ImGui::GetWindowDrawList();
  if (ImGui::IsItemHovered() || is_open) {
    list.AddRect(ImGui::GetItemRectMin(), ImGui::GetItemRectMax(),
                 ImGui::ColorConvertFloat4ToU32(accentColor(session.theme())), 4 * s);
  }
  const ImVec2 tip{to.x + margin + arrow, to.y - 2.5F * arrow};  // beside the text
  list.AddTriangleFilled({tip.x - arrow, tip.y}, {tip.x + arrow, tip.y}, {tip.x, tip.y + arrow},
                         ImGui::ColorConvertFloat4ToU32(accentColor(session.theme())));
  ImGui::SetNextWindowPos({to.x + margin, to.y + margin}, ImGuiCond_Appearing, {1, 0});
  if (ImGui::BeginPopup("quantities")) {
    drawQuantityList(context, quantities);
    ImGui::EndPopup();
  }
  ImGui::End();
}

}  // namespace emscape::view
