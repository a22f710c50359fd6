/// Verbs of the window.
#include <fmt/format.h>

#include "apps/view/files/file_endings.h"
#include "apps/view/session/session.h"
#include "emscape/base/error.h"

namespace emscape::view {
namespace {

constexpr NumberLimits kSize_px{1, 16384};

std::vector<const char*> panelChoices() {
  std::vector<const char*> names = namesOf(panelNames());
  names.push_back("all");
  return names;
}

}  // namespace

const std::vector<PanelName>& panelNames() {
  static const std::vector<PanelName> all{
      {"scenario", &Panels::scenario, true},  {"colors", &Panels::colors, true},
      {"planes", &Panels::planes, true},      {"probe", &Panels::probe, true},
      {"timeline", &Panels::timeline, true},  {"help", &Panels::help, false},
      {"time", &Panels::time, false},         {"open", &Panels::open, false},
      {"position", &Panels::position, false}, {"map", &Panels::map, false},
      {"record", &Panels::record, false},     {"restore", &Panels::restore, false},
      {"unsaved", &Panels::unsaved, false},   {"changed", &Panels::changed, false},
  };
  return all;
}

std::vector<Verb> Session::windowVerbs() {
  return {
      {"panel",
       {{"name", kText, true, {}, panelChoices()}, {"open", kBoolean, false}},
       "Opens or closes a panel: scenario, colors, planes, probe, timeline, help, time, open, position, map, "
       "record, restore, unsaved, changed, all",
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
         }
       }},
      {"scale",
       {{"factor", kNumber, false, {kMinScale, kMaxScale}}, {"change", kNumber, false, {-1, 1, true, true}}},
       "Size of texts and controls, 0.5..4; or `change`, 1 or -1: a step larger or smaller",
       [](Session& session, const Command& command) {
         constexpr double kStep = 1.125;
         if (command.has("factor") == command.has("change")) {
           throw Error(ErrorCode::bad_input, "scale: expected either factor or change");
         }
         const double change = command.number("change") < 0 ? 1 / kStep : kStep;
         session.window_.setScale(command.has("factor") ? command.number("factor")
                                                        : session.window_.scale() * change);
       }},
      {"resize",
       {{"width", kNumber, true, kSize_px}, {"height", kNumber, true, kSize_px}},
       "Size of the window in pixels",
       [](Session& session, const Command& command) {
         session.window_.resize(static_cast<int>(command.number("width")),
                                static_cast<int>(command.number("height")));
       }},
      {"screenshot",
       {{"file", kText, false, {}, {}, requirePictureEnding}},
       "Writes the window as PNG; default: a new emscape-NNNN.png",
       [](Session& session, const Command& command) { session.window_.screenshot(command.text("file")); }},
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
