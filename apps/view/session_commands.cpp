/// What each verb does.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "apps/view/session.h"
#include "emscape/base/error.h"
#include "emscape/scenario/scenario_file.h"

namespace emscape::view {
namespace {

bool switched(const Command& command, bool present) {
  return command.boolean("on", !present);
}

}  // namespace

Session::Handler Session::handlerOf(const std::string& verb) {
  static const std::map<std::string, Handler> handlers{
      {"play", &Session::play},
      {"pause", &Session::pause},
      {"step", &Session::step},
      {"seek", &Session::seek},
      {"first", &Session::first},
      {"last", &Session::last},
      {"rate", &Session::rate},
      {"loop", &Session::loop},
      {"orbit", &Session::orbit},
      {"pan", &Session::pan},
      {"dolly", &Session::dolly},
      {"camera", &Session::setCamera},
      {"reset_view", &Session::resetView},
      {"focus", &Session::focus},
      {"bookmark", &Session::bookmark},
      {"recall", &Session::recall},
      {"set", &Session::set},
      {"undo", &Session::undo},
      {"redo", &Session::redo},
      {"copy_command", &Session::copyCommand},
      {"save", &Session::save},
      {"mode", &Session::mode},
      {"iso", &Session::iso},
      {"shading", &Session::shading},
      {"exaggeration", &Session::exaggeration},
      {"step_voxels", &Session::stepVoxels},
      {"quantity", &Session::showQuantity},
      {"transfer", &Session::transfer},
      {"opacity", &Session::opacity},
      {"range", &Session::range},
      {"fit_step", &Session::fitStep},
      {"fit_series", &Session::fitSeries},
      {"pattern", &Session::showPattern},
      {"terrain", &Session::terrain},
      {"emitters", &Session::emitters},
      {"theme", &Session::changeTheme},
      {"panel", &Session::panel},
      {"scale", &Session::scale},
      {"resize", &Session::resize},
      {"screenshot", &Session::screenshot},
      {"back", &Session::back},
      {"quit", &Session::quit},
  };
  const auto found = handlers.find(verb);
  return found == handlers.end() ? nullptr : found->second;
}

void Session::perform(const Command& command) {
  Json fields{{"do", command.verb}};
  fields.update(command.arguments);
  log_.write("command", fields);
  touched_ = true;
  const Handler handler = handlerOf(command.verb);
  if (!handler) throw Error(ErrorCode::bad_input, command.verb + ": only a script can do that");
  try {
    (this->*handler)(command);
  } catch (const Error& error) {
    tell(error.what(), true);
  }
}

// --- time ---

void Session::play(const Command& command) {
  if (command.boolean("on", !playhead_.playing())) {
    advanced_at_s_ = log_.now_s();
    playhead_.play();
  } else {
    playhead_.pause();
  }
}

void Session::pause(const Command&) {
  playhead_.pause();
}

void Session::step(const Command& command) {
  playhead_.stepBy(static_cast<int>(command.number("steps")));
  askTime();
}

void Session::seek(const Command& command) {
  playhead_.seek(command.number("time_s"));
  askTime();
}

void Session::first(const Command&) {
  if (!playhead_.times_s().empty()) playhead_.seek(playhead_.times_s().front());
  askTime();
}

void Session::last(const Command&) {
  if (!playhead_.times_s().empty()) playhead_.seek(playhead_.times_s().back());
  askTime();
}

void Session::rate(const Command& command) {
  if (command.has("value")) {
    if (!(command.number("value") > 0)) throw Error(ErrorCode::bad_input, "rate: expected a number above 0");
    playhead_.setRate(command.number("value"));
  } else {
    playhead_.changeRate(command.number("change", 1) < 0 ? -1 : 1);
  }
  tell(fmt::format("{:g} times real time", playhead_.rate()));
}

void Session::loop(const Command& command) {
  playhead_.setLoop(switched(command, playhead_.loop()));
}

// --- camera ---

void Session::orbit(const Command& command) {
  const std::optional<Viewport> view = viewport();
  if (!view) return;
  camera_.orbit(command.number("azimuth_deg"), command.number("elevation_deg"), *view);
  cameraMoved();
}

void Session::pan(const Command& command) {
  const std::optional<Viewport> view = viewport();
  if (!view) return;
  camera_.pan(command.number("right_px"), command.number("down_px"), *view);
  cameraMoved();
}

void Session::dolly(const Command& command) {
  const std::optional<Viewport> view = viewport();
  if (!view || !(command.number("factor") > 0)) return;
  camera_.dolly(command.number("factor"), view->size.width / 2.0, view->size.height / 2.0, *view);
  cameraMoved();
}

void Session::setCamera(const Command& command) {
  camera_.set(render::parseCamera(command.text("spec")));
  cameraMoved();
}

void Session::resetView(const Command&) {
  camera_.set(options_.style.camera);
  cameraMoved();
}

void Session::focus(const Command& command) {
  constexpr double kDistance = 0.45;
  const std::optional<Viewport> view = viewport();
  if (!view || picture_->annotations.markers.empty()) return;
  const std::vector<render::Marker>& markers = picture_->annotations.markers;
  std::size_t index = focused_ % markers.size();
  if (command.has("emitter")) {
    const auto named = std::find_if(markers.begin(), markers.end(), [&](const render::Marker& m) {
      return m.label == command.text("emitter");
    });
    if (named == markers.end()) {
      throw Error(ErrorCode::bad_input,
                  fmt::format("focus: there is no emitter '{}'", command.text("emitter")));
    }
    index = static_cast<std::size_t>(named - markers.begin());
  }
  focused_ = index + 1;
  camera_.focus(markers[index].position_m, kDistance, *view);
  cameraMoved();
  tell(markers[index].label);
}

void Session::bookmark(const Command& command) {
  const int number = static_cast<int>(command.number("number"));
  if (number < 1 || number > 9) throw Error(ErrorCode::bad_input, "bookmark: expected a number 1..9");
  bookmarks_[static_cast<std::size_t>(number - 1)] = Bookmark{camera_.spec(), playhead_.step_s()};
  tell(fmt::format("bookmark {} stored", number));
}

void Session::recall(const Command& command) {
  const int number = static_cast<int>(command.number("number"));
  if (number < 1 || number > 9 || !bookmarks_[static_cast<std::size_t>(number - 1)]) {
    throw Error(ErrorCode::bad_input, fmt::format("bookmark {} is empty: Ctrl+{} stores it", number, number));
  }
  const Bookmark& stored = *bookmarks_[static_cast<std::size_t>(number - 1)];
  camera_.set(stored.camera);
  cameraMoved();
  playhead_.seek(stored.time_s);
  askTime();
}

// --- scenario ---

void Session::set(const Command& command) {
  changeScenario({{command.text("path"), command.text("value")}});
}

void Session::undo(const Command&) {
  if (!canUndo()) return;
  edits_->undo();
  showScenario();
}

void Session::redo(const Command&) {
  if (!canRedo()) return;
  edits_->redo();
  showScenario();
}

void Session::copyCommand(const Command&) {
  const std::string text = renderCommand();
  window_.setClipboard(text);
  tell("copied: " + text);
}

void Session::save(const Command& command) {
  if (!edits_) throw Error(ErrorCode::bad_input, "there is no scenario to save");
  std::string file = command.text("file");
  if (file.empty()) {
    const std::filesystem::path input(scenario()->file);
    file = (input.parent_path() / (input.stem().string() + ".edited" + input.extension().string())).string();
  }
  scenario::saveScenario(*scenario(), file);
  edits_->markSaved();
  tell("written: " + file);
}

// --- picture ---

void Session::mode(const Command& command) {
  constexpr render::CompositingMode kModes[] = {render::CompositingMode::dvr, render::CompositingMode::mida,
                                                render::CompositingMode::mip, render::CompositingMode::iso};
  render::RenderSettings settings = settings_;
  settings.mode = command.has("mode") ? render::parseCompositingMode(command.text("mode"))
                                      : kModes[(static_cast<int>(settings_.mode) + 1) % 4];
  setSettings(settings);
}

void Session::iso(const Command& command) {
  render::RenderSettings settings = settings_;
  const bool shown = settings.mode == render::CompositingMode::iso;
  settings.mode = shown && !command.has("value") ? fog_mode_ : render::CompositingMode::iso;
  if (command.has("value")) settings.iso_value = command.number("value");
  setSettings(settings);
}

void Session::shading(const Command& command) {
  render::RenderSettings settings = settings_;
  settings.shading = switched(command, settings.shading);
  setSettings(settings);
}

void Session::exaggeration(const Command& command) {
  const double factor = command.number("factor");
  if (!(factor >= 0 && factor <= 100))
    throw Error(ErrorCode::bad_input, "exaggeration: expected a number 0..100");
  render::RenderSettings settings = settings_;
  settings.vertical_exaggeration = factor;
  setSettings(settings);
}

void Session::stepVoxels(const Command& command) {
  const double value = command.number("value");
  if (!(value >= 0.05 && value <= 10))
    throw Error(ErrorCode::bad_input, "step_voxels: expected a number 0.05..10");
  render::RenderSettings settings = settings_;
  settings.step_voxels = value;
  setSettings(settings);
}

void Session::showQuantity(const Command& command) {
  quantity_ = command.text("name");
  colors_ = {};
  fitting_ = true;
  live_.setQuantity(quantity_);
}

void Session::transfer(const Command& command) {
  if (!picture_) return;
  if (command.has("file")) {
    fitted_ = render::readTransferFunction(command.text("file"), picture_->volume.info());
    setColors({});
    return;
  }
  ColorAdjustment colors = colors_;
  colors.color_map = command.text("colors");
  setColors(colors);
}

void Session::opacity(const Command& command) {
  ColorAdjustment colors = colors_;
  colors.opacity_factor = std::clamp(colors.opacity_factor * command.number("factor"), 1e-3, 1e3);
  setColors(colors);
}

void Session::range(const Command& command) {
  ColorAdjustment colors = colors_;
  if (command.has("min") != command.has("max")) {
    throw Error(ErrorCode::bad_input, "range: expected both min and max, or neither");
  }
  colors.range.reset();
  if (command.has("min")) {
    colors.range = volume::ValueRange{static_cast<float>(command.number("min")),
                                      static_cast<float>(command.number("max"))};
  }
  setColors(colors);
}

void Session::fitStep(const Command&) {
  fitColors(false);
}

void Session::fitSeries(const Command&) {
  fitColors(true);
}

void Session::showPattern(const Command& command) {
  const std::vector<render::Pattern>& all = render::allPatterns();
  if (command.has("pattern")) {
    pattern_.reset();
    if (command.text("pattern") != "auto") pattern_ = render::parsePattern(command.text("pattern"));
  } else if (!pattern_) {
    pattern_ = all.front();
  } else {
    const auto next = std::next(std::find(all.begin(), all.end(), *pattern_));
    pattern_ = next == all.end() ? std::optional<render::Pattern>() : *next;
  }
  live_.setPattern(pattern_);
  tell(fmt::format("rays: {}", pattern_ ? render::toString(*pattern_) : "auto"));
}

void Session::terrain(const Command& command) {
  show_terrain_ = switched(command, show_terrain_);
  live_.showTerrain(show_terrain_);
}

void Session::emitters(const Command& command) {
  show_emitters_ = switched(command, show_emitters_);
  live_.showEmitters(show_emitters_);
}

void Session::changeTheme(const Command& command) {
  if (command.has("theme")) {
    theme_ = render::parseTheme(command.text("theme"));
  } else {
    theme_ = theme_ == render::Theme::dark ? render::Theme::light : render::Theme::dark;
  }
}

// --- window ---

void Session::panel(const Command& command) {
  const std::string name = command.text("name");
  if (name == "all") {
    panels.hidden = !command.boolean("open", panels.hidden);
    return;
  }
  bool* open = name == "scenario"   ? &panels.scenario
               : name == "colors"   ? &panels.colors
               : name == "timeline" ? &panels.timeline
               : name == "help"     ? &panels.help
               : name == "time"     ? &panels.time
                                    : nullptr;
  if (!open) {
    throw Error(ErrorCode::bad_input,
                fmt::format("panel '{}': expected scenario, colors, timeline, help, time or all", name));
  }
  *open = command.boolean("open", panels.hidden || !*open);
  if (*open) panels.hidden = false;
}

void Session::scale(const Command& command) {
  constexpr double kStep = 1.125;
  const double change = command.number("change") < 0 ? 1 / kStep : kStep;
  window_.setScale(command.has("factor") ? command.number("factor") : window_.scale() * change);
}

void Session::resize(const Command& command) {
  window_.resize(static_cast<int>(command.number("width")), static_cast<int>(command.number("height")));
}

void Session::screenshot(const Command& command) {
  window_.screenshot(command.text("file"));
}

void Session::back(const Command&) {
  notice_ = {};
  panels.help = panels.time = false;
}

void Session::quit(const Command&) {
  window_.quit();
}

}  // namespace emscape::view
