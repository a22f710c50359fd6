/// Verbs of the window.
#include <fmt/format.h>

#include "apps/view/session/file_endings.h"
#include "apps/view/session/session.h"
#include "emscape/base/error.h"

namespace emscape::view {
namespace {

std::string allPanels() {
  std::string names;
  for (const PanelName& panel : panelNames()) names += (names.empty() ? "" : ", ") + std::string(panel.name);
  return names;
}

}  // namespace

const std::vector<PanelName>& panelNames() {
  static const std::vector<PanelName> all{
      {"scenario", &Panels::scenario, true}, {"colors", &Panels::colors, true},
      {"planes", &Panels::planes, true},     {"probe", &Panels::probe, true},
      {"timeline", &Panels::timeline, true}, {"help", &Panels::help, false},
      {"time", &Panels::time, false},        {"open", &Panels::open, false},
      {"record", &Panels::record, false},    {"restore", &Panels::restore, false},
      {"unsaved", &Panels::unsaved, false},  {"changed", &Panels::changed, false},
  };
  return all;
}

std::vector<Verb> Session::windowVerbs() {
  return {
      {"panel",
       {{"name", kText}, {"open", kBoolean, false}},
       "Opens or closes a panel: scenario, colors, planes, probe, timeline, help, time, open, record, "
       "restore, unsaved, changed, all",
       [](Session& session, const Command& command) {
         const std::string name = command.text("name");
         if (name == "all") {
           session.panels.hidden = !command.boolean("open", session.panels.hidden);
           return;
         }
         for (const PanelName& panel : panelNames()) {
           if (name != panel.name) continue;
           bool& open = session.panels.*panel.open;
           open = command.boolean("open", session.panels.hidden || !open);
           if (open) session.panels.hidden = false;
           return;
         }
         throw Error(ErrorCode::bad_input, fmt::format("panel '{}': expected {} or all", name, allPanels()));
       }},
      {"scale",
       {{"factor", kNumber, false}, {"change", kNumber, false}},
       "Size of texts and controls, 0.5..4",
       [](Session& session, const Command& command) {
         constexpr double kStep = 1.125;
         const double change = command.number("change") < 0 ? 1 / kStep : kStep;
         session.window_.setScale(command.has("factor") ? command.number("factor")
                                                        : session.window_.scale() * change);
       }},
      {"resize",
       {{"width"}, {"height"}},
       "Size of the window in pixels",
       [](Session& session, const Command& command) {
         const double width = command.number("width"), height = command.number("height");
         const auto isSize = [](double size_px) { return size_px >= 1 && size_px <= 16384; };
         if (!isSize(width) || !isSize(height)) {
           throw Error(ErrorCode::bad_input,
                       fmt::format("resize {:g} x {:g}: expected numbers 1..16384", width, height));
         }
         session.window_.resize(static_cast<int>(width), static_cast<int>(height));
       }},
      {"screenshot",
       {{"file", kText, false}},
       "Writes the window as PNG; default: a new emscape-NNNN.png",
       [](Session& session, const Command& command) {
         requireEnding(command.text("file"), kPictureEndings);
         session.window_.screenshot(command.text("file"));
       }},
      {"back",
       {},
       "Closes what is open",
       [](Session& session, const Command&) {
         session.notice_ = {};
         if (session.isDragging()) return session.cancelDrag();
         for (const PanelName& panel : panelNames()) {
           if (!panel.stays) session.panels.*panel.open = false;
         }
       }},
  };
}

}  // namespace emscape::view
