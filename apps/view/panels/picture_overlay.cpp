#include "apps/view/panels/picture_overlay.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "apps/view/session/plane_drag.h"
#include "apps/view/values/position_text.h"
#include "apps/view/widgets/glyphs.h"
#include "apps/view/widgets/theme.h"
#include "emscape/render/annotate/legend.h"
#include "playback/view/view_settings.h"

namespace emscape::view {
namespace {

const ImU32 kRim = IM_COL32(10, 12, 16, 190);

/// Draws at positions of the picture, with a dark rim.
class Overlay {
 public:
  Overlay(const PanelContext& context, const Area& area)
      : shown_(*context.session.picture()),
        area_(area),
        scale_(context.scale),
        ink_(inkOf(accentColor(context.session.theme()))),
        list_(*ImGui::GetBackgroundDrawList()) {
    list_.PushClipRect({area.x, area.y}, {area.x + area.width, area.y + area.height});
  }
  ~Overlay() { list_.PopClipRect(); }
  Overlay(const Overlay&) = delete;
  Overlay& operator=(const Overlay&) = delete;

  std::optional<ImVec2> at(const Vec3d& frame_m) const {
    const render::Projected pixel = render::project(shown_.camera, shown_.size, shown_.box.toDrawn(frame_m));
    return pixel.in_front ? std::optional(at(pixel)) : std::nullopt;
  }
  ImVec2 at(const render::Projected& pixel) const {
    return {area_.x + static_cast<float>(pixel.x) + 0.5F, area_.y + static_cast<float>(pixel.y) + 0.5F};
  }

  /// A ring with gaps at the corners of a square.
  void selection(const ImVec2& center) {
    constexpr float kQuarter = 1.5707963F, kGap = 0.32F;
    for (const auto& [ink, width] : {std::pair(kRim, 5.0F), std::pair(ink_, 2.4F)}) {
      for (int quarter = 0; quarter < 4; ++quarter) {
        const float begin = (static_cast<float>(quarter) + 0.5F) * kQuarter + kGap;
        list_.PathArcTo(center, 16 * scale_, begin, begin + kQuarter - 2 * kGap, 12);
        list_.PathStroke(ink, 0, width * scale_);
      }
    }
  }

  void handle(const ImVec2& center) {
    list_.AddCircleFilled(center, 8 * scale_, kRim);
    list_.AddCircleFilled(center, 5.5F * scale_, ink_);
    list_.AddCircle(center, 8 * scale_, IM_COL32(255, 255, 255, 220), 0, 1.4F * scale_);
  }

  void point(const ImVec2& center) {
    list_.AddCircleFilled(center, 6 * scale_, kRim);
    list_.AddCircleFilled(center, 4 * scale_, kInk);
  }

  void line(const ImVec2& from, const ImVec2& to) {
    list_.AddLine(from, to, kRim, 5 * scale_);
    list_.AddLine(from, to, kInk, 2 * scale_);
  }

  void text(const ImVec2& center, const std::string& words) {
    const ImVec2 size = ImGui::CalcTextSize(words.c_str());
    const ImVec2 corner{center.x - size.x / 2, center.y - size.y / 2};
    const float padding = 4 * scale_;
    list_.AddRectFilled({corner.x - padding, corner.y - padding / 2},
                        {corner.x + size.x + padding, corner.y + size.y + padding / 2}, kRim, 3 * scale_);
    list_.AddText(corner, IM_COL32_WHITE, words.c_str());
  }

 private:
  static constexpr ImU32 kInk = IM_COL32(255, 214, 102, 255);

  const playback::LivePicture& shown_;
  const Area& area_;
  const float scale_;
  const ImU32 ink_;
  ImDrawList& list_;
};

/// The points of a tool, joined, up to the cursor; a measurement is labelled.
void drawTool(Overlay& overlay, const Session& session) {
  const PickTool& tool = session.tool();
  std::vector<ImVec2> points;
  for (const ToolPoint& point : tool.points) {
    if (const auto at = overlay.at(point.position_m)) points.push_back(*at);
  }
  const ProbeResult* const under = session.cursor().isOver() ? session.cursor().result() : nullptr;
  const bool is_complete = tool.measurement.has_value();
  if (!is_complete && !points.empty() && under != nullptr && under->reading) {
    if (const auto at = overlay.at(under->reading->position_m)) overlay.line(points.back(), *at);
  }
  for (std::size_t i = 0; i + 1 < points.size(); ++i) overlay.line(points[i], points[i + 1]);
  for (const ImVec2& point : points) overlay.point(point);
  if (!is_complete || points.size() != 2) return;
  const Measurement& measured = *tool.measurement;
  const ImVec2 middle{(points[0].x + points[1].x) / 2, (points[0].y + points[1].y) / 2};
  overlay.text(middle, distanceText(measured.distance_m, session.view()) + "  " +
                           bearingText(measured.bearing_deg) + (measured.is_blocked ? "  not in sight" : ""));
}

/// An entry that runs a command.
void entry(PanelContext& context, const char* label, const Command& command) {
  if (ImGui::MenuItem(label)) context.session.perform(command);
}

/// Null if the scenario has no emitter of that name.
const scenario::Emitter* emitterOf(const Session& session, const std::string& name) {
  const playback::ScenarioPtr scenario = session.scenario();
  if (!scenario) return nullptr;
  const auto found = std::find_if(scenario->emitters.begin(), scenario->emitters.end(),
                                  [&](const scenario::Emitter& emitter) { return emitter.name == name; });
  return found == scenario->emitters.end() ? nullptr : &*found;
}

/// Shows or hides the range rings of an emitter, whose setting is a list of texts EMITTER:KEY=VALUE,...
void ringsEntry(PanelContext& context, const std::string& emitter) {
  const playback::ViewSetting* const setting = playback::settingOfVerb("range_rings");
  if (setting == nullptr || !setting->isListOfTexts()) return;
  auto rings = std::get<std::vector<std::string>>(setting->get(context.session.view()));
  const auto isOfEmitter = [&](const std::string& text) {
    return text.compare(0, emitter.size() + 1, emitter + ":") == 0;
  };
  const auto end = std::remove_if(rings.begin(), rings.end(), isOfEmitter);
  const bool has_rings = end != rings.end();
  rings.erase(end, rings.end());
  if (!ImGui::MenuItem("Range rings", nullptr, has_rings)) return;
  if (!has_rings) {
    const render::SceneBox& box = context.session.picture()->box;
    const std::vector<double> radii_m = render::roundTicks(0, 0.5 * (box.upper_m.x - box.lower_m.x), 3);
    rings.push_back(
        fmt::format("{}:spacing_m={:g},count=3", emitter, radii_m.size() > 1 ? radii_m[1] : 1000));
  }
  context.session.perform({"range_rings", {{setting->argument, rings}}});
}

void drawMenuOfObject(PanelContext& context, const SceneObject& object) {
  Session& session = context.session;
  const bool is_emitter = object.path.compare(0, 9, "emitters.") == 0;
  ImGui::TextColored(accentColor(session.theme()), "%s", drawable(object.name).c_str());
  ImGui::SameLine();
  ImGui::TextDisabled("%s", drawable(object.kind).c_str());
  ImGui::Separator();
  const scenario::Emitter* const emitter = is_emitter ? emitterOf(session, object.name) : nullptr;
  if (emitter != nullptr) {
    entry(context, emitter->enabled ? "Switch off" : "Switch on",
          {"enable", {{"emitter", object.name}, {"on", !emitter->enabled}}});
  }
  entry(context, "Look at it", {"focus", {{"path", object.path}}});
  const playback::ScenarioPtr scenario = session.scenario();
  const auto platform = static_cast<std::size_t>(object.platform);
  const bool has_platform = scenario && platform < scenario->platforms.size();
  if (has_platform)
    entry(context, "Follow", {"follow", {{"name", scenario->platforms[platform].name}, {"mode", "follow"}}});
  entry(context, "Probe from here",
        {"probe",
         {{"latitude_deg", object.position.latitude_deg},
          {"longitude_deg", object.position.longitude_deg},
          {"height_msl_m", object.height_msl_m}}});
  if (is_emitter) ringsEntry(context, object.name);
  entry(context, "Copy the position", {"copy_position", {{"path", object.path}}});
  ImGui::Separator();
  if (has_platform)
    entry(context, "Draw a track", {"draw_track", {{"platform", scenario->platforms[platform].name}}});
  entry(context, "Duplicate", {"duplicate", {{"path", object.path}}});
  entry(context, "Delete", {"remove", {{"path", object.path}}});
  bool has_heading = false;
  for (const SceneObject& other : session.objects()) {
    if (other.platform != object.platform || other.path == object.path) continue;
    if (!std::exchange(has_heading, true)) ImGui::Separator();
    const std::string label = "Select " + other.kind + " " + drawable(other.name) + "###" + other.path;
    if (ImGui::MenuItem(label.c_str())) session.perform({"select", {{"path", other.path}}});
  }
}

void drawMenuOfGround(PanelContext& context, const ContextMenu& menu) {
  const Json pixel{{"x", menu.x}, {"y", menu.y}};
  entry(context, "Look here", {"focus", pixel});
  entry(context, "Probe here", {"probe", pixel});
  entry(context, "Measure from here", {"measure", pixel});
  entry(context, "Copy the position", {"copy_position", pixel});
  const auto ground_m = context.session.groundAt(menu.x, menu.y);
  if (!context.session.scenario() || !ground_m) return;
  ImGui::Separator();
  const GeodeticPosition position = GeoFrame(context.session.picture()->grid().frame).toGeodetic(*ground_m);
  for (const char* what : {"radar", "transmitter", "jammer", "platform", "receiver", "target"}) {
    entry(context, fmt::format("Add a {} here", what).c_str(),
          {"add",
           {{"what", what},
            {"latitude_deg", position.latitude_deg},
            {"longitude_deg", position.longitude_deg}}});
  }
}

}  // namespace

std::string tooltipOf(const SceneObject& object, const playback::ViewState& view) {
  std::string text = drawable(object.name) + "\n" + object.kind;
  if (!object.details.empty()) text += ", " + drawable(object.details);
  text += "\n" + positionText(object.position, view) + "\n" + heightText(object.height_msl_m, view) +
          " above sea level";
  if (object.height_agl_m) text += ", " + heightText(*object.height_agl_m, view) + " above ground";
  return text;
}

void drawPictureOverlay(const PanelContext& context, const Area& picture) {
  const Session& session = context.session;
  if (!session.picture() || session.panels.hidden) return;
  Overlay overlay(context, picture);
  for (const render::CutPlane& plane : session.settings().planes) {
    if (const auto pixel = planeHandle(*session.picture(), plane)) overlay.handle(overlay.at(*pixel));
  }
  if (const SceneObject* object = session.objectOf(session.selected())) {
    if (object->pixel && object->present)
      overlay.selection(overlay.at(render::Projected{object->pixel->x, object->pixel->y}));
  }
  drawTool(overlay, session);
}

void drawToolHint(PanelContext& context, const Area& picture) {
  const PickTool& tool = context.session.tool();
  if (!tool.isOn() || context.session.panels.hidden) return;
  const float s = context.scale;
  ImGui::SetNextWindowPos({picture.x + picture.width / 2, picture.y + 62 * s}, ImGuiCond_Always, {0.5F, 0});
  ImGui::SetNextWindowBgAlpha(0.94F);
  ImGui::Begin("tool", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                   ImGuiWindowFlags_NoNav);
  switch (tool.kind) {
    case PickTool::Kind::none:
      break;
    case PickTool::Kind::measure:
      ImGui::TextUnformatted(tool.measurement          ? "Measured; the next click begins anew"
                             : tool.points.size() == 1 ? "Measure: click the second point"
                                                       : "Measure: click the first point");
      break;
    case PickTool::Kind::track:
      ImGui::Text("Track of %s: click its points; a double click ends it", drawable(tool.subject).c_str());
      ImGui::SameLine();
      if (ImGui::SmallButton("Finish")) context.session.perform({"draw_track"});
      break;
    case PickTool::Kind::place:
      ImGui::Text("Click the place of the new %s", drawable(tool.subject).c_str());
      break;
  }
  ImGui::SameLine();
  if (ImGui::SmallButton("Cancel (Esc)")) perform(context, R"({"do":"back"})");
  ImGui::End();
}

void drawContextMenu(PanelContext& context, const Area& picture, ContextMenu& menu) {
  Session& session = context.session;
  if (!session.picture()) return;
  if (std::exchange(session.panels.menu, false)) {  // by its key: at the selection
    const SceneObject* const object = session.objectOf(session.selected());
    menu = {true, 0.5 * session.picture()->size.width, 0.5 * session.picture()->size.height, ""};
    if (object != nullptr && object->pixel) menu = {true, object->pixel->x, object->pixel->y, object->path};
  }
  if (std::exchange(menu.opens, false)) {
    ImGui::SetNextWindowPos({picture.x + static_cast<float>(menu.x), picture.y + static_cast<float>(menu.y)});
    ImGui::OpenPopup("menu of the picture");
  }
  if (!ImGui::BeginPopup("menu of the picture")) return;
  if (menu.path.empty()) {
    drawMenuOfGround(context, menu);
  } else if (const SceneObject* found = session.objectOf(menu.path)) {
    const SceneObject object = *found;  // an entry may change the objects
    drawMenuOfObject(context, object);
  } else {
    ImGui::CloseCurrentPopup();
  }
  ImGui::EndPopup();
}

std::vector<std::string> cursorTexts(const Session& session) {
  const ProbeResult* const result =
      session.picture() && session.cursor().isOver() ? session.cursor().result() : nullptr;
  if (result == nullptr || !result->reading) return {};
  const playback::ProbeReading& reading = *result->reading;
  const playback::ViewState& view = session.view();
  const std::string value = valueText(reading, session.picture()->info(), view);
  if (!reading.position) {
    return {fmt::format("{:g}, {:g}, {:g}   ·   {}", reading.position_m.x, reading.position_m.y,
                        reading.position_m.z, value),
            value};
  }
  const std::string position = positionText(*reading.position, view);
  const std::string at_height = "at " + heightText(*reading.height_msl_m, view) + ": " + value;
  std::vector<std::string> texts{position + "   ·   " + at_height, at_height};
  if (reading.height_agl_m) {
    const std::string ground = heightText(*reading.height_msl_m - *reading.height_agl_m, view);
    texts.insert(texts.begin(), position + "   ground " + ground + "   ·   " + at_height);
  }
  return texts;
}

}  // namespace emscape::view
