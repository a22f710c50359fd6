/// Verbs of the window.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "apps/view/files/file_endings.h"
#include "apps/view/files/picture_files.h"
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
  using Kind = PanelKind;
  static const std::vector<PanelName> all{
      {"scenario", &Panels::scenario, Kind::docked},   {"colors", &Panels::colors, Kind::docked},
      {"planes", &Panels::planes, Kind::docked},       {"probe", &Panels::probe, Kind::docked},
      {"timeline", &Panels::timeline, Kind::docked},   {"help", &Panels::help, Kind::beside},
      {"time", &Panels::time, Kind::question},         {"open", &Panels::open, Kind::dialog},
      {"position", &Panels::position, Kind::question}, {"map", &Panels::map, Kind::question},
      {"record", &Panels::record, Kind::question},     {"restore", &Panels::restore, Kind::question},
      {"unsaved", &Panels::unsaved, Kind::question},   {"changed", &Panels::changed, Kind::beside},
      {"menu", &Panels::menu, Kind::beside},           {"replace", &Panels::replace, Kind::question},
      {"warnings", &Panels::warnings, Kind::question}, {"side", &Panels::side, Kind::beside},
  };
  return all;
}

bool isOpen(const Panels& panels, PanelKind kind) {
  const std::vector<PanelName>& all = panelNames();
  return std::any_of(all.begin(), all.end(),
                     [&](const PanelName& panel) { return panel.kind == kind && panels.*panel.open; });
}

bool isDialogOpen(const Panels& panels) {
  return isOpen(panels, PanelKind::dialog) || isOpen(panels, PanelKind::question);
}

std::vector<Verb> Session::windowVerbs() {
  return {
      {"panel",
       {{"name", kText, true, {}, panelChoices()}, {"open", kBoolean, false}},
       "Opens or closes a panel: scenario, colors, planes, probe, timeline, help, time, open, position, map, "
       "record, restore, unsaved, changed, replace, warnings, side (over the picture of a narrow window), "
       "menu (of the selection), all",
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
           if (!open) continue;
           session.panels.hidden = false;
           if (panel.stays()) session.panels.side = true;
         }
       }},
      {"scale",
       {{"factor", kNumber, false, {kMinScale, kMaxScale}}, {"change", kNumber, false, {-1, 1, true, true}}},
       "Size of texts and controls, 0.5..4, in the picture too; or `change`, 1 or -1: a step larger or "
       "smaller",
       [](Session& session, const Command& command) {
         constexpr double kStep = 1.125;
         if (command.has("factor") == command.has("change")) {
           throw Error(ErrorCode::bad_input, "scale: expected either factor or change");
         }
         const double change = command.number("change") < 0 ? 1 / kStep : kStep;
         session.window_.setScale(command.has("factor") ? command.number("factor")
                                                        : session.window_.scale() * change);
         session.change([&](playback::ViewState& view) { view.label_scale = session.window_.scale(); });
       }},
      {"resize",
       {{"width", kNumber, true, kSize_px}, {"height", kNumber, true, kSize_px}},
       "Size of the window in pixels",
       [](Session& session, const Command& command) {
         session.window_.resize(static_cast<int>(command.number("width")),
                                static_cast<int>(command.number("height")));
       }},
      {"screenshot",
       {{"file", kText, false, {}, {}, requirePictureEnding}, {"replace", kBoolean, false}},
       "Writes the window as PNG; default: a new emscape-NNNN.png in the user's folder of pictures, else in "
       "that of the input",
       [](Session& session, const Command& command) {
         const std::string given = command.text("file");
         const std::string file =
             given.empty() ? newPictureFile(session.options_.namesake(), session.files_->pictures) : given;
         if (!session.asksToReplace(command, file)) session.window_.screenshot(file);
       }},
      {"back",
       {},
       "Closes what is open; if nothing is, cancels what is being computed or opened",
       [](Session& session, const Command&) {
         bool was_open = !session.notice_.text.empty();
         session.notice_ = {};
         if (session.isDragging() || session.isDraggingPlane()) return session.cancelDrag();
         if (session.tool_.isOn()) {
           session.tool_ = {};
           return;
         }
         Panels& panels = session.panels;
         // A question, the help or a file browser over another dialog is closed alone.
         if (std::exchange(panels.replace, false)) return;
         if (isOpen(panels, PanelKind::question) && std::exchange(panels.help, false)) return;
         if ((panels.record || panels.map) && std::exchange(panels.open, false)) return;
         for (const PanelName& panel : panelNames()) {
           if (!panel.stays()) was_open |= std::exchange(panels.*panel.open, false);
         }
         const ProgramState program = session.programState();
         const bool plays = program.activity == Activity::playing;
         if (!was_open && !plays && program.can_cancel) session.cancel();
       }},
  };
}

}  // namespace emscape::view
