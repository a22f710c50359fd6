#include "apps/view/widgets/path_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/view/widgets/theme.h"
#include "base/text/display_units.h"
#include "emfield/link/path_report.h"
#include "emscape/base/units.h"
#include "emscape/render/annotate/legend.h"

namespace emscape::view {
namespace {

ImU32 color(unsigned hex, float alpha = 1) {
  return ImGui::ColorConvertFloat4ToU32({static_cast<float>(hex >> 16 & 0xFF) / 255,
                                         static_cast<float>(hex >> 8 & 0xFF) / 255,
                                         static_cast<float>(hex & 0xFF) / 255, alpha});
}

/// Heights are drawn over the effective earth, so that the ray is straight and sea level curves.
class PathPlot {
 public:
  PathPlot(const emfield::PathBudget& budget, const ImVec2& corner, const ImVec2& size, render::Theme theme,
           Units units, float scale)
      : budget_(budget),
        profile_(budget.profile),
        height_unit_(heightUnit(units)),
        distance_unit_(distanceUnit(units)),
        is_dark_(theme == render::Theme::dark),
        text_(ImGui::ColorConvertFloat4ToU32(mutedColor(theme))),
        scale_(scale),
        left_(corner.x + ImGui::CalcTextSize("00000").x + 6 * scale),
        top_(corner.y + 4 * scale),
        right_(corner.x + size.x - 4 * scale),
        bottom_(corner.y + size.y - ImGui::GetTextLineHeight() - 4 * scale) {
    setHeights();
  }

  void draw() {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled({left_, top_}, {right_, bottom_}, is_dark_ ? color(0x222B37) : color(0xECF3FA));
    list.PushClipRect({left_, top_}, {right_, bottom_}, true);
    const ImDrawListFlags flags = list.Flags;
    list.Flags &= ~ImDrawListFlags_AntiAliasedFill;  // no seams between quads
    drawZone(list);
    drawGround(list);
    list.Flags = flags;
    drawLines(list);
    list.PopClipRect();
    drawAxes(list);
  }

 private:
  double zone_m(int post) const { return profile_.fresnelRadius_m(post, wavelength_m(budget_.frequency_hz)); }
  double ground_m(int post) const {
    return static_cast<double>(profile_.ground_msl_m[static_cast<std::size_t>(post)]);
  }
  double ray_m(int post) const { return profile_.ray_msl_m[static_cast<std::size_t>(post)]; }

  void setHeights() {
    double lowest = HUGE_VAL, highest = -HUGE_VAL;
    for (int i = 0; i < profile_.count(); ++i) {
      const double bulge_m = profile_.bulge_m(i);
      lowest = std::min({lowest, ground_m(i) + bulge_m, ray_m(i) - zone_m(i) + bulge_m});
      highest = std::max({highest, profile_.topMsl_m(i) + bulge_m, ray_m(i) + zone_m(i) + bulge_m});
    }
    const double span = std::max(highest - lowest, 10.0);
    low_m_ = lowest - 0.08 * span;
    high_m_ = highest + 0.08 * span;
  }

  float x(double range_m) const {
    return left_ + (right_ - left_) * static_cast<float>(range_m / profile_.range_m);
  }
  float y(double height_m) const {
    return top_ + (bottom_ - top_) * static_cast<float>((high_m_ - height_m) / (high_m_ - low_m_));
  }
  ImVec2 at(int post, double height_msl_m) const {
    return {x(profile_.ranges_m[static_cast<std::size_t>(post)]), y(height_msl_m + profile_.bulge_m(post))};
  }

  void drawZone(ImDrawList& list) const {
    for (int i = 0; i + 1 < profile_.count(); ++i) {
      list.AddQuadFilled(at(i, ray_m(i) + zone_m(i)), at(i + 1, ray_m(i + 1) + zone_m(i + 1)),
                         at(i + 1, ray_m(i + 1) - zone_m(i + 1)), at(i, ray_m(i) - zone_m(i)),
                         color(0xF5B73A, 0.38F));
    }
  }

  void drawGround(ImDrawList& list) const {
    const auto drawBody = [&](ImU32 ink, auto heightOf) {
      for (int i = 0; i + 1 < profile_.count(); ++i) {
        const ImVec2 a = at(i, heightOf(i)), b = at(i + 1, heightOf(i + 1));
        list.AddQuadFilled(a, b, {b.x, bottom_}, {a.x, bottom_}, ink);
      }
    };
    if (!profile_.cover_m.empty())
      drawBody(is_dark_ ? color(0x4F7A4A) : color(0x4A8545), [&](int i) { return profile_.topMsl_m(i); });
    drawBody(is_dark_ ? color(0x7D7058) : color(0x9E8F73), [&](int i) { return ground_m(i); });
  }

  void drawLines(ImDrawList& list) const {
    const int last = profile_.count() - 1;
    const ImU32 ray = emfield::isBlocked(budget_) ? (is_dark_ ? color(0xFF8C7A) : color(0xC21E21))
                                                  : (is_dark_ ? color(0x7FD8A6) : color(0x0F7540));
    list.AddLine(at(0, profile_.begin.height_msl_m), at(last, profile_.end.height_msl_m), ray, 1.8F * scale_);
    const ImU32 mast = is_dark_ ? color(0xE8ECF1) : color(0x1A294D);
    list.AddLine(at(0, ground_m(0)), at(0, profile_.begin.height_msl_m), mast, 2 * scale_);
    list.AddCircleFilled(at(0, profile_.begin.height_msl_m), 3.5F * scale_, mast);
    list.AddLine(at(last, ground_m(last)), at(last, profile_.end.height_msl_m), mast, scale_);
    list.AddCircleFilled(at(last, profile_.end.height_msl_m), 3.5F * scale_, mast);
    for (const emfield::PathObstacle& obstacle : budget_.obstacles) {
      const ImVec2 top = at(obstacle.post, profile_.topMsl_m(obstacle.post));
      list.AddLine(top, at(obstacle.post, ray_m(obstacle.post)), ray, (obstacle.decides ? 1.6F : 1) * scale_);
      list.AddCircleFilled(top, (obstacle.decides ? 4 : 2.5F) * scale_, ray);
    }
  }

  void drawAxes(ImDrawList& list) const {
    const float line = ImGui::GetTextLineHeight();
    const std::vector<double> heights =
        render::roundTicks(low_m_ / height_unit_.factor, high_m_ / height_unit_.factor, 4);
    const double height_step = heights.size() > 1 ? heights[1] - heights[0] : 1;
    for (const double height : heights) {
      const std::string text = render::tickText(height, height_step);
      const float at_y =
          std::clamp(y(height * height_unit_.factor) - line / 2, top_ - 4 * scale_, bottom_ - line);
      list.AddText({left_ - 4 * scale_ - ImGui::CalcTextSize(text.c_str()).x, at_y}, text_, text.c_str());
    }
    const std::vector<double> ranges = render::roundTicks(0, profile_.range_m / distance_unit_.factor, 5);
    const double range_step = ranges.size() > 1 ? ranges[1] - ranges[0] : 1;
    for (const double range : ranges) {
      std::string text = render::tickText(range, range_step);
      if (range == ranges.back()) text += std::string(" ") + distance_unit_.name;
      const float width = ImGui::CalcTextSize(text.c_str()).x;
      const float at_x = std::clamp(x(range * distance_unit_.factor) - width / 2, left_, right_ - width);
      list.AddText({at_x, bottom_ + 2 * scale_}, text_, text.c_str());
    }
  }

  const emfield::PathBudget& budget_;
  const emfield::PathProfile& profile_;
  DisplayUnit height_unit_, distance_unit_;
  bool is_dark_;
  ImU32 text_;
  float scale_;
  float left_, top_, right_, bottom_;
  double low_m_ = 0, high_m_ = 1;  // over the chord between the ends' sea levels
};

}  // namespace

void drawPathPlot(const emfield::PathBudget& budget, const ImVec2& size, render::Theme theme, Units units,
                  float scale) {
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImGui::Dummy(size);
  if (budget.profile.count() < 2 || !ImGui::IsItemVisible()) return;
  PathPlot(budget, corner, size, theme, units, scale).draw();
}

}  // namespace emscape::view
