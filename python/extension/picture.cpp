/// Pictures of fields as arrays of pixels.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <typeinfo>
#include <utility>

#include "emscape/base/error.h"
#include "emscape/base/log.h"
#include "emscape/playback/frames/scene.h"
#include "emscape/playback/pictures/painter.h"
#include "emscape/render/scene/render_settings.h"
#include "emscape/scenario/model/snapshot.h"
#include "playback/view/view_settings.h"
#include "python/extension/field.h"
#include "python/extension/module.h"

namespace emscape::python {
namespace {

using playback::ComputeTarget;

/// @throws Error (usage), as the command line does for --range, --iso-value and --exaggeration
void checkValues(const std::optional<std::pair<float, float>>& range, const std::optional<double>& iso_value,
                 double exaggeration) {
  if (range &&
      !(std::isfinite(range->first) && std::isfinite(range->second) && range->first < range->second)) {
    throw Error(ErrorCode::usage, fmt::format("range ({}, {}) must be (MIN, MAX), two numbers with MIN < MAX",
                                              range->first, range->second));
  }
  if (iso_value && !std::isfinite(*iso_value)) {
    throw Error(ErrorCode::usage, fmt::format("iso_value {} is not a number", *iso_value));
  }
  const render::SettingLimits& limits = render::kExaggerationLimits;
  requireWithin("exaggeration", exaggeration, limits.min, limits.max, "");
}

/// A frame of a field's volume, with the scenario's emitters and the tracks of its platforms.
playback::Frame frameOf(const Field& field, std::size_t index,
                        const std::optional<std::pair<float, float>>& range) {
  playback::Frame frame;
  frame.volume = field.volumes[index];
  if (range) frame.color_range = volume::ValueRange{range->first, range->second};
  if (field.scene) {
    const scenario::TerrainPtr& terrain = field.scene->terrain;
    const auto snapshot = scenario::snapshotAt(field.scene->scenario, terrain.get(), field.time_s);
    frame.markers = playback::markersOf(snapshot, terrain, frame.volume.grid());
    frame.tracks = playback::tracksOf(*field.scene, frame.volume.grid(), field.time_s);
  }
  return frame;
}

using Settings = std::vector<std::pair<const playback::ViewSetting*, playback::SettingValue>>;

/// @throws std::bad_cast for another type
playback::SettingValue typedValue(const playback::ViewSetting& setting, nb::handle value) {
  if (setting.isSwitch()) return nb::cast<bool>(value, false);
  if (setting.isListOfTexts()) return nb::cast<std::vector<std::string>>(value);
  if (!setting.isNumber()) return nb::cast<std::string>(nb::str(value));
  const double number = nb::cast<double>(value);
  requireWithin(setting.key.c_str(), number, setting.spec.minimum, setting.spec.maximum,
                setting.spec.unit.c_str());
  return number;
}

playback::SettingValue valueOf(const playback::ViewSetting& setting, nb::handle value) {
  const std::vector<std::string>& choices = setting.spec.choices;
  try {
    playback::SettingValue typed = typedValue(setting, value);
    if (!setting.isChoice() ||
        std::find(choices.begin(), choices.end(), std::get<std::string>(typed)) != choices.end())
      return typed;
  } catch (const std::bad_cast&) {
  }
  const std::string expected = setting.isSwitch()   ? "True or False"
                               : setting.isNumber() ? "a number"
                               : setting.isChoice() ? fmt::format("{}", fmt::join(choices, ", "))
                                                    : "a list of texts";
  throw Error(ErrorCode::usage, fmt::format("{} {}: expected {}", setting.key,
                                            nb::cast<std::string>(nb::str(value)), expected));
}

/// @throws Error (usage) for an unknown setting, or one that is not of a still picture
Settings settingsOf(const nb::dict& given) {
  Settings settings;
  for (const auto& [key, value] : given) {
    const std::string name = nb::cast<std::string>(key);
    const std::vector<playback::ViewSetting>& all = playback::viewSettings();
    const auto found = std::find_if(all.begin(), all.end(), [&](const auto& row) {
      const bool is_of_field =
          row.affects == &playback::ViewChange::field || row.affects == &playback::ViewChange::time;
      return row.key == name && row.set && row.affects != nullptr && !is_of_field;
    });
    if (found == all.end()) {
      throw Error(ErrorCode::usage,
                  fmt::format("render: no setting '{}' of pictures; docs/view-state.md lists them", name));
    }
    settings.emplace_back(&*found, valueOf(*found, value));
  }
  return settings;
}

nb::object render(const Field& field, const std::string& quantity, std::pair<int, int> size,
                  const std::string& camera, const std::string& mode,
                  const std::optional<std::pair<float, float>>& range, const std::string& transfer,
                  const std::string& theme, bool terrain, bool emitters, bool shading,
                  std::optional<double> iso_value, double exaggeration, const std::string& note,
                  const nb::dict& others) {
  refuseForkedProcess();
  checkValues(range, iso_value, exaggeration);
  const Settings settings = settingsOf(others);
  render::Image8 picture;
  {
    const nb::gil_scoped_release unlocked;
    playback::ViewState view;
    view.size = render::parseImageSize(std::to_string(size.first) + "x" + std::to_string(size.second));
    view.camera = render::parseCamera(camera);
    view.theme = render::parseTheme(theme);
    view.settings.mode = render::parseCompositingMode(mode);
    view.settings.shading = shading;
    if (iso_value) view.settings.iso_value = *iso_value;
    view.settings.vertical_exaggeration = exaggeration;
    view.transfer_file = transfer;
    if (range) view.range = playback::ValueRange{range->first, range->second};
    view.show_terrain = terrain;
    view.show_emitters = emitters;
    for (const auto& [setting, value] : settings) setting->set(view, value);
    const playback::Frame frame = frameOf(field, field.indexOf(quantity), range);
    const auto draw = [&](const ResolvedBackend& choice) {
      playback::Painter painter(view, ComputeTarget{choice});
      painter.setScene(field.scene ? field.scene->scenario->name : std::string(),
                       field.scene ? &*field.scene : nullptr);
      painter.setFrame(frame);
      painter.draw(render::FramePlan::exact());
      return painter.picture(note);
    };
    const Backend backend = field.volumes.front().isOnDevice() ? Backend::cuda : Backend::cpu;
    picture = draw(resolveBackend(backend));
  }
  return ownedArray(std::move(picture.rgba), {static_cast<std::size_t>(picture.size.height),
                                              static_cast<std::size_t>(picture.size.width), 4});
}

}  // namespace

void bindPicture(nb::module_& module) {
  module.def(
      "render", &render, nb::arg("field"), nb::arg("quantity"), nb::arg("size"), nb::arg("camera"),
      nb::arg("mode"), nb::arg("range").none(), nb::arg("transfer"), nb::arg("theme"), nb::arg("terrain"),
      nb::arg("emitters"), nb::arg("shading"), nb::arg("iso_value").none(), nb::arg("exaggeration"),
      nb::arg("note"), nb::arg("settings"),
      nb::sig("def render(field: Field, quantity: str, size: tuple[int, int], camera: str, mode: str, "
              "range: tuple[float, float] | None, transfer: str, theme: str, terrain: bool, emitters: bool, "
              "shading: bool, iso_value: float | None, exaggeration: float, note: str, "
              "settings: dict[str, object]) -> "
              "numpy.typing.NDArray[numpy.uint8]"));
}

}  // namespace emscape::python
